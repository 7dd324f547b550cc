"""
Write the recordings of docs/rigs: simulated, and written as the loggers of such rigs write.

Each is made with effects that the rig's instrument file does not have, so that there is something
to find. The stamps jitter, samples are missing, and one sensor has a clock of its own.

    .venv/bin/python scripts/rig_recordings.py
"""

from __future__ import annotations

from collections.abc import Mapping
import csv
from dataclasses import dataclass
import math
from pathlib import Path
import tempfile

import numpy as np

from tendon_ros.base.recording import Recording
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.session import simulate
from tendon_ros.model.trajectory_choice import chosen_trajectory

OUT = Path(__file__).parents[1] / 'docs' / 'rigs'
DEG = 180.0 / math.pi


@dataclass(frozen=True)
class Column:
    """``value`` = factor · channel + offset, rounded; ``late`` [s] by a clock of its own."""

    channel: str
    factor: float
    decimals: int
    offset: float = 0.0
    late: float = 0.0


@dataclass(frozen=True)
class Rig:
    """A recording: what the truth has beside the instrument file, the motion, the columns."""

    truth: str
    motion: Mapping[str, str]
    rate: float
    time: tuple[str, float, int]  # column, factor from seconds, decimals
    columns: Mapping[str, Column]
    jitter: float = 0.0
    lost: float = 0.0
    own_time: str = ''


RIGS = {
    'driven_axis': Rig(
        """
        - {effect: inertia, place: pulley_axis, parameters: {scale: 1.6}}
        - {effect: coulomb_friction, place: pulley_axis, parameters: {torque: 0.04 N*m}}
        - {effect: torque_gain, place: motor_axis, parameters: {gain: 0.85}}
        """,
        {'amplitude': '40 deg', 'duration': '12 s'},
        125.0,
        ('t_ms', 1e3, 2),
        {
            'target_deg': Column('setpoint/pulley_axis/position', DEG, 3),
            'angle_deg': Column('actuator/pulley_axis/position', DEG, 4),
            'current_mA': Column('actuator/pulley_axis/effort', 1e3 / 0.08, 0),
        },
    ),
    'pendulum_arm': Rig(
        """
        - {effect: gravity, place: pulley_arm, parameters: {torque: 0.42 N*m, phase: 0 deg}}
        - {effect: coulomb_friction, place: pulley_arm, parameters: {torque: 0.06 N*m}}
        - {effect: torque_gain, place: motor_arm, parameters: {gain: 0.8}}
        """,
        {'amplitude': '60 deg', 'duration': '15 s'},
        100.0,
        ('stamp_ms', 1e3, 1),
        {
            'goal_deg': Column('setpoint/pulley_arm/position', DEG, 2, 180.0),
            'present_deg': Column('actuator/pulley_arm/position', DEG, 3, 180.0),
            'load_percent': Column('actuator/pulley_arm/effort', -100.0 / 2.5, 1),
        },
        jitter=6e-4,
        lost=0.02,
    ),
    'wrist_two_jaws': Rig(
        """
        - {effect: tension_friction, place: pulley_wrist, parameters: {coefficient: 0.15}}
        - {effect: pretension, place: cable_a, parameters: {scale: 0.7}}
        """,
        {'amplitude': '25 deg', 'duration': '10 s'},
        100.0,
        ('t_s', 1.0, 4),
        {
            f'{name}_{unit}': Column(f'actuator/pulley_drive_{name}/{quantity}', factor, 0)
            for unit, quantity, factor in (
                ('counts', 'position', 20000 / (2.0 * math.pi)),
                ('mA', 'effort', 1e3 / 0.3),
            )
            for name in ('roll', 'pitch', 'a', 'b')
        },
    ),
    'two_motor_belt': Rig(
        """
        - {effect: coulomb_friction, place: pulley_roller, parameters: {torque: 0.02 N*m}}
        - {effect: sensor_rectified, place: speed_roller, parameters: {rectified: 1}}
        """,
        {'amplitude': '90 deg', 'duration': '12 s'},
        100.0,
        ('t_ms', 1e3, 2),
        {
            'left_deg': Column('actuator/pulley_left/position', DEG, 4),
            'right_deg': Column('actuator/pulley_right/position', DEG, 4),
            'left_A': Column('actuator/pulley_left/effort', 1.0 / 0.05, 3),
            'right_A': Column('actuator/pulley_right/effort', 1.0 / 0.05, 3),
            'speed_rpm': Column('pulley/pulley_roller/velocity', 30.0 / math.pi, 0, late=3.7e-3),
        },
        own_time='speed_t_us',
    ),
    'belt_by_voltage': Rig(
        """
        - {effect: coulomb_friction, place: pulley_roller, parameters: {torque: 0.01 N*m}}
        - {effect: inertia, place: pulley_left, parameters: {scale: 1.5}}
        - {effect: inertia, place: pulley_right, parameters: {scale: 1.5}}
        - {effect: sensor_rectified, place: speed_roller, parameters: {rectified: 1}}
        """,
        {'amplitude': '180 deg', 'duration': '20 s'},
        50.0,
        ('t_s', 1.0, 2),
        {
            'left_V': Column('actuator/pulley_left/effort', 1.0 / 0.05, 3),
            'right_V': Column('actuator/pulley_right/effort', 1.0 / 0.05, 3),
            'speed': Column('pulley/pulley_roller/velocity', 1.0, 2),
        },
    ),
}


def recorded(name: str, rig: Rig) -> Recording:
    """
    Simulate a rig as it truly is, with more rows than its logger writes.

    :param name: of the instrument.
    :param rig: what the instrument file does not say.
    :return: the recording.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f'{name}.yaml'
        path.write_text(f'base: {name}\neffects:{rig.truth}')
        truth = load_instrument(path)
    trajectory = chosen_trajectory('multisine', truth.motor_names, rig.motion)
    return simulate(truth, trajectory, rate=1000.0, seed=4)


def rows(rig: Rig, recording: Recording) -> list[dict[str, str]]:
    """
    Sample a recording as the rig's logger does.

    :param rig: the rig.
    :param recording: of the same.
    :return: cells by column.
    """
    rng = np.random.default_rng(4)
    clock = np.arange(int(recording.end * rig.rate)) / rig.rate
    clock = clock + rng.uniform(0.0, rig.jitter, clock.size)
    table = []
    header, factor, decimals = rig.time
    for stamp in clock[rng.random(clock.size) >= rig.lost]:
        row = {header: f'{factor * stamp:.{decimals}f}'}
        for name, column in rig.columns.items():
            channel = recording[column.channel]
            # the latest sample, not one between two: a reading is noisy and rounded
            at = np.searchsorted(channel.time, stamp + column.late, side='right') - 1
            if column.late:
                row[rig.own_time] = f'{1e6 * channel.time[at]:.0f}'
            value = round(column.factor * channel.value[at] + column.offset, column.decimals)
            row[name] = f'{value + 0.0:.{column.decimals}f}'
        table.append(row)
    return table


def main() -> None:
    """Write all recordings."""
    for name, rig in RIGS.items():
        table = rows(rig, recorded(name, rig))
        with (OUT / f'{name}.csv').open('w', newline='', encoding='utf-8') as stream:
            stream.write('# simulated by scripts/rig_recordings.py, not measured\n')
            writer = csv.DictWriter(stream, list(table[0]), lineterminator='\n')
            writer.writeheader()
            writer.writerows(table)


if __name__ == '__main__':
    main()
