"""
Motor positions of the wrong sign or unit.

All else is predicted from them, so such a fault shows in every other channel. It is believed where
the position put right makes the channels agree that did not, and spoils none.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from tendon_ros.base.recording import Recording
from tendon_ros.diagnose.intake.expected import Comparison, Expectation, expectations
from tendon_ros.diagnose.intake.judgement import may_be_rectified, spent, WORK
from tendon_ros.diagnose.intake.units import DEGREES, NEAR
from tendon_ros.identify.driving import motor_channels
from tendon_ros.model.instrument import Instrument

AGREES = 0.7  # correlation of a channel that the mended motion explains
FAILS = 0.3
WRONG_SIZE = 8.0  # factor either way that calls for another unit
SIZE = 2.5  # factor either way that a model may be wrong by


def suspicious(runs: Sequence[Expectation]) -> bool:
    """
    Say whether a recording may have a wrong motor position at all.

    :param runs: of the model along it, best first.
    :return: whether a channel runs against what the motion asks for, or is of another size.
    """
    if not runs:
        return False
    telling = _telling(runs[0])
    return (
        _misses(telling)
        or _too_small(telling)
        or any(c.correlation < FAILS for c in telling.values())
    )


def _misses(telling: Mapping[str, Comparison]) -> bool:
    """Say whether sizes call for another unit: those of angles, if any, for routes are known."""
    return not all(_sized(c) for c in _deciding(telling).values())


def _deciding(comparisons: Mapping[str, Comparison]) -> Mapping[str, Comparison]:
    """Return the channels whose size is sure: angles, or all where there are none."""
    angles = {n: c for n, c in comparisons.items() if c.sensor.kind == 'angle'}
    return angles or comparisons


def _sized(one: Comparison) -> bool:
    return 1.0 / WRONG_SIZE < one.factor < WRONG_SIZE


def _too_small(telling: Mapping[str, Comparison]) -> bool:
    """Say whether all torques are as small as if every angle were given too large."""
    angles = [c for c in telling.values() if c.sensor.kind == 'angle']
    others = [c for c in telling.values() if c.sensor.kind != 'angle']
    return (
        bool(angles)
        and bool(others)
        and all(abs(np.log(c.factor)) < NEAR and c.correlation > AGREES for c in angles)
        and all(c.factor < SIZE / DEGREES for c in others)
    )


def misdriven(recording: Recording, instrument: Instrument, runs: Sequence[Expectation]) -> str:
    """
    Say which motor position has the wrong sign or unit.

    :param recording: with every motor's position.
    :param instrument: the network.
    :param runs: of the model along the recording as it is, best first.
    :return: the fault and its mend; nothing where there is none.
    """
    if not suspicious(runs):
        return ''
    before = _telling(runs[0])
    names = motor_channels(instrument)
    if any(c.correlation < FAILS for c in before.values()):
        for name in names:
            if _flipped(recording, instrument, name, runs[0]):
                return f'{name} has the wrong sign: turned, all else agrees; turn it on import'
    if _all_in_degrees(recording, instrument, before):
        return 'every angle is in degrees, for then the torques agree; convert to rad on import'
    if _misses(before):
        alone = [(name,) for name in names] if len(names) > 1 else []
        for some in (names, *alone):
            unit = _unit(recording, instrument, some, before)
            if unit:
                return f'{", ".join(some)} {unit}; convert to rad on import'
    return ''


def _telling(run: Expectation) -> Mapping[str, Comparison]:
    return {n: c for n, c in run.comparisons.items() if c.telling and not may_be_rectified(c)}


def _flipped(
    recording: Recording, instrument: Instrument, name: str, as_it_is: Expectation
) -> bool:
    """Say whether one motor's position makes two channels or more agree when it is turned."""
    effort = f'{name.removesuffix("position")}effort'
    own = as_it_is.comparisons.get(effort)
    if own and not may_be_rectified(own) and spent(own.measured, as_it_is.motion[name]) > -WORK:
        return False
    runs = expectations(recording, instrument, {name: -1.0})
    if not runs:
        return False
    before, after = as_it_is.comparisons, _telling(runs[0])
    mended = [n for n in after if n in before and before[n].correlation < FAILS]
    return len(mended) > 1 and all(c.correlation > AGREES for c in after.values())


def _all_in_degrees(
    recording: Recording, instrument: Instrument, before: Mapping[str, Comparison]
) -> bool:
    """Say whether torques agree once every angle is taken for one in degrees."""
    if not _too_small(before):
        return False
    names = motor_channels(instrument)
    runs = expectations(recording, instrument, dict.fromkeys(names, 1.0 / DEGREES))
    after = [c for c in _telling(runs[0]).values() if c.sensor.kind != 'angle'] if runs else []
    return bool(after) and all(
        c.correlation > AGREES and 1.0 / SIZE < c.factor < SIZE for c in after
    )


def _unit(
    recording: Recording,
    instrument: Instrument,
    names: Sequence[str],
    before: Mapping[str, Comparison],
) -> str:
    """Return the unit that some motor positions have instead of rad; empty for none."""
    resolution = {s.channel: s.resolution for s in instrument.sensors}
    units = {
        'in degrees': dict.fromkeys(names, 1.0 / DEGREES),
        'in counts': {n: resolution.get(n, 0.0) for n in names},
    }
    if any(c.sensor.kind == 'angle' for c in before.values()):
        # a contact a thousand times softer than the file says makes torques as small
        units['in mrad'] = dict.fromkeys(names, 1e-3)
    for unit, scale in units.items():
        if not all(scale.values()):
            continue
        runs = expectations(recording, instrument, scale)
        after = _telling(runs[0]) if runs else {}
        if (
            after
            and all(_sized(c) for n, c in _deciding(runs[0].comparisons).items() if n in before)
            and all(c.correlation > AGREES for c in after.values())
            and all(abs(np.log(c.factor)) < NEAR for c in _deciding(after).values())
        ):
            verb = 'is' if len(names) == 1 else 'are'
            return f'{verb} {unit}, for then all else agrees'
    return ''
