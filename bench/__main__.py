"""
Measure the kernel: ``python -m bench`` prints tables and writes ``out/bench/figures.json``.

``--quick`` leaves out what takes longer than half a minute when nothing is kept from before.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import asdict
import json
import os
from pathlib import Path
import platform
from typing import Any

from bench import accuracy, fixed, friction, others, scaling, speed
from bench.figures import friction_figure
from bench.yardstick import compiler_found
from tendon_ros.model.engine import compiler_installed

OUT = Path('out/bench')


def table(title: str, rows: Sequence[Mapping[str, Any]]) -> None:
    """
    Print rows as a Markdown table.

    :param title: above it.
    :param rows: with equal keys, or a single ``note``.
    """
    print(f'\n### {title}\n')
    keys = list(dict.fromkeys(key for row in rows for key in row))
    print('| ' + ' | '.join(keys) + ' |')
    print('|' + ' --- |' * len(keys))
    for row in rows:
        cells = (row.get(key, '') for key in keys)
        print(
            '| ' + ' | '.join(f'{c:.3g}' if isinstance(c, float) else str(c) for c in cells) + ' |'
        )


def main() -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(prog='python -m bench', description=__doc__)
    parser.add_argument('--quick', action='store_true', help='leave out what takes long')
    parser.add_argument('--rounds', type=int, default=21, help='interleaved rounds')
    given = parser.parse_args()
    if not compiler_installed():
        parser.error('the bench needs numba: pip install numba')
    OUT.mkdir(parents=True, exist_ok=True)
    found: dict[str, list[dict[str, Any]]] = {}

    def section(key: str, title: str, rows: Sequence[Mapping[str, Any]]) -> None:
        found[key] = [dict(row) for row in rows]
        table(title, found[key])

    print(f'{platform.processor() or platform.machine()}, {os.cpu_count()} cores, '
          f'load {os.getloadavg()[0]:.1f}')  # fmt: skip
    if not compiler_found():
        print('no gcc: the yardstick is left out')
    for name, continuous, every in (('sampled', False, 1), ('continuous', True, 10)):
        timings = speed.against_c(
            continuous=continuous, tolerance=1e-7, every=every, rounds=given.rounds
        )
        section(f'speed_{name}', f'10 s of {name} control, tolerance 1e-7: s, and ratio to C',
                [asdict(t) for t in timings])  # fmt: skip
    if compiler_found():
        print(f'\nLargest difference between C and kernel: {speed.agreement():.1e} rad')
    section('rollouts', '10 s rollouts a second, continuous control, two threads',
            [{'tolerance': t, 'per_second': speed.rollouts_per_second(t)}
             for t in (1e-5, 1e-6, 1e-7)])  # fmt: skip
    for name, continuous in (('sampled', False), ('continuous', True)):
        section(f'error_{name}', f'10 s of {name} control: largest angle error, rad',
                accuracy.errors(OUT, seconds=10.0, continuous=continuous,
                                tolerances=(1e-5, 1e-6, 1e-7, 1e-8, 1e-9)))  # fmt: skip
    right = accuracy.truth(OUT, seconds=10.0, continuous=False)
    if compiler_found():
        section('friction_smooth', 'smoothed friction in C, sampled control, against sticking',
                friction.smoothed(right, (1e-1, 1e-2, 1e-3, 1e-4, 1e-5), 1e-7))  # fmt: skip
    section('friction_presliding', 'pre-sliding friction against sticking',
            friction.presliding(right, (0.0, 1e-2, 1e-3, 1e-4, 1e-5)))  # fmt: skip
    if compiler_found():
        friction_figure(
            found['friction_smooth'], found['friction_presliding'], OUT / 'friction.png'
        )
    section('scaling', 'chains of cables', scaling.chains((2, 5, 20, 50) if given.quick
            else (2, 5, 10, 20, 50, 100, 200)))  # fmt: skip
    section('effects_off', 'effects: none, at neutral values, at work',
            [asdict(t) for t in scaling.effects_off(given.rounds)])  # fmt: skip
    if not given.quick:
        section('fixed', 'fixed-step check', fixed.steps((1e-3, 2e-4, 1e-4, 5e-5, 2.5e-5)))
        rows = [{'tool': 'scipy LSODA, sampled', **others.lsoda(right)}]
        for tool, result in (
            ('CasADi cvodes, continuous', others.casadi()),
            ('MuJoCo RK4 1e-4', others.mujoco('RK4')),
            ('MuJoCo implicitfast 1e-4', others.mujoco('implicitfast')),
        ):
            if result is None:
                print(f'\n{tool}: not installed, left out')
            else:
                rows.append({'tool': tool, **result})
        section('others', 'general tools, 10 s', rows)
    path = OUT / 'figures.json'
    path.write_text(json.dumps(found, indent=1), encoding='utf-8')
    print(f'\n{path} written')


if __name__ == '__main__':
    main()
