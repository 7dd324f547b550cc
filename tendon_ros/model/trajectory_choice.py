"""A trajectory by name or file, with its settings as a user gives them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cache
import inspect
from pathlib import Path
from types import MappingProxyType
from typing import Any, get_args, get_origin, get_type_hints

from tendon_ros.base.errors import listed, TrajectoryError
from tendon_ros.base.quantity import parsed, written
from tendon_ros.model import trajectory_profiles
from tendon_ros.model.trajectory import load_trajectory, Trajectory
from tendon_ros.model.trajectory_setting import Setting

Profile = Callable[..., Trajectory]
Value = float | int | tuple[float, ...] | tuple[str, ...]


@cache
def profiles() -> Mapping[str, Profile]:
    """
    Return the named trajectories.

    :return: by name, functions of the motors and of settings; read-only.
    """
    found = {
        name: function
        for name, function in inspect.getmembers(trajectory_profiles, inspect.isfunction)
        if function.__module__ == trajectory_profiles.__name__ and not name.startswith('_')
    }
    return MappingProxyType(found)


def settings(name: str) -> Mapping[str, tuple[Value, Setting]]:
    """
    Return the settings of a named trajectory.

    :param name: of :func:`profiles`.
    :return: by name, default and data sheet, in the order of the function.
    """
    function = profiles()[name]
    hints = get_type_hints(function, include_extras=True)
    return {
        key: (parameter.default, hints[key].__metadata__[0])
        for key, parameter in inspect.signature(function).parameters.items()
        if key != 'motors'
    }


def chosen_trajectory(
    name_or_path: str, motors: Sequence[str], given: Mapping[str, str | Value] | None = None
) -> Trajectory:
    """
    Return a trajectory as a user names it.

    :param name_or_path: a name of :func:`profiles`, or a CSV file.
    :param motors: all motors of the instrument, in its order.
    :param given: settings, as SI values or as texts with units; lists are divided by commas.
    :return: the trajectory, a column for every motor.
    :raises TrajectoryError: on an unknown name, setting or motor, or a value out of bounds.
    """
    given = given or {}
    if name_or_path not in profiles():
        path = Path(name_or_path)
        if path.suffix.lower() != '.csv':
            raise TrajectoryError(
                f'no trajectory {name_or_path!r}; give a CSV file or one of {listed(profiles())}'
            )
        if given:
            raise TrajectoryError(f'{path}: a file takes no settings; leave out {listed(given)}')
        return load_trajectory(path, motors)
    known = settings(name_or_path)
    values: dict[str, Value] = {}
    for key, value in given.items():
        if key not in known:
            raise TrajectoryError(f'{name_or_path}: no setting {key!r}; it has {listed(known)}')
        kind = get_type_hints(profiles()[name_or_path])[key]
        values[key] = _checked(f'{name_or_path}: {key}', value, kind, known[key][1])
    for motor in values.get('driven', ()):  # type: ignore[union-attr]
        if motor not in motors:
            raise TrajectoryError(
                f'{name_or_path}: driven: no motor {motor!r}; there are {listed(motors)}'
            )
    return profiles()[name_or_path](motors, **values)


def _checked(field: str, value: str | Value, kind: Any, setting: Setting) -> Value:
    """Return a setting in its type, within its bounds."""
    if get_origin(kind) is tuple:
        parts = value.split(',') if isinstance(value, str) else value
        if not isinstance(parts, Sequence):
            raise TrajectoryError(f'{field}: {value!r} is no list; divide values by commas')
        inner = get_args(kind)[0]
        if inner is str:
            return tuple(str(part).strip() for part in parts)
        return tuple(float(_number(field, part, float, setting)) for part in parts)
    return _number(field, value, kind, setting)


def _number(field: str, value: Any, kind: type, setting: Setting) -> float | int:
    try:
        number = parsed(value, setting.unit) if isinstance(value, str) else float(value)
    except (TypeError, ValueError) as error:
        raise TrajectoryError(f'{field}: {error}') from None
    if kind is int and not number.is_integer():
        raise TrajectoryError(f'{field}: {value!r} is no whole number; give one')
    if not setting.low <= number <= setting.high:
        raise TrajectoryError(
            f'{field}: {value!r} is out of bounds; give {written(setting.low, setting.unit)} to '
            f'{written(setting.high, setting.unit)}'
        )
    return int(number) if kind is int else number
