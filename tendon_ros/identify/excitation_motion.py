"""
The motions among which the next experiment is chosen.

Six shapes, periodic over one cycle: three multisines, ramps, holds with reversals, quick steps.
Each moves one motor or all of them, touching nothing or pressed against a contact.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
import math
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from tendon_ros.model.instrument import Instrument
from tendon_ros.model.trajectory import Trajectory

FloatArray = NDArray[np.float64]

CYCLE = 6.0  # [s], what the slowest wave takes
FADE = 0.75  # [s] in which a motion swells at the beginning and fades at the end
SPACING = 2e-3  # [s] between points
LARGE = math.radians(10.0)
SMALL = 0.2  # of the large one: where dry friction sticks and play is not crossed

#: waves of a multisine, in cycles
_WAVES = MappingProxyType(
    {
        'slow_multisine': (1, 2, 3, 5),
        'multisine': (1, 3, 5, 8, 13),
        'fast_multisine': (6, 11, 17, 25, 37),
    }
)
#: places in turn, and the part of their time in which they are gone to
_PLACES = MappingProxyType(
    {
        'holds': ((1.0, 0.3, 0.7, -0.2, 0.2, -1.0, -0.4, 0.0), 0.5),
        'quick_steps': ((1.0, 0.0, -1.0, 0.0, 0.5, -0.5, 0.5, 0.0), 0.08),
    }
)
_WORDS = MappingProxyType(
    {
        'slow_multisine': 'swing {motors} slowly, at several frequencies up to 0.8 Hz,',
        'multisine': 'swing {motors} at several frequencies from 0.17 to 2.2 Hz,',
        'fast_multisine': 'swing {motors} fast, at several frequencies from 1 to 6.2 Hz,',
        'ramps': 'turn {motors} to and fro at constant speed,',
        'holds': 'turn {motors} in steps with holds and reversals,',
        'quick_steps': 'turn {motors} in quick steps,',
    }
)
#: all shapes, and by which part of the largest amplitude they are made
_SIZES = MappingProxyType(
    {
        'slow_multisine': (1.0,),
        'multisine': (1.0, SMALL),
        'fast_multisine': (0.25,),
        'ramps': (1.0, SMALL),
        'holds': (1.0,),
        'quick_steps': (0.5,),
    }
)


@dataclass(frozen=True)
class Motion:
    """
    One motion: ``shape``, how far each motor goes either way, and what the tip meets.

    ``swing`` [rad] by motor. Motors in ``start`` press against the contact ``against``: they touch
    it at that angle [rad] and swing from there to twice as far, and never back.
    """

    shape: str
    swing: Mapping[str, float]
    start: Mapping[str, float]
    against: str = ''

    @property
    def amplitude(self) -> float:
        """The largest way from the middle [rad]."""
        return max(abs(a) for a in self.swing.values())

    @property
    def settings(self) -> dict[str, str]:
        """What makes it, as a user reads it."""
        return {
            'motors': ', '.join(self.swing),
            'amplitude': f'{math.degrees(self.amplitude):.1f} deg',
            'contact': self.against or 'none',
        }

    @property
    def sentence(self) -> str:
        """What is to be done."""
        names = ' and '.join(self.swing) if len(self.swing) < 3 else 'all motors'
        where = f'pressed against {self.against}' if self.against else 'touching nothing'
        far = math.degrees(self.amplitude) * (2.0 if self.start else 1.0)
        span = f'by {far:.1f} deg' if self.start else f'by up to {far:.1f} deg either way'
        return f'{_WORDS[self.shape].format(motors=names)} {span}, {where}'

    def scaled(self, factor: float) -> Motion:
        """
        Return the same, larger or smaller.

        :param factor: by how much.
        :return: the motion.
        """
        return replace(self, swing={m: factor * a for m, a in self.swing.items()})

    def trajectory(self, motors: Sequence[str], cycles: int = 1) -> Trajectory:
        """
        Return the set-points.

        :param motors: all motors of the instrument; those that do not move stay at zero.
        :param cycles: how often the motion is repeated.
        :return: the trajectory; it begins and ends at zero.
        """
        points = round(cycles * CYCLE / SPACING) + 1
        time = SPACING * np.arange(points, dtype=np.float64)
        nearest = np.minimum(time, time[-1] - time)
        fade = np.sin(0.5 * np.pi * np.clip(nearest / FADE, 0.0, 1.0)) ** 2
        position = {m: np.zeros(points) for m in motors}
        for row, (motor, swing) in enumerate(self.swing.items()):
            wave = _wave(self.shape, row, time / CYCLE)
            if motor in self.start:
                position[motor] = fade * (self.start[motor] + swing * (1.0 + wave))
            else:
                position[motor] = fade * swing * wave
        return Trajectory(f'excite_{self.shape}', time, position)


def _wave(shape: str, row: int, turns: FloatArray) -> FloatArray:
    """Return a shape for the motor of that row, by cycles passed; at most one either way."""
    if shape in _WAVES:
        counts = np.array(_WAVES[shape])
        phases = np.random.default_rng(row).uniform(0.0, 2.0 * np.pi, len(counts))

        def swung(at: FloatArray) -> FloatArray:
            found: FloatArray = np.sin(2.0 * np.pi * np.outer(at, counts) + phases).sum(axis=1)
            return found

        return swung(turns) / float(np.abs(swung(np.linspace(0.0, 1.0, 1000))).max())
    if shape == 'ramps':
        # a different number of turns for each motor, so that no two always go together
        phase = (turns * (row + 1)) % 1.0
        return np.interp(phase, [0.0, 0.25, 0.75, 1.0], [0.0, 1.0, -1.0, 0.0])
    places, going = _PLACES[shape]
    order = np.roll(places, 3 * row)
    at = (turns % 1.0) * len(order)
    number = np.minimum(at.astype(np.int64), len(order) - 1)
    done = np.clip((at - number) / going, 0.0, 1.0)
    eased = done**3 * (10.0 + done * (6.0 * done - 15.0))
    before = np.roll(order, 1)[number]
    moved: FloatArray = before + (order[number] - before) * eased
    return moved


def library(instrument: Instrument, reach: Mapping[str, Mapping[str, float]]) -> list[Motion]:
    """
    Return the motions for an instrument, as large as they may ever be.

    :param instrument: its motors and contacts.
    :param reach: for each contact, by motor, how far the contact's coordinate goes for one radian
        of that motor.
    :return: the motions.
    """
    found = []
    for driven in _drives(instrument):
        for shape, sizes in _SIZES.items():
            for size in sizes:
                swing = dict.fromkeys(driven, size * LARGE)
                found.append(Motion(shape, swing, {}))
                for contact in instrument.contacts:
                    # the one that moves the contact most presses, the others swing less
                    by = {m: reach[contact.name][m] for m in driven}
                    strongest = max(driven, key=lambda m: abs(by[m]))
                    if abs(by[strongest]) < 0.05:
                        continue
                    pressed = {m: 0.5 * a for m, a in swing.items()}
                    pressed[strongest] *= math.copysign(1.0, by[strongest])
                    start = {strongest: contact.position / by[strongest]}
                    found.append(Motion(shape, pressed, start, contact.name))
    return found


def _drives(instrument: Instrument) -> list[tuple[str, ...]]:
    """Return which motors move together: each alone, and all."""
    alone: list[tuple[str, ...]] = [(m,) for m in instrument.motor_names]
    return alone if len(alone) == 1 else [*alone, instrument.motor_names]
