"""``tendon check``: validate an instrument file and say what it describes."""

from __future__ import annotations

import argparse
from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tendon_ros.model.instrument import Instrument
    from tendon_ros.model.modes import Mode

HELP = 'check an instrument file and print its network, places and natural frequencies'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """
    Declare the arguments.

    :param parser: of this verb.
    """
    parser.add_argument(
        'instrument', metavar='FILE.yaml', help='a file, or the name of an installed instrument'
    )


def run(args: argparse.Namespace) -> None:
    """
    Print the summary.

    :param args: parsed arguments.
    :raises InstrumentError: on the first fault of the file.
    """
    from tendon_ros.model.instrument_file import find_instrument, load_instrument
    from tendon_ros.model.modes import modes
    from tendon_ros.report.diagnosis_words import count

    path = find_instrument(args.instrument)
    one = load_instrument(path)
    print(f'{path}: {one.name} is valid' + (f' ({one.description})' if one.description else ''))
    parts = {
        'pulley': one.pulleys,
        'motor': one.motors,
        'loop': one.loops,
        'coupling': one.couplings,
        'contact': one.contacts,
        'sensor': one.sensors,
    }
    print(', '.join(count(len(some), thing) for thing, some in parts.items()))
    if one.loops or one.couplings:
        _print_routing(one)
    print('\nplaces of effects')
    print('\n'.join(f'  {place}' for place in one.places()))
    print('\nchannels')
    width = max(len(sensor.name) for sensor in one.sensors)
    for sensor in one.sensors:
        print(f'  {sensor.name:{width}}  {sensor.channel}')
    if one.effects:
        print('\neffects in force')
        for use in one.effects:
            values = ', '.join(f'{name}={value:g}' for name, value in use.parameters.items())
            print(f'  {use.effect} at {use.place}: {values}')
    _print_modes('motors held, contacts open', modes(one, one.driven))
    _print_modes('motors free, contacts open', modes(one))


def _print_routing(one: Instrument) -> None:
    """Print the matrix by which angles lengthen loops and twist couplings."""
    print('\nrouting: elongation of loops [mm] by angle [rad], twist of couplings by angle')
    table = [['', *one.pulley_names]]
    names = [row.name for row in one.loops] + [row.name for row in one.couplings]
    for k, (name, values) in enumerate(zip(names, one.routing(), strict=True)):
        scale = 1e3 if k < len(one.loops) else 1.0
        table.append([name, *(f'{scale * v:g}' if v else '.' for v in values)])
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    for line in table:
        cells = (f'{cell:>{width}}' for cell, width in zip(line, widths, strict=True))
        print('  ' + '  '.join(cells))


def _print_modes(title: str, found: Iterable[Mode]) -> None:
    lines = []
    for mode in found:
        if mode.damping < 1.0 - 1e-9:
            text = f'{mode.frequency:9.3f} Hz, damping {mode.damping:z.3f} of critical'
        else:
            text = f'{1e3 / mode.rate:9.3f} ms to return to 1/e'
        lines.append(f'  {text}, most at pulley {mode.pulley}')
    if lines:
        print(f'\nsmall motions, {title}')
        print('\n'.join(lines))
