"""What belongs together: a motor, the pulley that it turns, and whoever reads either of them."""

from __future__ import annotations

from tendon_ros.identify.candidate import Candidate
from tendon_ros.model.instrument import Instrument


def turned(instrument: Instrument) -> dict[str, str]:
    """
    Return the pulley that each motor turns, both as places.

    :param instrument: the file.
    :return: pulley by motor.
    """
    return {f'motor_{motor.name}': f'pulley_{motor.pulley}' for motor in instrument.motors}


def bodies(instrument: Instrument) -> dict[str, str]:
    """
    Return the pulley that each motor and each sensor of either belongs to.

    :param instrument: the file.
    :return: pulley by place; all others stand for themselves.
    """
    motors = turned(instrument)
    read = {
        s.name: motors[f'motor_{s.of}'] if s.kind == 'motor_torque' else f'pulley_{s.of}'
        for s in instrument.sensors
        if not s.kind.startswith('contact')
    }
    return motors | read


def alone(instrument: Instrument) -> frozenset[str]:
    """
    Return the bodies that nothing is linked with, and their motors: what plays needs a second one.

    :param instrument: the file.
    :return: places.
    """
    linked = {f'pulley_{name}' for link in instrument.links for name in link.route}
    every = {f'pulley_{p.name}': f'pulley_{p.name}' for p in instrument.pulleys}
    every |= turned(instrument)
    return frozenset(place for place, pulley in every.items() if pulley not in linked)


def of_one_body(instrument: Instrument, one: Candidate, other: Candidate) -> bool:
    """
    Return whether two causes act at one place, or on one body.

    :param instrument: the file.
    :param one: a cause.
    :param other: another one.
    :return: whether.
    """
    known = bodies(instrument)
    return known.get(one.place, one.place) == known.get(other.place, other.place)
