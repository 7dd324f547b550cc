"""
An explanation: causes with their parameters, and what else of the instrument moves.

Every unknown has a place on its axis, so that fits and priors need no units.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
import math

import numpy as np
from numpy.typing import NDArray

from tendon_ros.effects import find
from tendon_ros.effects.presliding_friction import BENDING
from tendon_ros.identify.axis import Axis
from tendon_ros.identify.candidate import Candidate
from tendon_ros.model.instrument import EffectUse

FloatArray = NDArray[np.float64]

BENT = 'presliding_friction'
#: dry friction builds up over a fraction of a degree in every bearing that was ever measured; what
#: takes more than its upper end is pre-sliding friction by name
BRISTLE = Axis('angle', 'rad', 1e-6, BENDING, 1e-3, math.log(4.0), log=True, spread=1.0)


@dataclass(frozen=True)
class Model:
    """
    Causes with places on their axes, and what else moves.

    ``z``: for each cause the places of its parameters; ``bristle``: by pulley place, for dry
    friction without a pre-sliding angle of its own; ``moved``: of each tolerance, in its
    deviations, shape (tolerances,).
    """

    causes: tuple[Candidate, ...]
    z: tuple[tuple[float, ...], ...]
    bristle: Mapping[str, float]
    moved: FloatArray

    def values(self, k: int) -> dict[str, float]:
        """
        Return the parameters of a cause.

        :param k: which.
        :return: values by name, SI units.
        """
        return self.causes[k].coordinates.values(self.z[k])

    def without(self, *which: int) -> Model:
        """
        Return the model without some causes, nothing refitted.

        :param which: their numbers.
        :return: the smaller model.
        """
        kept = [k for k in range(len(self.causes)) if k not in which]
        causes = tuple(self.causes[k] for k in kept)
        left = _dry_places(causes)
        return Model(
            causes,
            tuple(self.z[k] for k in kept),
            {place: z for place, z in self.bristle.items() if place in left},
            self.moved,
        )

    def joined(self, cause: Candidate, values: Mapping[str, float]) -> Model:
        """
        Return the model with one more cause.

        :param cause: the cause.
        :param values: of its parameters.
        :return: the larger model.
        """
        causes = (*self.causes, cause)
        row = cause.coordinates.place(values)
        bristle = {place: self.bristle.get(place, 0.0) for place in _dry_places(causes)}
        return Model(causes, (*self.z, row), bristle, self.moved)


def _dry_places(causes: Sequence[Candidate]) -> list[str]:
    """Return the pulleys whose dry friction needs an angle to build up over."""
    dry = {c.place for c in causes if find(c.effect).hook == 'budget'}
    own = {c.place for c in causes if c.effect == BENT}
    return sorted(dry - own)


def bristles(model: Model, own: Sequence[EffectUse], least: float) -> list[EffectUse]:
    """
    Return the effects that let dry friction build up over an angle.

    :param model: the model.
    :param own: effects of the instrument file.
    :param least: angle [rad] by which the model may be off anyway: what builds up faster only
        takes longer to compute.
    :return: one effect for each pulley with dry friction, but for those whose file knows better.
    """
    known = {use.place for use in own if use.effect == BENT and not is_bristle(use)}
    return [
        EffectUse(
            BENT, place, {'torque': 0.0, 'angle': max(least, BRISTLE.value(z))}, instead=True
        )
        for place, z in model.bristle.items()
        if place not in known
    ]


def is_bristle(use: EffectUse) -> bool:
    """
    Return whether an effect is only the angle over which another's friction builds up.

    :param use: the effect.
    :return: whether.
    """
    return use.effect == BENT and use.parameters.get('torque', 0.0) == 0.0
