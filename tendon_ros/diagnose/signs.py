"""
What speaks for a cause, and how far to believe it.

A likelihood that took thousands of correlated samples for independent would be certain of
anything. What speaks for a cause is measured instead by numbers that do not grow with the length
of a recording, and calibrated on the development seeds of the blind benchmark by logistic
regression (``python -m bench.calibrate``).
"""

from __future__ import annotations

from dataclasses import dataclass
import math

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Signs:
    """
    What speaks for a cause, all in noise power per sample of the channels where it shows.

    Each channel counts by what the cause is worth there: what is wrong with another motor says
    little of this one. ``worth``: by how much misfit grows when it alone is left out; ``left``:
    structured misfit that stays, and a part of what stays of all channels; ``form``: what the laws
    of all causes may leave; ``beside``: the same of the others at its place, of dry friction as
    much as may look like it. ``event``: it happened once; ``lone``: and leaves far more than any
    other time without it; ``part``: which part of what is left without it, of all channels, it
    explains.
    """

    worth: float
    left: float
    form: float
    event: bool = False
    beside: float = 0.0
    part: float = 1.0
    lone: bool = False

    @property
    def features(self) -> FloatArray:
        """Inputs of the logistic regression."""
        left = self.left / (LEFT_NOISE + self.form)
        worth = self.worth / (LEFT_NOISE + self.left)
        return np.array(
            [
                1.0,
                math.log10(min(max(left, LITTLE), MUCH)),
                math.log10(min(max(worth, LEAST_WORTH), MOST_WORTH)),
                float(self.event and not self.lone),
            ]
        )


#: misfit in units of what is usual below and beyond which it says nothing more
LITTLE, MUCH = 0.3, 30.0
#: times what stays that a cause is worth below and beyond which it says nothing more
LEAST_WORTH, MOST_WORTH = 0.1, 1000.0
#: power of what a model that diverges leaves
BOUNDLESS = 1e12
#: structured power that recordings without any effect may leave
LEFT_NOISE = 0.05
#: weights of the features, from 178 causes of 99 cases that are used up for anything else, by 1.44
#: and less 0.62: what 246 probabilities of 145 later ones, used up by now, fell short of
WEIGHTS = np.array([-0.92, -2.45, 2.13, -2.13])


def probability(signs: Signs) -> float:
    """
    Return the probability that a cause is true, or one that it cannot be told from.

    :param signs: what speaks for it.
    :return: 0 to 1.
    """
    return 1.0 / (1.0 + math.exp(-float(np.clip(WEIGHTS @ signs.features, -30.0, 30.0))))
