"""What a calibration says on a terminal: what carried over, what did not, how long it takes."""

from __future__ import annotations

from tendon_ros.diagnose.calibrate import Calibration, Carried
from tendon_ros.report.diagnosis_text import channel_rows
from tendon_ros.report.diagnosis_words import effect_words, number, with_interval, with_unit


def calibration_text(found: Calibration) -> str:
    """
    Return what a terminal shows of a calibration.

    :param found: the calibration.
    :return: plain text, ending in a newline.
    """
    before, after = (number(m) for m in found.misfit)
    lines = [
        f'On what no fit has seen, the file as it is leaves {before} noise deviations, '
        f'calibrated {after}.'
    ]
    lines += [f'carried over    {_row(p)}' for p in found.parameters if p.holds]
    lines += [f'differs here    {_row(p)}' for p in found.parameters if not p.holds]
    lines += [f'gap             {row}' for row in channel_rows(found.gap)]
    for beginning in found.beginnings:
        seconds = with_unit(beginning.seconds, 's')
        lines.append(f'{seconds:>8} of it  leave {number(beginning.misfit)} noise deviations')
    lines.append(
        f'{with_unit(found.needed, "s")} of such a recording are as good as all of it'
        if found.needed is not None
        else 'Less than all of the recording is not as good: a longer one may do better'
    )
    lines += [f'note: {text}' for text in found.left_out]
    return '\n'.join(lines).replace('\u00a0', ' ') + '\n'


def _row(p: Carried) -> str:
    value, interval = with_interval(p.after, (p.low, p.high), p.unit)
    words = effect_words(p.effect, p.place)
    return (
        f'{words}: {p.parameter} {value} ({interval}); the file: {with_unit(p.before, p.unit, 4)}'
    )
