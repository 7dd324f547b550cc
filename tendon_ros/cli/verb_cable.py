"""``tendon cable``: the curve of a cable, from forces at a blocked tip or from a tension test."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tendon_ros.model.instrument import Curve

HELP = 'identify the tension curve of a cable, or read it from a tension test, into a YAML file'

#: three forces that the paper states, with the geometry of its rig
_PAPER_FORCES = '1 deg: 1.83 N, 5 deg: 18 N, 7 deg: 50 N'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """
    Declare the arguments.

    :param parser: of this verb.
    """
    parser.add_argument('--out', type=Path, required=True, metavar='FILE.yaml', help='to write')
    parser.add_argument(
        '--table',
        type=Path,
        metavar='FILE.csv',
        help='tension test with a header such as elongation_mm,tension_N; instead of forces',
    )
    parser.add_argument(
        '--forces',
        default=_PAPER_FORCES,
        metavar='TEXT',
        help='motor angle beyond touch and force at the blocked tip (default: %(default)s)',
    )
    parser.add_argument('--pretension', default='5 N', help='of each cable (default: %(default)s)')
    parser.add_argument('--radius', default='30 mm', help='of all pulleys (default: %(default)s)')
    parser.add_argument('--arm', default='50 mm', help='of the tip (default: %(default)s)')
    parser.add_argument(
        '--loops', type=int, default=3, help='equal loops in series (default: %(default)s)'
    )
    parser.add_argument(
        '--up-to', default='20 kgf', help='largest tension of the table (default: %(default)s)'
    )
    parser.add_argument('--overwrite', action='store_true', help='replace a file that is there')


def run(args: argparse.Namespace) -> None:
    """
    Write the curve.

    :param args: parsed arguments.
    :raises InstrumentError: on unusable arguments.
    :raises OutputError: where the file cannot be written.
    """
    from tendon_ros.base.errors import OutputError
    from tendon_ros.base.outputs import check_output
    from tendon_ros.model.cable_identification import curve_from_table
    from tendon_ros.model.instrument_text import curve_text

    check_output(args.out, [] if args.table is None else [args.table], overwrite=args.overwrite)
    if args.table is not None:
        curve = curve_from_table(args.table)
        comment = f'Tension of one cable against its elongation: tension test {args.table.name}.'
    else:
        curve, comment = _identified(args)
    try:
        args.out.parent.mkdir(parents=True, exist_ok=True)
        args.out.write_text(curve_text(curve, comment), encoding='utf-8')
    except OSError as error:
        raise OutputError(f'{args.out}: {error.strerror}; choose a place to write to') from None
    print(comment)
    print(
        f'{args.out}: {len(curve.elongation)} points, to {curve.tension[-1]:.4g} N at '
        f'{1e3 * curve.elongation[-1]:.4g} mm'
    )


def _identified(args: argparse.Namespace) -> tuple[Curve, str]:
    """Return the curve that gives the forces, and a comment that says where it comes from."""
    from tendon_ros.base.errors import InstrumentError
    from tendon_ros.model.cable_identification import BlockedTip, identified, tabulated

    if args.loops < 1:
        raise InstrumentError(f'--loops: {args.loops} must be at least 1')
    forces = []
    for pair in args.forces.split(','):
        angle, colon, force = pair.partition(':')
        if not colon:
            raise InstrumentError(f"--forces: {pair.strip()!r} is no pair; write '1 deg: 1.83 N'")
        forces.append((_positive('--forces', angle, 'rad'), _positive('--forces', force, 'N')))
    test = BlockedTip(
        forces=tuple(forces),
        radius=_positive('--radius', args.radius, 'm'),
        arm=_positive('--arm', args.arm, 'm'),
        loops=args.loops,
    )
    pretension = _positive('--pretension', args.pretension, 'N')
    most = _positive('--up-to', args.up_to, 'N')
    if most <= pretension:
        raise InstrumentError(
            f'--up-to: {args.up_to} does not exceed the pretension of {args.pretension}, and no '
            'loop could be preloaded by such a table; give more'
        )
    law = identified(test, pretension)
    curve = tabulated(law, args.out.stem, most)
    comment = f"""\
Tension of one cable against its elongation. Identified, not measured, by
    tendon cable --forces '{args.forces}' --pretension '{args.pretension}' \\
        --radius '{args.radius}' --arm '{args.arm}' --loops {args.loops} --up-to '{args.up_to}'
The forces are those at the tip, blocked, when the motor turns on by the angles. They are met by
    t(x) = {law.linear:.6g} x + {law.factor:.6g} x^{law.exponent:.6g}   (t in N, x in mm)
with each cable preloaded to {law.pretension:g} N and so by {1e3 * law.preload:.6g} mm."""
    return curve, comment


def _positive(option: str, text: str, unit: str) -> float:
    from tendon_ros.base.errors import InstrumentError
    from tendon_ros.base.quantity import parsed

    try:
        value = parsed(text, unit)
    except ValueError as error:
        raise InstrumentError(f'{option}: {error}') from None
    if value <= 0.0:
        raise InstrumentError(f'{option}: {text.strip()!r} must be positive')
    return value
