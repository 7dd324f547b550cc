"""
What a compiled kernel is specialised to: sizes, who touches whom, where each number lies.

Pulleys are put in reverse Cuthill-McKee order, so that the matrix of the network is banded.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import reverse_cuthill_mckee

from tendon_ros.model.instrument import Instrument

#: sensors that a kernel has room for, or a multiple of it: what they read is data, so that
#: another set of sensors is no other kernel
SENSORS = 16

#: the longest delay of a sensor, in controller periods
RING = 64

#: sizes of the named places in each array, in terms of the sizes of the network
PLACES: Mapping[str, Mapping[str, str]] = {
    'm': {
        'INERTIA': 'N', 'DAMPING': 'N', 'BREAKAWAY': 'N', 'DITHER': 'N', 'LASH': 'N',
        'RADIUS': 'M*WIDTH', 'ARM': 'M*WIDTH', 'PRELOAD': 'M', 'SCALE': 'M',
        'LOOP_DAMPING': 'M', 'PLAY': 'M', 'CURVE_START': 'M', 'CURVE_RATE': 'M',
        'CURVE_BELOW': 'M', 'CONTACT_RATIO': 'K*WIDTH', 'CONTACT_STIFFNESS': 'K',
        'CONTACT_DAMPING': 'K', 'CONTACT_POSITION': 'K',
        'CONTACT_ARM': 'K', 'MOTOR_GAIN': 'U', 'MOTOR_BIAS': 'U', 'MOTOR_LIMIT': 'U',
        'MOTOR_KNEE': 'U', 'KP': 'U', 'KI': 'U', 'KD': 'U', 'AHEAD': 'U', 'LIMIT': 'U',
        'SENSOR_GAIN': 'Q', 'SENSOR_OFFSET': 'Q', 'SENSOR_DELAY': 'Q', 'SENSOR_RESOLUTION': 'Q',
        'SENSOR_LAG': 'Q', 'SENSOR_KEPT': 'Q', 'SENSOR_NOISE': 'Q', 'PERIOD': '1',
        'TOLERANCE': '1', 'STILL': '1',
    },
    'd': {
        'DRIVE': 'N', 'MOTION': 'N', 'PUSH': 'N', 'REFERENCE': 'U', 'ENCODER': 'U',
        'INTEGRAL': 'U', 'BRISTLE': 'N', 'DRY': 'N', 'GEARED': 'N', 'DRIVEN': '1', 'PUSHED': '1',
        'BRISTLED': '1', 'CURVE_CELLS': 'M', 'CURVE_OFFSET': 'M',
        'CONTACT_LAW': 'K', 'CONTACT_ON': 'K', 'SENSORS': '1', 'SENSOR_SOURCE': 'Q',
        'SENSOR_INDEX': 'Q', 'SENSOR_RECTIFIED': 'Q', 'REMEMBERS': '1', 'ACTIVE': '1',
        'STATE_LOOP': 'STATES', 'STATE_PULLEY': 'STATES', 'BREAKS': '1', 'SWITCH': '1',
        'TORQUES': '2', 'BUDGETS': '2', 'ELONGATIONS': '2', 'RELAXATIONS': '2',
        'TENSIONS': '2', 'WINDINGS': '2',
    },
    'w': {
        'EPOCH': '1', 'INPUT': 'N', 'WOUND': 'N', 'TURN': 'N', 'CURL': 'N', 'FOLLOW': 'N',
        'ACCELERATION': 'N', 'DELTA': 'M', 'RATE': 'M', 'SHIFT': 'M', 'SHIFT_D': 'M',
        'TENSION': 'M', 'TENSION_D': 'M', 'TENSION_R': 'M', 'TOTAL': 'M', 'TOTAL_D': 'M',
        'SLACK': 'M',
        'TORQUE': 'N', 'TORQUE_T': 'N', 'TORQUE_W': 'N', 'LOAD': 'N',
        'LOAD_T': 'N', 'LOAD_W': 'N', 'LOAD_WAY': 'N', 'BUDGET': 'N',
        'BUDGET_W': 'N', 'BUDGET_L': 'N', 'SIDE': 'N', 'GAP': 'K', 'FORCE': 'K', 'FORCE_Q': 'K',
        'FORCE_V': 'K', 'STATE_RATE': 'STATES', 'STATE_A': 'STATES', 'STATE_B': 'STATES',
        'STATE_Z': 'STATES', 'STATE_T': 'STATES', 'STATE_S': 'STATES', 'J_LOOP': 'M',
        'J_LOOP_RATE': 'M', 'J_TOTAL': 'M', 'J_RADIUS': 'M*WIDTH', 'J_ARM': 'M*WIDTH',
        'J_GRIP': 'M*WIDTH', 'J_ANGLE': 'N', 'J_SPEED': 'N', 'J_CONTACT': 'K',
        'J_CONTACT_RATE': 'K', 'J_PRESS': 'K*WIDTH', 'J_A': 'STATES', 'J_B': 'STATES',
        'J_Z': 'STATES',
        'J_T': 'STATES', 'J_S': 'STATES', 'F': 'DIM', 'FIRST': 'DIM', 'START': 'DIM',
        'TRIAL': 'DIM', 'NEXT': 'DIM', 'STAGE': '6*DIM', 'RIGHT': 'DIM', 'OUTER': 'DIM',
        'KAPPA': 'M', 'SIGMA': 'M', 'CHI': 'M', 'MATRIX': 'N*SPAN', 'SLACK_START': 'M',
        'PENDING': 'N+K+M',
    },
    'c': {
        'CLOCK': '1', 'STEP': '1', 'TICK': '1', 'COMMAND': 'U', 'SUM': 'U', 'LAST': 'U',
        'READING': 'Q', 'DRAWN': '1', 'ROW': '1', 'ROOM': '1', 'NOISY': '1', 'DRUM': 'N',
        'PAST': 'Q*RING', 'SMOOTH': 'Q', 'BEFORE': 'Q',
    },
    'g': {'MODE': 'N', 'TOUCH': 'K', 'COUNT': '3'},
}  # fmt: skip


@dataclass(frozen=True)
class Structure:
    """
    What a compiled kernel is specialised to; instruments with equal structure share one.

    ``order[i]`` is the instrument's index of the pulley at place i of the kernel; ``sensors`` is
    the room for sensors, not their number.
    """

    order: tuple[int, ...]
    loop_pulley: tuple[tuple[int, ...], ...]
    contact_pulley: tuple[tuple[int, ...], ...]
    motor_pulley: tuple[int, ...]
    sensors: int

    @cached_property
    def constants(self) -> Mapping[str, int | tuple[int, ...]]:
        """Every name of ``kernel.structure`` with its value."""
        rows = (*self.loop_pulley, *self.contact_pulley)
        width = max((len(row) for row in rows), default=1)
        band = max((max(row) - min(row) for row in rows if row), default=0)
        sizes: dict[str, int] = {
            'N': len(self.order), 'M': len(self.loop_pulley), 'K': len(self.contact_pulley),
            'U': len(self.motor_pulley), 'Q': self.sensors, 'WIDTH': width,
            'BAND': band, 'SPAN': 2 * band + 1, 'RING': RING,
        }  # fmt: skip
        sizes['STATES'] = sizes['N'] + sizes['U'] + 2 * sizes['M']
        sizes['DIM'] = 2 * sizes['N'] + sizes['STATES']
        sizes['READINGS'] = 1 + 2 * sizes['N'] + 3 * sizes['U'] + sizes['M'] + sizes['K']
        out: dict[str, int | tuple[int, ...]] = dict(sizes)
        for array, places in PLACES.items():
            at = 0
            for name, size in places.items():
                out[name] = at
                at += _product(size, sizes)
            out[f'LENGTH_{array}'] = at
        out['LOOP_PULLEY'] = _padded(self.loop_pulley, width)
        out['CONTACT_PULLEY'] = _padded(self.contact_pulley, width)
        out['MOTOR_PULLEY'] = self.motor_pulley
        return out

    def __getitem__(self, name: str) -> int:
        value = self.constants[name]
        if isinstance(value, tuple):
            raise TypeError(f'{name} is a table')
        return value

    def length(self, array: str) -> int:
        """Return the length of the fixed part of one of the kernel's arrays."""
        return self[f'LENGTH_{array}']


