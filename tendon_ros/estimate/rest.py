"""What torques have changed by since pulleys rest: friction may have taken all of it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

#: the least uncertainty that divides others [rad], and the same of friction [N m]
LEAST, LEAST_TORQUE = 1e-9, 1e-9


class Rest:
    """
    The rest of the pulleys whose torques balance.

    :param unsure: by how much each angle is uncertain [rad], shape (pulleys,).
    :param on_pulleys: whose torques each balance adds up, shape (rows, pulleys).
    """

    def __init__(self, unsure: FloatArray, on_pulleys: FloatArray) -> None:
        self._unsure = np.maximum(unsure, LEAST)
        self._on_pulleys = on_pulleys
        self.reset()

    def reset(self) -> None:
        """Forget what came to rest."""
        # torques of the last measurement, and by balance what they were when its pulley came to
        # rest, shape (rows, torques)
        self._last: FloatArray | None = None
        self._began = np.zeros((len(self._on_pulleys), 0))

    def same(
        self, before: FloatArray, angle: FloatArray, torque: FloatArray, friction: FloatArray
    ) -> FloatArray:
        """
        Return how far what friction is wrong by in each balance is what it was wrong by.

        :param before: angles at the last measurement [rad], shape (pulleys,).
        :param angle: the same now.
        :param torque: that was measured now [N m], shape (torques,).
        :param friction: by how much it is uncertain in each balance [N m], shape (rows,).
        :return: from one at rest to nothing, shape (rows,).
        """
        if self._last is None:
            return np.zeros(len(self._on_pulleys))
        now, last = (np.abs(self._began - t).max(axis=1) for t in (torque, self._last))
        grown = np.maximum(now**2 - last**2, 0.0) / np.maximum(friction, LEAST_TORQUE) ** 2
        return np.asarray(self._resting(before, angle) * np.sqrt(np.maximum(1.0 - grown, 0.0)))

    def carry(self, before: FloatArray, angle: FloatArray, torque: FloatArray) -> None:
        """
        Take a measurement in.

        :param before: as for :meth:`same`.
        :param angle: the same now.
        :param torque: that was measured.
        """
        if self._last is None:
            self._began = np.tile(torque, (len(self._on_pulleys), 1))
        resting = self._resting(before, angle)[:, None]
        self._began = torque + resting * (self._began - torque)
        self._last = torque

    def _resting(self, before: FloatArray, angle: FloatArray) -> FloatArray:
        """Return how far the pulley of each balance rests, from one to nothing."""
        return np.asarray(self._on_pulleys @ np.exp(-np.abs(angle - before) / self._unsure))
