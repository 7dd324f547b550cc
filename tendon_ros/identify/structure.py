"""
The structure of what a model leaves: its power that is not noise.

Noise differs from one bin to the next; what neighbouring bins share is a gap.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tendon_ros.identify.noise_estimate import neighbours, unshared
from tendon_ros.identify.residuals import Residuals

FloatArray = NDArray[np.float64]

FLOOR = 0.95  # mean square of a channel, in noise deviations, that is its floor


class Structure(Residuals):
    """What a model leaves of the recordings, and what of it has structure."""

    def structured(self, left: FloatArray) -> float:
        """
        Return the power of what is left that is not noise: what neighbouring bins share.

        :param left: what is left, shape (samples,).
        :return: mean square in noise deviations, noise taken off.
        """
        return self.structures(left)[0]

    def structures(self, left: FloatArray) -> tuple[float, float]:
        """
        Return the same over all samples, and in the channel that has most of it.

        :param left: what is left, shape (samples,).
        :return: mean squares in noise deviations, noise taken off.
        """
        power = self.structured_by_channel(left).values()
        whole = sum(p for p, _ in power) / max(sum(count for _, count in power), 1)
        return whole, max((p / count for p, count in power if count), default=0.0)

    def structured_by_channel(self, left: FloatArray) -> dict[str, tuple[float, int]]:
        """
        Return the same of each channel, all recordings together.

        :param left: what is left, shape (samples,).
        :return: by channel a sum of squares in noise deviations, noise taken off, and of how many
            samples.
        """
        found: dict[str, tuple[float, int]] = {}
        for n, c, own in self.groups(left):
            segment = self._segments[n]
            apart = neighbours(segment.spacing, counted=bool(segment.prescribed))
            if len(own) <= apart:
                continue
            noise = len(own) * unshared(own, apart)
            # what keeps below noise that has a shape is no gap
            measured = segment.measured[c]
            shaped = measured.counted * float(np.mean((measured.noise / measured.doubt) ** 2))
            beyond = float(own @ own) - max(noise, FLOOR * shaped * len(own))
            power, count = found.get(measured.sensor.channel, (0.0, 0))
            found[measured.sensor.channel] = power + max(0.0, beyond), count + len(own)
        return found
