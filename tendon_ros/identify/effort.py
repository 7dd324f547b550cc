"""What predictions have cost, counted so that the same search costs the same on any machine."""

from __future__ import annotations

import threading

#: [s] of one core that a step of the model takes, and a bin that is predicted, about: diagnoses of
#: a bench, an axis, an arm and a grasper took 0.6 to 1.3 times what these say
STEP, BIN = 2e-6, 0.8e-6


class Effort:
    """
    Counts steps and bins of predictions, whoever asks for them and on however many threads.

    What was remembered counts as well: what is, hangs on which thread came first.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._steps = self._bins = 0

    def spend(self, steps: int, bins: int) -> None:
        """
        Add one prediction.

        :param steps: that the integrator took for it.
        :param bins: that were predicted.
        """
        with self._lock:
            self._steps += steps
            self._bins += bins

    @property
    def seconds(self) -> float:
        """Time that all of it takes one core, about [s]."""
        return STEP * self._steps + BIN * self._bins
