"""The lowest that a torque limit of a model may be: what most torques of its motor keep below."""

from __future__ import annotations

from dataclasses import replace

from tendon_ros.identify.explanation import Model
from tendon_ros.identify.slopes import Slopes
from tendon_ros.model.effect_use import in_force
from tendon_ros.model.laws import modified

LIMIT = 'torque_saturation'


def least_limit(problem: Slopes, model: Model, k: int) -> float:
    """
    Return the torque that a motor usually keeps below, which no limit cuts off.

    :param problem: the data.
    :param model: with a torque limit, and with what else its motor's torque is made of.
    :param k: which of its causes the limit is.
    :return: [N m].
    """
    instrument = problem.rollouts.instrument
    [uses, *_] = problem.uses(model)
    numbers = modified(instrument, in_force(instrument.effects, uses))
    j = [f'motor_{name}' for name in instrument.motor_names].index(model.causes[k].place)
    motor = instrument.motor_names[j]
    return problem.rollouts.usual(motor, numbers['motor_gain'][j], numbers['motor_bias'][j])


def raised(problem: Slopes, model: Model) -> tuple[Model, frozenset[str]]:
    """
    Return a model whose limits are as low as they may be, and no lower.

    Lower ones predict the same, whatever they are: no derivative would lead a fit out of there.

    :param problem: the data.
    :param model: with causes.
    :return: the same, or the model with some limits raised, and the labels of these.
    """
    rows = list(model.z)
    labels: set[str] = set()
    for k, cause in enumerate(model.causes):
        if cause.effect != LIMIT:
            continue
        values = model.values(k)
        least = least_limit(problem, model, k)
        if values['limit'] < least:
            rows[k] = cause.coordinates.place({**values, 'limit': least})
            first = sum(len(row) for row in model.z[:k])
            names = [p.name for p in cause.parameters]
            labels.add(problem.labels(model)[first + names.index('limit')])
    return (replace(model, z=tuple(rows)) if labels else model), frozenset(labels)
