"""What belongs together: a motor, the pulley that it turns, and whoever reads either of them."""

from __future__ import annotations

from tendon_ros.identify.candidate import Candidate
from tendon_ros.model.instrument import Instrument


def bodies(instrument: Instrument) -> dict[str, str]:
    """
    Return the pulley that each place belongs to.

    :param instrument: the file.
    :return: pulley by place, for the places that belong to one.
    """
    turned = {motor.name: motor.pulley for motor in instrument.motors}
    found = {f'pulley_{pulley.name}': pulley.name for pulley in instrument.pulleys}
    found |= {f'motor_{motor}': pulley for motor, pulley in turned.items()}
    read = {sensor.name: turned.get(sensor.of, sensor.of) for sensor in instrument.sensors}
    known = set(found.values())
    return found | {name: of for name, of in read.items() if of in known}


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
