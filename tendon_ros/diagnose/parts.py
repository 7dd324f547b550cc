"""
Effects that are part of others: Coulomb friction is Stribeck friction that does not fall.

A fit knows no names. What acts like a simpler effect goes by the simpler name, what is one is not
two, and a law that holds another one is never worse than that.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tendon_ros.base.errors import SimulationError
from tendon_ros.effects import find
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Problem

#: part of a simple effect by which a fit begins to see whether there is more to it
LITTLE = 0.2
#: part of the time in which a pulley turns no faster than what counts as seen
OFTEN = 0.95
#: part by which friction differs at least if it is to be more than a plain one; and the part that
#: it holds more with, where nothing turned slowly enough to show that it falls: a motor that rests
#: within a count holds a little more or less with any friction
PLAIN, HOLDS_MORE = 0.1, 0.2


def simpler(
    candidate: Candidate, values: Mapping[str, float]
) -> tuple[Candidate, dict[str, float]] | None:
    """
    Return the simpler effect that parameters make of an effect.

    :param candidate: the effect.
    :param values: of its parameters.
    :return: the other effect at the same place, with its parameters; None where there is none.
    """
    other = find(candidate.effect).other
    found = None if other is None else other(**values)
    if found is None:
        return None
    name, parameters = found
    return Candidate(name, candidate.place), parameters


def is_part(part: Candidate, whole: Candidate) -> bool:
    """
    Return whether one effect is a special case of another one at the same place.

    :param part: the simpler one.
    :param whole: the other one.
    :return: whether; what stands for an effect of the file is part of none.
    """
    alike = part.place == whole.place and not part.given and not whole.given
    return alike and part.effect in find(whole.effect).holds


def is_plainer(plain: Candidate, more: Candidate) -> bool:
    """
    Return whether an effect of the file, of another size, is a special case of it and another.

    :param plain: stands instead of the file's.
    :param more: acts beside the file's.
    :return: whether the law of what is beside holds that of the file's.
    """
    alike = plain.place == more.place and bool(plain.given) and not more.given
    return alike and plain.effect in find(more.effect).holds


def widened(
    shape: Mapping[str, float], whole: Candidate, simple: Mapping[str, float], part: Candidate
) -> dict[str, float]:
    """
    Return parameters with which an effect does little but what a part of it did.

    :param shape: parameters of the whole effect that may do.
    :param whole: the effect.
    :param simple: the only parameter of the part.
    :param part: the simpler effect.
    :return: parameters of the whole effect.
    """
    effect = find(whole.effect)
    [size] = simple.values()
    little = {n: LITTLE * size for n, neutral in effect.neutral.items() if neutral == 0.0}
    return {**shape, **little, **dict.fromkeys(effect.holds[part.effect], size)}


def plain(problem: Problem, model: Model, k: int) -> tuple[Candidate, dict[str, float]] | None:
    """
    Return the simpler effect that friction is at all speeds and directions that were seen.

    Whatever else its law says, these data know nothing of it.

    :param problem: the data.
    :param model: causes.
    :param k: which of them.
    :return: the effect that is part of it, with its parameter; None where there is more to it.
    """
    cause = model.causes[k]
    effect = find(cause.effect)
    if not effect.holds or effect.law is None or cause.given:
        return None
    pulley = cause.place.removeprefix('pulley_')
    column = problem.rollouts.instrument.index(pulley)
    try:
        states = problem.rollouts.states(problem.uses(model))
    except SimulationError:
        return None
    speeds = np.concatenate(
        [
            rows.velocity[~segment.rests(pulley), column]
            for rows, segment in zip(states, problem.rollouts.segments, strict=True)
        ]
    )
    values = list(model.values(k).values())
    ways = [
        (way, side)
        for way, side in ((speeds[speeds > 0.0], 1.0), (-speeds[speeds < 0.0], -1.0))
        if len(way)
    ]
    seen = [
        effect.law(float(np.quantile(way, part)), side, 0.0, *values)[0]
        for way, side in ways
        for part in (0.0, OFTEN)
    ]
    if not seen or max(seen) - min(seen) > PLAIN * max(seen):
        return None
    held = max(effect.law(0.0, side, 0.0, *values)[0] for _, side in ways)
    if held > (1.0 + HOLDS_MORE) * max(seen):
        return None
    [name] = effect.holds
    [size] = [p.name for p in find(name).parameters]
    return Candidate(name, cause.place), {size: float(np.mean(seen))}


def as_one(model: Model) -> Model:
    """
    Return the model with no two causes of which one is part of the other.

    :param model: causes.
    :return: the same forces, by fewer causes.
    """
    for k, whole in enumerate(model.causes):
        for n, part in enumerate(model.causes):
            if is_part(part, whole):
                values = model.values(k)
                [more] = model.values(n).values()
                held = find(whole.effect).holds[part.effect]
                grown = {name: values[name] + more for name in held}
                return as_one(model.without(k, n).joined(whole, {**values, **grown}))
    return model
