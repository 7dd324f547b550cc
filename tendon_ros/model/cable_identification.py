"""
A cable's curve from three forces at a blocked tip, as the paper states them; and from a table.

With the tip blocked and equal loops in series, a turn of the motor stretches each loop by the same
``delta = R dtheta / loops``, and the force at the tip is ``F = T(delta) R / arm``. Of
``T(delta) = t(d0 + delta) - t(d0 - delta)`` and ``t(x) = a x + b x^n``, three forces and the
pretension ``t(d0)`` are four equations for a, b, n and d0.
"""

from __future__ import annotations

from collections.abc import Sequence
import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, root

from tendon_ros.base.errors import InstrumentError
from tendon_ros.base.quantity import parsed
from tendon_ros.model.instrument import Curve
from tendon_ros.model.instrument_build import curve
from tendon_ros.model.instrument_schema import CurveSection

FloatArray = NDArray[np.float64]

#: where the search begins, a case that is solved: the paper's forces at a pretension of 5 N
_SOLVED_A_B_N_D0 = np.array([7.766989, 1.345426, 6.365265, 0.6342057])  # in mm and N
_SOLVED_FORCES = np.array([0.1745329, 0.8726646, 1.2217305, 3.05, 30.0, 250.0 / 3.0, 5.0])


@dataclass(frozen=True)
class BlockedTip:
    """
    What was measured: ``forces`` as pairs of motor angle beyond touch [rad] and tip force [N].

    ``radius`` [m] of all pulleys, ``arm`` [m] of the tip, number of equal ``loops`` in series.
    """

    forces: tuple[tuple[float, float], ...]
    radius: float
    arm: float
    loops: int

    @property
    def elongations(self) -> FloatArray:
        """Elongation of each loop [m]."""
        return np.array([self.radius * angle / self.loops for angle, _ in self.forces])

    @property
    def net_forces(self) -> FloatArray:
        """Net force of each loop [N]."""
        return np.array([force * self.arm / self.radius for _, force in self.forces])


@dataclass(frozen=True)
class PowerLaw:
    """``t(x) = linear x + factor x^exponent`` with x in mm and t in N; preload elongation [m]."""

    linear: float
    factor: float
    exponent: float
    preload: float
    pretension: float

    def tension(self, elongation: FloatArray) -> FloatArray:
        """
        Return the tension of one cable.

        :param elongation: [m].
        :return: [N], 0 where slack.
        """
        x = np.maximum(1e3 * elongation, 0.0)
        tension: FloatArray = self.linear * x + self.factor * x**self.exponent
        return tension

    def net_force(self, elongation: FloatArray) -> FloatArray:
        """
        Return the net force of a loop of two such cables.

        :param elongation: [m].
        :return: [N].
        """
        return self.tension(self.preload + elongation) - self.tension(self.preload - elongation)


def identified(test: BlockedTip, pretension: float) -> PowerLaw:
    """
    Return the law that gives the three forces exactly.

    :param test: three forces, each larger than in proportion to its angle (a hardening cable).
    :param pretension: of each cable [N].
    :return: the law.
    :raises InstrumentError: where there are not three forces, or no such law meets them.
    """
    if len(test.forces) != 3:
        raise InstrumentError(
            f'forces: {len(test.forces)} given; a law with three numbers takes 3'
        )
    if pretension <= 0.0:
        raise InstrumentError(f'pretension: {pretension:g} N must be positive')
    wanted = np.concatenate([1e3 * test.elongations, test.net_forces, [pretension]])
    if np.any(wanted <= 0.0):
        raise InstrumentError('forces: angles and forces must be positive')
    # The law changes fast with what it has to meet: walk there from a case that is solved.
    way = np.log(wanted / _SOLVED_FORCES)
    steps = 1 + int(10.0 * np.max(np.abs(way)))
    unknown = np.log(_SOLVED_A_B_N_D0)
    for part in np.linspace(0.0, 1.0, steps + 1)[1:]:
        unknown = root(_misses, unknown, _SOLVED_FORCES * np.exp(part * way), tol=1e-13).x
    law = _law(unknown, pretension)
    if np.max(np.abs(_misses(unknown, wanted))) > 1e-9 or law.exponent <= 1.0:
        raise InstrumentError(
            f'forces: no a x + b x^n gives them at a pretension of {pretension:g} N; give forces '
            'that grow faster than the angle, or another pretension'
        )
    return law