def _product(size: str, sizes: Mapping[str, int]) -> int:
    """Return the value of a size such as ``6*DIM`` or ``N+K+M``."""
    total = 0
    for term in size.split('+'):
        value = 1
        for name in term.split('*'):
            value *= int(name) if name.isdigit() else sizes[name]
        total += value
    return total


def _padded(rows: Sequence[Sequence[int]], width: int) -> tuple[int, ...]:
    return tuple(i for row in rows for i in (*row, *([row[0]] * (width - len(row)))))


def structure_of(instrument: Instrument) -> Structure:
    """
    Return what the kernel is specialised to for an instrument.

    :param instrument: the network.
    :return: its structure, pulleys in an order that keeps the matrix banded.
    """
    return _structure(
        instrument.pulley_names,
        tuple(tuple(row.route) for row in instrument.links),
        tuple(tuple(c.route) for c in instrument.contacts),
        tuple(m.pulley for m in instrument.motors),
        -(-max(len(instrument.sensors), 1) // SENSORS) * SENSORS,
    )


@lru_cache(maxsize=64)
def _structure(
    pulleys: tuple[str, ...],
    links: tuple[tuple[str, ...], ...],
    contacts: tuple[tuple[str, ...], ...],
    motors: tuple[str, ...],
    sensors: int,
) -> Structure:
    """Return the structure of a network by its names: fits ask for it thousands of times."""
    n = len(pulleys)
    joined = np.eye(n)
    for route in (*links, *contacts):
        for a in route:
            for b in route:
                joined[pulleys.index(a), pulleys.index(b)] = 1.0
    order = tuple(int(i) for i in reverse_cuthill_mckee(csr_array(joined), symmetric_mode=True))
    place = {pulleys[i]: at for at, i in enumerate(order)}
    loop_pulley = tuple(tuple(place[name] for name in route) for route in links)
    contact_pulley = tuple(tuple(place[name] for name in route) for route in contacts)
    return Structure(
        order=order,
        loop_pulley=loop_pulley,
        contact_pulley=contact_pulley,
        motor_pulley=tuple(place[pulley] for pulley in motors),
        sensors=sensors,
    )
