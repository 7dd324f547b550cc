"""Trajectories: where the motors are commanded to be, over time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
import csv
from dataclasses import dataclass
import math
from pathlib import Path
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.errors import listed, TrajectoryError
from tendon_ros.model.instrument import Instrument

FloatArray = NDArray[np.float64]

#: factor to rad by the suffix of a CSV column
_ANGLE_UNITS = MappingProxyType({'rad': 1.0, 'deg': math.pi / 180.0})


@dataclass(frozen=True)
class Trajectory:
    """
    Commanded positions, straight between the points and held after the last.

    ``time`` [s], shape (n,), begins at 0 and increases; ``position`` [rad] by motor, shape (n,)
    each. All are made read-only.

    :raises TrajectoryError: on no points, unequal lengths, NaN, or times that do not increase.
    """

    name: str
    time: FloatArray
    position: Mapping[str, FloatArray]

    def __post_init__(self) -> None:
        time = np.array(self.time, dtype=np.float64)
        if time.ndim != 1 or time.size == 0 or not self.position:
            raise TrajectoryError(f'{self.name}: is empty; give at least one point for one motor')
        columns = {motor: np.array(p, dtype=np.float64) for motor, p in self.position.items()}
        for motor, column in columns.items():
            if column.shape != time.shape:
                raise TrajectoryError(
                    f'{self.name}: motor {motor} has {column.size} positions for {time.size} '
                    'times; give one for each'
                )
        for title, column in {'time': time, **columns}.items():
            bad = np.flatnonzero(~np.isfinite(column))
            if bad.size:
                raise TrajectoryError(
                    f'{self.name}: {title} of point {bad[0]} is not a finite number; give one'
                )
        back = np.flatnonzero(np.diff(time) <= 0.0)
        if back.size:
            raise TrajectoryError(
                f'{self.name}: time of point {back[0] + 1} ({time[back[0] + 1]:g} s) does not '
                f'come after the one before ({time[back[0]]:g} s); sort the points'
            )
        if time[0] != 0.0:
            raise TrajectoryError(f'{self.name}: begins at {time[0]:g} s; count time from 0')
        for column in (time, *columns.values()):
            column.flags.writeable = False
        object.__setattr__(self, 'time', time)
        object.__setattr__(self, 'position', MappingProxyType(columns))

    def __reduce__(self) -> tuple[object, ...]:
        # a view of a dictionary does not travel to other processes
        return Trajectory, (self.name, self.time, dict(self.position))

    @property
    def motors(self) -> tuple[str, ...]:
        """Names of the motors, in the order of the columns."""
        return tuple(self.position)

    @property
    def duration(self) -> float:
        """Time of the last point [s]."""
        return float(self.time[-1])

    def ordered(self, motors: Sequence[str]) -> Trajectory:
        """
        Return the same with its columns in the order of an instrument's motors.

        :param motors: names of all motors of the instrument.
        :return: the trajectory.
        :raises TrajectoryError: where it says nothing of a motor, or has one that is not there.
        """
        if set(motors) != set(self.position):
            raise TrajectoryError(
                f'{self.name}: has positions of {listed(self.position)}, the instrument has the '
                f'motors {listed(motors)}; give one column for each'
            )
        return Trajectory(self.name, self.time, {m: self.position[m] for m in motors})

    def at(self, time: FloatArray | float) -> FloatArray:
        """
        Return positions at any times.

        :param time: [s], shape (k,); or one time.
        :return: [rad], shape (k, motors); or (motors,).
        """
        return np.stack([np.interp(time, self.time, p) for p in self.position.values()], axis=-1)

    def sample(self, period: float) -> FloatArray:
        """
        Return positions at the ticks of a controller, from 0 to the end.

        :param period: between ticks [s].
        :return: [rad], shape (ticks, motors).
        """
        ticks = math.floor(self.duration / period + 1e-9) + 1
        return self.at(period * np.arange(ticks, dtype=np.float64))


def check_limits(trajectory: Trajectory, instrument: Instrument) -> None:
    """
    Check that an instrument's motors may go where and as fast as a trajectory wants.

    :param trajectory: the trajectory.
    :param instrument: its motors' position and speed limits count.
    :raises TrajectoryError: at the first time beyond a limit, with the value; and for a motor that
        the instrument does not have.
    """
    motors = {motor.name: motor for motor in instrument.motors}
    for name, position in trajectory.position.items():
        if name not in motors:
            raise TrajectoryError(
                f'{trajectory.name}: {instrument.name} has no motor {name!r}; it has '
                f'{listed(motors)}'
            )
        low, high = motors[name].position_limit
        beyond = np.flatnonzero((position < low) | (position > high))
        if beyond.size:
            at = beyond[0]
            raise TrajectoryError(
                f'{trajectory.name}: motor {name} is sent to {position[at]:.6g} rad at '
                f'{trajectory.time[at]:g} s, but may go from {low:.6g} to {high:.6g} rad; make it '
                'smaller, or widen position_limit in the instrument file'
            )
        speed = np.diff(position) / np.diff(trajectory.time)
        fast = np.flatnonzero(np.abs(speed) > motors[name].speed_limit)
        if fast.size:
            at = fast[0]
            raise TrajectoryError(
                f'{trajectory.name}: motor {name} is sent at {speed[at]:.6g} rad/s at '
                f'{trajectory.time[at]:g} s, but may turn at {motors[name].speed_limit:.6g} '
                'rad/s; make it slower, or raise speed_limit in the instrument file'
            )


def load_trajectory(path: Path, motors: Sequence[str]) -> Trajectory:
    """
    Return the trajectory of a CSV file.

    :param path: CSV with a header: ``time_s``, and one column ``MOTOR_rad`` or ``MOTOR_deg`` for
        each motor that moves. Time is counted from its first row.
    :param motors: all motors of the instrument; those without a column stay at 0.
    :return: the trajectory, its motors in the order given.
    :raises TrajectoryError: on anything wrong in the file, with its line.
    """
    try:
        rows = list(csv.reader(path.read_text(encoding='utf-8-sig').splitlines()))
    except OSError as error:
        raise TrajectoryError(f'{path}: {error.strerror}; give an existing CSV file') from None
    except UnicodeDecodeError:
        raise TrajectoryError(f'{path}: is not UTF-8 text; give a CSV file') from None
    header = [title.strip() for title in rows[0]] if rows else []
    columns = [_column(path, title, motors) for title in header]
    names = [name for name, _ in columns]
    for name in {'time', *names}:
        if names.count(name) != 1:
            raise TrajectoryError(
                f'{path}: line 1: {names.count(name)} columns for {name}; give exactly one'
            )
    table = []
    for line, row in enumerate(rows[1:], start=2):
        if any(cell.strip() for cell in row):
            table.append(_numbers(f'{path}: line {line}', row, len(header)))
    values = np.array(table).reshape(len(table), len(header)) * [factor for _, factor in columns]
    time = values[:, names.index('time')]
    position = {
        motor: values[:, names.index(motor)] if motor in names else np.zeros_like(time)
        for motor in motors
    }
    return Trajectory(str(path), time - time[:1], position)


def _column(path: Path, title: str, motors: Sequence[str]) -> tuple[str, float]:
    """Return whose column it is, and the factor to SI units."""
    if title == 'time_s':
        return 'time', 1.0
    motor, _, unit = title.rpartition('_')
    if motor not in motors:
        raise TrajectoryError(
            f'{path}: line 1: no column is called {title!r}; there are time_s, and _rad or _deg '
            f'after one of the motors {listed(motors)}'
        )
    if unit not in _ANGLE_UNITS:
        raise TrajectoryError(
            f'{path}: line 1: {title!r} has no unit of angle; write {motor}_rad or {motor}_deg'
        )
    return motor, _ANGLE_UNITS[unit]


def _numbers(where: str, row: Sequence[str], count: int) -> list[float]:
    if len(row) != count:
        raise TrajectoryError(f'{where}: {len(row)} values for {count} columns; give one for each')
    try:
        return [float(cell) for cell in row]
    except ValueError as error:
        raise TrajectoryError(f'{where}: {error}; give numbers') from None
