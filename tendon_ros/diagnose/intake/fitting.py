"""Recordings against the instrument file: the same joints, motors to drive with, a gap to see."""

from __future__ import annotations

from collections.abc import Sequence

from tendon_ros.base.errors import listed
from tendon_ros.base.recording import channel_name, Recording
from tendon_ros.diagnose.intake.step import compared, Sifted, without
from tendon_ros.identify.driving import motor_channels
from tendon_ros.model.instrument import Instrument

#: fewer samples are no channel
FEWEST = 10


def fitting(recordings: Sequence[Recording], instrument: Instrument) -> Sifted:
    """
    Leave out channels that the instrument does not know, and recordings that do not fit it.

    :param recordings: what was measured.
    :param instrument: what it is said to be of.
    :return: recordings with every motor's position and at least one channel to compare.
    """
    kept: list[Recording] = []
    sentences: list[str] = []
    for recording in recordings:
        if fault := _other_motors(recording, instrument):
            sentences.append(fault)
            continue
        cleaned, said = _known(recording, instrument)
        if fault := _lacking(cleaned, instrument):
            # what is lacking may be there under another name
            sentences.append('; then: '.join([*said, fault]))
        else:
            sentences += said
            kept.append(cleaned)
    return tuple(kept), sentences


def _known(recording: Recording, instrument: Instrument) -> tuple[Recording, list[str]]:
    """Leave out channels of joints that the instrument does not have, and empty ones."""
    joints = {f'pulley_{name}' for name in instrument.pulley_names}
    strange: dict[str, list[str]] = {}
    said: list[str] = []
    names: set[str] = set()
    for name, channel in recording.channels.items():
        group, *rest = name.split('/')
        if group in ('actuator', 'setpoint', 'pulley') and rest[0] not in joints:
            strange.setdefault(rest[0], []).append(name)
        elif group == 'load_cell' and not instrument.contacts:
            said.append(
                f'{recording.name}: {name} left out: {instrument.name} has no contact for a load '
                'cell to measure; describe it in contacts'
            )
        elif group != 'setpoint' and channel.value.size < FEWEST:
            said.append(
                f'{recording.name}: {name} left out: {channel.value.size} samples; check '
                'its driver'
            )
        else:
            names.add(name)
    for joint, channels in strange.items():
        said.append(
            f'{recording.name}: {listed(channels)} left out: {instrument.name} has no {joint}; it '
            f'has {listed(joints)}: add it to the file, or rename it in the bag'
        )
    return without(recording, recording.channels.keys() - names), said


def _other_motors(recording: Recording, instrument: Instrument) -> str:
    """Say that a recording has none of the instrument's motors; nothing where it has one."""
    motors = {n.split('/')[1] for n in recording.channels if n.startswith('actuator/')}
    own = {f'pulley_{name}' for name in instrument.driven}
    if motors & own:
        return ''
    return (
        f'{recording.name}: the instrument file does not fit: it drives {listed(own)}, the '
        f'recording has the motors {listed(motors)}; give the file of this rig, or name the '
        'joints alike'
    )


def _lacking(recording: Recording, instrument: Instrument) -> str:
    """Say what a recording lacks to be compared with the instrument; nothing where it can be."""
    needed = motor_channels(instrument)
    missing = [name for name in needed if name not in recording]
    if missing:
        what = 'no motor position at all' if len(missing) == len(needed) else 'a motor unmeasured'
        return (
            f'{recording.name}: {what}: without {listed(missing)} the model cannot be driven; '
            'record it'
        )
    if not compared(recording, instrument):
        positions = {
            channel_name('actuator', f'pulley_{p}', 'position') for p in instrument.driven
        }
        others = {s.channel for s in instrument.sensors} | positions
        return (
            f'{recording.name}: nothing to compare: no usable channel of a sensor of '
            f'{instrument.name} beside {listed(needed)}, which drives the model; record one of '
            f'{listed(others - set(needed))}'
        )
    return ''
