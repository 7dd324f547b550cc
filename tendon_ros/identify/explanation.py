"""
An explanation: causes with their parameters, and what else of the instrument moves.

Every unknown has a place on its axis, so that fits and priors need no units.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
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
#: what dry friction has beside its size. It builds up over a fraction of a degree in every bearing
#: that was ever measured; what takes more than the upper end is pre-sliding friction by name. And
#: what holds lets go in time, since motors tremble within their counts. Rigid friction is as far
#: from any angle as can be: what holds the angle counts once only
BRISTLES = {
    'angle': Axis(
        'angle', 'rad', 1e-6, BENDING, 1e-3, math.log(4.0), log=True, spread=1.0, repeated=False
    ),
    'dither': Axis('dither', 'rad/s', 1e-7, 1e-2, 1e-5, math.log(4.0), log=True, spread=1.0),
}


@dataclass(frozen=True)
class Model:
    """
    Causes with places on their axes, and what else moves.

    ``z``: for each cause the places of its parameters; ``bristle``: by pulley place and name, what
    dry friction has beside its size, the pre-sliding angle only where no cause has it; ``moved``:
    of each tolerance, in its deviations, shape (tolerances,). ``rubs``: places where the file has
    dry friction of which it does not say over which angle it builds up.
    """

    causes: tuple[Candidate, ...]
    z: tuple[tuple[float, ...], ...]
    bristle: Mapping[tuple[str, str], float]
    moved: FloatArray
    rubs: tuple[str, ...] = ()

    @classmethod
    def of_file(cls, effects: Sequence[EffectUse], tolerances: int) -> Model:
        """
        Return an instrument file without causes, from which fits begin.

        :param effects: of the file.
        :param tolerances: how many numbers of it may move.
        :return: all numbers as they are; its dry friction builds up as that of a cause does.
        """
        bent = {use.place for use in effects if use.effect == BENT}
        rubs = tuple(sorted({u.place for u in effects if find(u.effect).dry} - bent))
        nothing = cls((), (), {}, np.zeros(tolerances), rubs)
        return replace(nothing, bristle=nothing._bristles(()))

    def values(self, k: int) -> dict[str, float]:
        """
        Return the parameters of a cause.

        :param k: which.
        :return: values by name, SI units.
        """
        return self.causes[k].coordinates.values(self.z[k])

    def use(self, k: int) -> EffectUse:
        """
        Return a cause in use.

        :param k: which.
        :return: the effect with its parameters.
        """
        cause, values = self.causes[k], self.values(k)
        if cause.effect == BENT:
            values['dither'] = self.beside(cause.place, 'dither')
        return cause.use(values)

    def beside(self, place: str, name: str) -> float:
        """
        Return what dry friction has beside its size.

        :param place: the pulley.
        :param name: ``angle`` [rad] or ``dither`` [rad/s].
        :return: its value.
        """
        return BRISTLES[name].value(self.bristle[place, name])

    def without(self, *which: int) -> Model:
        """
        Return the model without some causes, nothing refitted.

        :param which: their numbers.
        :return: the smaller model.
        """
        kept = [k for k in range(len(self.causes)) if k not in which]
        causes = tuple(self.causes[k] for k in kept)
        z = tuple(self.z[k] for k in kept)
        return replace(self, causes=causes, z=z, bristle=self._bristles(causes))

    def joined(self, cause: Candidate, values: Mapping[str, float]) -> Model:
        """
        Return the model with one more cause.

        :param cause: the cause.
        :param values: of its parameters.
        :return: the larger model.
        """
        causes = (*self.causes, cause)
        row = cause.coordinates.place(values)
        # what friction of a wrong size has bent to says nothing of that of another
        first = cause.dry and not any(c.dry and c.place == cause.place for c in self.causes)
        known = {at: z for at, z in self.bristle.items() if not (first and at[0] == cause.place)}
        bristle = replace(self, bristle=known)._bristles(causes)
        return replace(self, causes=causes, z=(*self.z, row), bristle=bristle)

    def _bristles(self, causes: Sequence[Candidate]) -> dict[tuple[str, str], float]:
        """Return what the dry friction of some causes has beside its size, as far as known."""
        dry = sorted({*self.rubs, *(c.place for c in causes if c.dry)})
        own = {c.place for c in causes if c.effect == BENT}
        return {
            (place, name): self.bristle.get((place, name), 0.0)
            for place in dry
            for name in BRISTLES
            if name != 'angle' or place not in own
        }


def bristles(model: Model, own: Sequence[EffectUse], least: float) -> list[EffectUse]:
    """
    Return the effects that let dry friction build up over an angle, and go under a trembling.

    :param model: the model.
    :param own: effects of the instrument file.
    :param least: angle [rad] by which the model may be off anyway: what builds up faster only
        takes longer to compute.
    :return: one effect for each pulley with dry friction, but for those whose file knows better.
    """
    known = {use.place for use in own if use.effect == BENT and not is_bristle(use)}
    found = []
    for place in [p for p, name in model.bristle if name == 'angle' and p not in known]:
        shape = {name: model.beside(place, name) for name in BRISTLES}
        shape['angle'] = max(least, shape['angle'])
        found.append(EffectUse(BENT, place, {'torque': 0.0, **shape}, instead=True))
    return found


def is_bristle(use: EffectUse) -> bool:
    """
    Return whether an effect is only the angle over which another's friction builds up.

    :param use: the effect.
    :return: whether.
    """
    return use.effect == BENT and use.parameters.get('torque', 0.0) == 0.0