def _law(unknown: FloatArray, pretension: float) -> PowerLaw:
    a, b, n, d0 = np.exp(unknown).tolist()
    return PowerLaw(a, b, n, 1e-3 * d0, pretension)


def _misses(unknown: FloatArray, wanted: FloatArray) -> FloatArray:
    """Return the relative errors of the three net forces and of the pretension."""
    elongation, pretension = 1e-3 * wanted[:3], wanted[6]
    with np.errstate(over='ignore', invalid='ignore'):
        law = _law(unknown, pretension)
        made = np.append(law.net_force(elongation), law.tension(np.array([law.preload])))
        misses: FloatArray = np.nan_to_num(made / wanted[3:] - 1.0, nan=1e6, posinf=1e6)
    return misses


SPACING = 2e-5  # between points of a table [m]


def tabulated(law: PowerLaw, name: str, up_to: float) -> Curve:
    """
    Return a law as a table, as a tension test would give it.

    :param law: the law.
    :param name: of the curve.
    :param up_to: the table reaches at least this tension [N].
    :return: the curve, tensions to six digits.
    """
    end: float = brentq(lambda x: float(law.tension(np.array([x]))[0]) - up_to, 0.0, 1.0)
    count = int(np.ceil(end / SPACING - 1e-9))
    elongation = [float(f'{i * SPACING:.6g}') for i in range(count + 1)]
    tension = [float(f'{t:.6g}') for t in law.tension(np.array(elongation))]
    return Curve(name, tuple(elongation), tuple(tension))


def curve_from_table(path: Path) -> Curve:
    """
    Return the curve of a tension test.

    :param path: CSV with a header, one column ``elongation_UNIT`` and one ``tension_UNIT`` or
        ``force_UNIT``, such as ``elongation_mm,tension_N``; rows in order of elongation.
    :return: the curve, named after the file.
    :raises InstrumentError: where the file cannot be read or is no monotone curve; with its line.
    """
    try:
        rows = list(csv.reader(path.read_text(encoding='utf-8').splitlines()))
    except (OSError, UnicodeDecodeError) as error:
        raise InstrumentError(f'{path}: cannot be read ({error}); give a CSV file') from None
    header = [name.strip() for name in rows[0]] if rows else []
    elongation = _column(path, header, rows, ('elongation',), 'm')
    tension = _column(path, header, rows, ('tension', 'force'), 'N')
    try:
        return curve(
            path.stem, CurveSection.model_construct(elongation=elongation, tension=tension)
        )
    except InstrumentError as error:
        raise InstrumentError(f'{path}: {error}') from None


def _column(
    path: Path,
    header: Sequence[str],
    rows: Sequence[Sequence[str]],
    names: Sequence[str],
    unit: str,
) -> tuple[float, ...]:
    places = [i for i, title in enumerate(header) if title.partition('_')[0] in names]
    if len(places) != 1:
        raise InstrumentError(
            f'{path}: line 1: {len(places)} columns for {" or ".join(names)}; head one column '
            f'{names[0]}_{"mm" if unit == "m" else unit}'
        )
    own = header[places[0]].partition('_')[2]
    values = []
    for line, row in enumerate(rows[1:], start=2):
        if not any(cell.strip() for cell in row):
            continue
        cell = row[places[0]].strip() if places[0] < len(row) else ''
        try:
            values.append(parsed(f'{cell} {own}', unit))
        except ValueError as error:
            raise InstrumentError(f'{path}: line {line}: {error}') from None
    return tuple(values)
