"""What motors give of the torque that they report, by a model."""

from __future__ import annotations

from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Problem
from tendon_ros.model.effect_use import in_force
from tendon_ros.model.laws import modified


def motor_gain(problem: Problem, model: Model, motor: str) -> float:
    """
    Return what a motor gives by what it reports.

    :param problem: the data.
    :param model: causes, and where the numbers of the file have moved to.
    :param motor: its name.
    :return: torque by torque.
    """
    instrument = problem.rollouts.instrument
    [uses, *_] = problem.uses(model)
    numbers = modified(instrument, in_force(instrument.effects, uses))
    return float(numbers['motor_gain'][list(instrument.motor_names).index(motor)])
