"""Names and numbers of a diagnosis as an engineer would write them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
import math

from tendon_ros.diagnose.evidence import Moved
from tendon_ros.diagnose.result import ChannelGap
from tendon_ros.effects import find

_SENSORS = {'torque': 'torque sensor', 'shaft': 'shaft torque sensor', 'speed': 'speed sensor'}
_KINDS = ('load_cell', 'pulley', 'cable', 'coupling', 'motor', 'encoder', 'contact', *_SENSORS)
_QUANTITIES = {'effort': 'torque', 'position': 'angle', 'velocity': 'speed'}
_GROUPS = {'setpoint': 'set-point', 'estimate': 'estimated'}
_PROPER = ('Coulomb', 'Stribeck')
_SCALABLE = ('N', 'm', 's', 'rad')  # what a unit starts with where a prefix reads well
_BLANK = '\u00a0'  # keeps a number and its unit on one line


def place_words(place: str) -> str:
    """Return a place in words: ``pulley_3`` is pulley 3."""
    kind = _kind(place)
    name = place.removeprefix(kind).strip('_') if kind else place
    said = _SENSORS.get(kind, kind.replace('_', ' '))
    return ' '.join(part for part in (said, name) if part)


def effect_words(effect: str, place: str) -> str:
    """
    Return an effect and its place in words.

    :param effect: its id.
    :param place: where it acts.
    :return: for instance 'Pretension of cable L3', 'Cable L3 creep', 'Load cell gain'.
    :raises EffectError: where there is no such effect.
    """
    found = find(effect)
    where = place_words(place)
    kind = _kind(place).replace('_', ' ')
    if kind and found.title.lower().startswith(kind):
        return where[:1].upper() + where[1:] + found.title[len(kind) :]
    acts = found.dissipative or found.hook in ('torque', 'budget')
    on = 'on' if acts and where.startswith('pulley') else 'of'
    return f'{found.title} {on} {where}'


def inside(text: str) -> str:
    """Return a text that began a sentence as it stands within one."""
    return text if text.startswith(_PROPER) else text[:1].lower() + text[1:]


def channel_words(channel: str) -> str:
    """Return a channel in words: ``actuator/pulley_M/effort`` is motor M torque."""
    parts = channel.split('/')
    group, quantity = parts[0], parts[-1]
    joint = place_words(parts[1]) if len(parts) > 2 else ''
    if group in ('actuator', 'setpoint'):
        joint = joint.replace('pulley', 'motor')
    said = _GROUPS.get(group, 'load cell' if group == 'load_cell' else '')
    words = (joint, said, _QUANTITIES.get(quantity, quantity))
    return ' '.join(part for part in words if part)


def likely_at(places: Sequence[str]) -> str:
    """Return one place or more, the likeliest first, as a part of a sentence."""
    first, *others = [place_words(place) for place in places]
    return f'most likely at {first}, else at {" or ".join(others)}' if others else f'at {first}'


def joined(texts: Iterable[str]) -> str:
    """Return texts as a list within a sentence."""
    *first, last = texts
    return f'{", ".join(first)} and {last}' if first else last


def number(value: float, digits: int = 2) -> str:
    """Return a number with that many significant digits, whole ones kept, without an exponent."""
    if not math.isfinite(value):
        return '–' if math.isnan(value) else ('−∞' if value < 0 else '∞')
    if value == 0.0:
        return '0'
    rounded = float(f'{value:.{digits - 1}e}')  # 9.96 has one digit more than it seems
    return _fixed(value, digits - 1 - math.floor(math.log10(abs(rounded))))


def percent(part: float) -> str:
    """Return a part of one as a percentage that never claims certainty."""
    if 0.0 < part < 0.01:
        return f'< 1{_BLANK}%'
    if 0.99 < part < 1.0:
        return f'> 99{_BLANK}%'
    return f'{100.0 * part:.0f}{_BLANK}%'


def scale(unit: str, size: float) -> tuple[float, str]:
    """
    Return how to show values of that size.

    :param unit: SI unit, factors separated by blanks; '1' is none.
    :param size: largest magnitude that will be shown, in ``unit``.
    :return: factor on the values, and the unit with its prefix.
    """
    if unit in ('', '1'):
        return 1.0, ''
    shown = unit.replace(' ', '·')
    if unit.split('/')[0].split(' ')[0] not in _SCALABLE or not 0.0 < size < 0.1:
        return 1.0, shown
    return (1e3, f'm{shown}') if size >= 1e-4 else (1e6, f'µ{shown}')


def gap_scale(gap: ChannelGap) -> tuple[float, str]:
    """
    Return how to show the gap of a channel: what is left of it may be far below its noise.

    :param gap: the gap.
    :return: factor on the values, and the unit with its prefix.
    """
    return scale(gap.unit, max(gap.after, gap.noise_floor))


def with_unit(value: float, unit: str, digits: int = 2) -> str:
    """Return a number with its unit, at a prefix that suits it."""
    factor, shown = scale(unit, abs(value))
    return f'{number(factor * value, digits)}{_BLANK}{shown}'.strip()


def with_interval(value: float, ci95: tuple[float, float], unit: str) -> tuple[str, str]:
    """
    Return a value and its interval with the digits that the interval's width is worth.

    :param value: in ``unit``.
    :param ci95: in ``unit``; may be infinite.
    :param unit: SI unit.
    :return: the value with its unit, the interval without.
    """
    factor, shown = scale(unit, abs(value))
    low, high = (factor * end for end in ci95)
    half = 0.5 * (high - low)
    if math.isfinite(half) and half > 0.0:
        decimals = 1 - math.floor(math.log10(1.000001 * half))
        texts = [_fixed(end, decimals) for end in (factor * value, low, high)]
    else:
        texts = [number(end, 3) for end in (factor * value, low, high)]
    return f'{texts[0]}{_BLANK}{shown}'.strip(), f'{texts[1]} … {texts[2]}'


def moved_words(moved: Moved) -> tuple[str, str, str]:
    """
    Return how far a number of the file has moved.

    :param moved: the number.
    :return: which it is, what it became or by what it changed, and the interval of that.
    """
    value, interval = with_interval(moved.value, moved.ci95, moved.unit)
    effect, _, parameter = moved.quantity.partition('.')
    if parameter:  # of an effect that the file has: the number itself
        return f'{parameter} of {inside(find(effect).title)}', value, interval
    sign = '' if value.startswith('−') else '+'
    by = f'×{_BLANK}{value}' if moved.unit in ('', '1') else f'{sign}{value}'
    return moved.quantity, by, interval


def known_words(moved: Moved) -> str:
    """
    Return what is to be said of a number that is no careful measurement, or no longer one.

    :param moved: the number.
    :return: such as ``, a guess``; nothing of most.
    """
    if moved.guessed:
        return ', a guess'
    usual = 'usual ' if moved.supposed else ''
    return f', {number(moved.off, 2)} {usual}deviations off' if moved.strained else ''


def sized(value: float, ci95: tuple[float, float], unit: str) -> str:
    """
    Return a value with its unit and its interval; a yes or no has none.

    :param value: in ``unit``.
    :param ci95: in ``unit``; may be infinite.
    :param unit: SI unit.
    :return: such as ``1.0 N (0.8 … 1.2)``.
    """
    said, interval = with_interval(value, ci95, unit)
    return said if ci95[0] == ci95[1] else f'{said} ({interval})'


def count(n: int, thing: str) -> str:
    """Return a number of things: 1 channel, 2 channels."""
    return f'{n} {thing}' if n == 1 else f'{n} {thing}s'


def _kind(place: str) -> str:
    return next((k for k in _KINDS if place == k or place.startswith(f'{k}_')), '')


def _fixed(value: float, decimals: int) -> str:
    text = f'{value:.{max(decimals, 0)}f}'
    return text.replace('-', '−') if float(text) else text.lstrip('-')
