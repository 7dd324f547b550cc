"""
Zero-order hold of torques that come seldom, tried where neither steps nor the file tell.

A voltage fifty times a second moves by steps of a fiftieth of a second, however smooth it looks;
a current that a controller sets a thousand times a second and a logger reads fifty times goes
nearly straight from one reading to the next. Half a sample lies between the two, and everything
that is late or has play can make up for it. So both are tried, before any cause is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from tendon_ros.base.recording import Recording
from tendon_ros.diagnose.intake.commands import lines
from tendon_ros.diagnose.prepare import Prepared, prepared
from tendon_ros.diagnose.steps import Steps
from tendon_ros.diagnose.valleys import started
from tendon_ros.model.instrument import Instrument

#: part of the misfit of lines that held torques leave at most to be taken for it
LESS = 0.9


def as_set(
    ready: Prepared, recordings: Sequence[Recording], instrument: Instrument, jobs: int
) -> tuple[Prepared, Instrument, list[str]]:
    """
    Return a problem whose seldom torques hold, where that leaves less than lines do.

    :param ready: the problem with lines.
    :param recordings: of one rig.
    :param instrument: its file.
    :param jobs: threads.
    :return: the problem, the instrument whose controllers tick as seldom, and a sentence; all as
        they were where no torque is taken for a line.
    """
    found = lines(recordings, instrument)
    if not found:
        return ready, instrument, []
    slow = replace(instrument, control_period=max(found.values()))
    held = prepared(recordings, slow, jobs)
    rate = 1.0 / slow.control_period
    said = f'{", ".join(found)}: {rate:.3g} readings a second '
    if _misfit(held, jobs) < LESS * _misfit(ready, jobs):
        said += (
            'are taken for what was set until the next, since that leaves less than a line from '
            f'one to the next; say so in the instrument file, control: {{rate: {rate:.3g} Hz}}, '
            'for simulations'
        )
        return held, slow, [said]
    said += (
        f'of a controller that ticks {1.0 / instrument.control_period:.4g} times are taken for a '
        'line from one to the next, since held ones do not leave less'
    )
    return ready, instrument, [said]


def _misfit(ready: Prepared, jobs: int) -> float:
    """Return what the file with its guesses fitted leaves, relative to what moves, added up."""
    problem = ready.problem
    fit = started(Steps(problem, [], jobs, lambda _what, _done: None))
    total = 0.0
    for n, c, left in problem.groups(fit.left):
        measured = problem.rollouts.segments[n].measured[c]
        off = left * measured.doubt[problem.masks[n][c]]
        total += float(np.sum(off**2) / (np.nanvar(measured.value) + 1e-30))
    return total
