"""
What of a series is noise: what bins near each other do not share.

Motion is the same a few bins later, noise is not. What shakes is neither: within some hundredths
of a second it goes to and fro like noise, and a whole period later it is where it was. Nor is what
stands out now and then, for longer than a bin: gears that meet again after their play, say.
"""

from __future__ import annotations

from collections.abc import Callable
import math

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

NEAR = 0.04  # [s] within which noise is a difference and motion is not
#: bins, and [s] at most, beyond which accelerations that counts have made up share nothing; where
#: bins are so long that motion may differ by then, what is quieter is noise
COUNTED, LATER = 3, 0.06
PERIODS = 6  # times as far apart as neighbours that periods of what shakes are looked for
#: part of the power that neighbours do not share from which on less of it a little later is a
#: period and no chance; and from which on less of it between nearer bins is a motion: noise with a
#: memory, and be it a random walk, keeps a part that is one by the bins between
SHAKES, MOVES = 0.5, 0.01
FEW = 0.2  # of the samples that a period may be apart
LOUD = 2.0  # noise powers that are no noise: what is left may shake


def neighbours(period: float, *, counted: bool) -> int:
    """
    Return how far bins are apart between which noise is a difference and motion is not.

    :param period: time between values [s].
    :param counted: whether the motion was counted, so that acceleration is partly made up.
    :return: in bins.
    """
    apart = max(1, round(NEAR / period))
    return max(apart, min(COUNTED, math.ceil(LATER / period))) if counted else apart


def heard(left: FloatArray, apart: int) -> float:
    """
    Return the noise of a series of which a wrong model may leave motion.

    :param left: what a model leaves of a channel, shape (bins,), NaN where nothing was measured.
    :param apart: how many bins apart noise is a difference and motion is not.
    :return: one deviation, in its unit.
    """
    # where samples are seldom, some bins have none
    known = left[np.isfinite(left)]

    def power(lag: int) -> float:
        # second differences: what a wrong model leaves of a motion is nearly straight for so long
        bend = known[2 * lag :] - 2.0 * known[lag:-lag] + known[: -2 * lag]
        return _typical(bend) ** 2 if bend.size else math.inf

    found = _quietest(power, apart, known.size)
    return math.sqrt(found / 6.0) if math.isfinite(found) else 0.0


def unshared(left: FloatArray, apart: int) -> float:
    """
    Return the power of a series that is noise.

    :param left: what a model leaves, in noise deviations, shape (samples,).
    :param apart: how many bins apart noise is a difference and motion is not; less than samples.
    :return: mean square in noise deviations.
    """

    def power(lag: int) -> float:
        step = left[lag:] - left[:-lag]
        return 0.5 * float(step @ step) / len(step) if step.size else math.inf

    # as much as noise is for certain no shaking, and all of it is soon said
    found = power(apart)
    if found > LOUD:
        found = _quietest(power, apart, left.size)
    if found <= 1.0:
        return found
    # a sensor's spikes last for one reading
    usual = _typical(left[apart:] - left[:-apart]) ** 2 / 2.0
    return min(found, max(1.0, power(1), usual))


def _typical(values: FloatArray) -> float:
    """Return the deviation of a series that may stand out now and then."""
    return 1.4826 * float(np.median(np.abs(values)))


def _quietest(power: Callable[[int], float], apart: int, count: int) -> float:
    """
    Return the power of neighbours that is noise, of so many samples.

    Of those a period apart where what is left shakes, of the nearest where it swings more slowly.
    """
    usual = min(power(lag) for lag in range(apart, max(apart, COUNTED) + 1))
    # a few samples far apart differ by chance as much or as little as they like
    farthest = min(PERIODS * apart, int(FEW * count))
    later = min((power(lag) for lag in range(apart + 1, farthest + 1)), default=math.inf)
    nearest = power(1)
    return min(
        usual,
        later if later < SHAKES * usual else usual,
        nearest if nearest < MOVES * usual else usual,
    )
