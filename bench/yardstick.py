"""Builds and calls the yardstick, the kernel's method written by hand in C."""

from __future__ import annotations

import ctypes
from functools import cache
from pathlib import Path
import shutil
import subprocess
import tempfile
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tendon_ros.model.cable import elongation_at, uniform_cubic
from tendon_ros.model.instrument import Instrument
from tendon_ros.model.signals import Signals

FloatArray = NDArray[np.float64]

SOURCE = Path(__file__).with_name('yardstick.c')
FLAGS = ('-O3', '-march=native', '-shared', '-fPIC')
ORDER = ('M', '1', '2', '3', 'L')

_FIELDS = (
    ('inertia', 5), ('damping', 5), ('friction', 5), ('radius', 7), ('preload', 3),
    ('curve_start', 1), ('curve_rate', 1), ('contact_arm', 1), ('contact_position', 1),
    ('contact_stiffness', 1), ('contact_damping', 1), ('kp', 2), ('ki', 2), ('kd', 2),
    ('limit', 2), ('period', 1), ('tolerance', 1), ('eps', 1),
)  # fmt: skip


class _Rig(ctypes.Structure):
    _fields_ = [
        *((name, ctypes.c_double * count) for name, count in _FIELDS),
        ('cells', ctypes.c_long),
        ('contact_law', ctypes.c_long),
    ]


def compiler_found() -> bool:
    """Return whether there is a gcc."""
    return shutil.which('gcc') is not None


@cache
def _library(*, smooth: bool) -> Any:
    folder = Path(tempfile.mkdtemp(prefix='tendon_yardstick_'))
    target = folder / 'yardstick.so'
    macro = (f'-DSMOOTH={int(smooth)}',)
    subprocess.run(['gcc', *FLAGS, *macro, str(SOURCE), '-o', str(target), '-lm'], check=True)
    library = ctypes.CDLL(str(target))
    shutil.rmtree(folder)
    return library


class Yardstick:
    """
    The five-pulley rig in C.

    :param instrument: as :func:`bench.rig.five_pulleys` makes it.
    :param tolerance: local error of an angle in one step [rad].
    :param smooth: speed [rad/s] over which friction is smoothed; None where it sticks.
    """

    def __init__(
        self, instrument: Instrument, *, tolerance: float = 1e-7, smooth: float | None = None
    ) -> None:
        one = instrument
        self._call = _library(smooth=smooth is not None).rollout
        self._continuous = one.continuous_control
        start, rate, cubic = uniform_cubic(one.curves[0])
        self._table = np.ascontiguousarray(cubic, dtype=np.float64)
        friction = {
            use.place.removeprefix('pulley_'): use.parameters['coefficient'] for use in one.effects
        }
        m1, m2, m3 = (loop.route for loop in one.loops)
        contact = one.contacts[0]
        pulleys = {p.name: p for p in one.pulleys}
        controllers = [motor.controller for motor in one.motors]
        values: dict[str, Any] = {
            'inertia': [pulleys[name].inertia for name in ORDER],
            'damping': [pulleys[name].damping for name in ORDER],
            'friction': [friction.get(name, 0.0) for name in ORDER],
            'radius': [m1['M'], m1['1'], m2['1'], m2['3'], m2['2'], m3['L'], m3['3']],
            'preload': [elongation_at(one.curves[0], loop.pretension) for loop in one.loops],
            'curve_start': start,
            'curve_rate': rate,
            'contact_arm': contact.arm,
            'contact_position': contact.position if contact.enabled else 1e9,
            'contact_stiffness': contact.stiffness,
            'contact_damping': contact.damping,
            **{
                name: [getattr(c, name) for c in controllers]
                for name in ('kp', 'ki', 'kd', 'limit')
            },
            'period': one.control_period,
            'tolerance': tolerance,
            'eps': smooth or 0.0,
        }
        self._rig = _Rig()
        for name, count in _FIELDS:
            setattr(self._rig, name, (ctypes.c_double * count)(*np.atleast_1d(values[name])))
        self._rig.cells = len(self._table)
        self._rig.contact_law = int(contact.law == 'hunt_crossley')
        self.counts = (0, 0, 0)

    def run(self, setpoints: FloatArray | Signals, every: int = 1) -> FloatArray:
        """
        Run from rest.

        :param setpoints: shape (ticks, 2) [rad]; for continuous control also as ready signals.
        :param every: record every so many ticks.
        :return: rows as the kernel records them, shape (ticks, 22).
        :raises ArithmeticError: where it diverges.
        """
        if self._continuous:
            signals = setpoints
            if not isinstance(signals, Signals):
                signals = Signals.through(0.0, self._rig.period[0], signals.T)
            values = np.ascontiguousarray(np.concatenate([signals.value, signals.slope]))
            ticks = signals.value.shape[1] - 1
            rows = np.zeros((ticks // every + 1, 22))
        else:
            values = np.ascontiguousarray(np.asarray(setpoints).T)
            ticks = values.shape[1]
            rows = np.zeros(((ticks - 1) // every + 1, 22))
        counts = (ctypes.c_long * 3)()
        pointer = ctypes.POINTER(ctypes.c_double)
        status = self._call(
            ctypes.byref(self._rig),
            self._table.ctypes.data_as(pointer),
            values.ctypes.data_as(pointer),
            ctypes.c_long(ticks),
            ctypes.c_long(self._continuous),
            ctypes.c_long(every),
            rows.ctypes.data_as(pointer),
            counts,
        )
        self.counts = tuple(counts)
        if status != 0:
            raise ArithmeticError('the yardstick diverged')
        return rows
