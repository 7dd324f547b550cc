"""What the monitor says of a report: levels, lines and numbers for the diagnostics."""

from __future__ import annotations

from collections.abc import Mapping
import math

from diagnostic_msgs.msg import DiagnosticArray

from tendon_ros.diagnose.watch import WatchReport
from tendon_ros.diagnose.watch_gap import WatchedGap
from tendon_ros.nodes.conversions import to_stamp
from tendon_ros.nodes.diagnostics import diagnostic_array, Level

_STATES = {
    'waiting': 'waiting until a window of measurements is full',
    'resting': 'the motors rest: nothing to compare',
    'learning': 'learning what gap is explained',
    'watching': 'no gap beyond what is explained',
}


def whole(report: WatchReport) -> tuple[Level, str, dict[str, object]]:
    """
    Return what is said of the instrument as a whole.

    :param report: of the last look.
    :return: level, one line, and details.
    """
    details: dict[str, object] = {'state': report.state}
    if report.places:
        details['where'] = ', '.join(report.places)
    details |= {f'cause {n}': str(one) for n, one in enumerate(report.suspects, start=1)}
    if report.faults:
        return Level.ERROR, next(iter(report.faults.values())), details
    if report.grown:
        first, *others = report.grown
        text = f'{first.channel}: {_grown(first)}'
        if others:
            text += f'; so has that of {", ".join(one.channel for one in others)}'
        if report.suspects:
            text += f'; at {" or ".join(report.places)}, most likely {report.suspects[0]}'
        return Level.WARN, text, details
    return Level.OK, _STATES[report.state], details


def channels(
    report: WatchReport, silent: Mapping[str, str], name: str, stamp_ns: int
) -> DiagnosticArray:
    """
    Return one status for each channel.

    :param report: of the last look.
    :param silent: sentences on channels that no longer arrive, by channel.
    :param name: of the node, without a slash in front.
    :param stamp_ns: header stamp [ns].
    :return: the message.
    """
    faults = {**report.faults, **silent}
    gaps = {gap.channel: gap for gap in report.gaps}
    message = DiagnosticArray()
    message.header.stamp = to_stamp(stamp_ns)
    for channel in dict.fromkeys([*gaps, *(n for n in faults if '/' in n)]):
        gap = gaps.get(channel)
        level, text = Level.OK, 'being learnt'
        if gap is not None and not math.isnan(gap.explained):
            text = 'no gap beyond what is explained'
        if gap is not None and gap.grown:
            level, text = Level.WARN, _grown(gap)
        if channel in faults:
            level, text = Level.ERROR, faults[channel]
        details = {} if gap is None else _numbers(gap)
        [status] = diagnostic_array(stamp_ns, f'{name}: {channel}', level, text, details).status
        message.status.append(status)
    return message


def _grown(gap: WatchedGap) -> str:
    return (
        f'the gap has grown to {gap.gap:.3g} {gap.unit}, {gap.gap / gap.limit:.1f} times what it '
        f'may reach ({gap.limit:.3g} {gap.unit})'
    )


def _numbers(gap: WatchedGap) -> dict[str, object]:
    found: dict[str, object] = {
        f'gap [{gap.unit}]': gap.gap,
        f'noise floor [{gap.unit}]': gap.floor,
        'unit': gap.unit,
    }
    if not math.isnan(gap.explained):
        found[f'explained [{gap.unit}]'] = gap.explained
    if math.isfinite(gap.limit):
        found[f'limit [{gap.unit}]'] = gap.limit
    return found
