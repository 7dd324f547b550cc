"""The joints of an instrument in the order in which drivers that send no names list them."""

from __future__ import annotations

from tendon_ros.model.instrument import Instrument


def joint_names(instrument: Instrument) -> dict[str, tuple[str, ...]]:
    """
    Return the joint of each value of a message without names, or with numbers for names.

    :param instrument: whose messages they are.
    :return: group of channels → joints: those of the motors in their order, the inner pulleys in
        theirs.
    """
    motors = tuple(f'pulley_{name}' for name in instrument.driven)
    inner = tuple(f'pulley_{name}' for name in instrument.inner)
    return {'actuator': motors, 'setpoint': motors, 'pulley': inner, 'estimate': inner}
