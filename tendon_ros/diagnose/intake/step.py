"""What the checks have in common: their result, and channels by what they mean."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable, Sequence
from dataclasses import replace

from tendon_ros.base.recording import Channel, Recording
from tendon_ros.identify.driving import motor_channels
from tendon_ros.model.instrument import Instrument, Sensor

#: recordings that a check has left, and sentences on what it has not
Sifted = tuple[tuple[Recording, ...], list[str]]


def sifted(recordings: Sequence[Recording], fault: Callable[[Recording], str]) -> Sifted:
    """
    Leave out the recordings that have a fault.

    :param recordings: what was measured.
    :param fault: says what is wrong with one, and how to mend it; empty where nothing is.
    :return: the others, and a sentence on each that was left out.
    """
    faults = [(recording, fault(recording)) for recording in recordings]
    kept = tuple(recording for recording, text in faults if not text)
    return kept, [f'{recording.name}: {text}' for recording, text in faults if text]


def compared(recording: Recording, instrument: Instrument) -> tuple[Sensor, ...]:
    """
    Return the sensors whose channels can be compared with the model.

    :param recording: what was measured.
    :param instrument: the network.
    :return: its sensors that the recording has, but for those that drive the model.
    """
    driving = motor_channels(instrument)
    return tuple(
        s for s in instrument.sensors if s.channel in recording and s.channel not in driving
    )


def asked_of(position: str) -> str:
    """
    Return the channel of what was asked of a motor.

    :param position: the channel of where it was.
    :return: the name of its set-point's channel.
    """
    return f'setpoint/{position.removeprefix("actuator/")}'


def without(recording: Recording, names: Container[str]) -> Recording:
    """
    Return a recording that lacks some channels.

    :param recording: what was measured.
    :param names: the channels to leave out.
    :return: a new recording.
    """
    kept = {name: c for name, c in recording.channels.items() if name not in names}
    return replace(recording, channels=kept)


def shared_span(recording: Recording, names: Iterable[str]) -> tuple[float, float]:
    """
    Return the time during which several channels were all measured.

    :param recording: what was measured.
    :param names: its channels.
    :return: begin and end [s]; the end comes first where there is no such time.
    """
    channels: Sequence[Channel] = [recording[name] for name in names]
    return max(float(c.time[0]) for c in channels), min(float(c.time[-1]) for c in channels)
