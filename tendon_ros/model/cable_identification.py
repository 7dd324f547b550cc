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
from tendon_ros.model.instrument import Curve
from tendon_ros.model.instrument_build import curve
from tendon_ros.model.instrument_schema import CurveSection
from tendon_ros.model.quantity import parsed

FloatArray = NDArray[np.float64]

#: a, b, n, d0 [mm, N] at 5 N: where the search begins
_SEED = np.array([7.8, 1.35, 6.4, 0.63])
_SEED_PRETENSION = 5.0


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
    unknown = np.log(_SEED)
    # The law changes fast with pretension: walk there from where it is known.
    steps = max(2, 1 + round(8 * abs(np.log(pretension / _SEED_PRETENSION))))
    for now in np.geomspace(_SEED_PRETENSION, pretension, steps):
        found = root(_misses, unknown, args=(test, float(now)), tol=1e-13)
        unknown = found.x
    law = _law(unknown, pretension)
    if np.max(np.abs(_misses(unknown, test, pretension))) > 1e-9 or law.exponent <= 1.0:
        raise InstrumentError(
            f'forces: no a x + b x^n gives them at a pretension of {pretension:g} N; give forces '
            'that grow faster than the angle, or another pretension'
        )
    return law


def _law(unknown: FloatArray, pretension: float) -> PowerLaw:
    a, b, n, d0 = np.exp(unknown).tolist()
    return PowerLaw(a, b, n, 1e-3 * d0, pretension)


def _misses(unknown: FloatArray, test: BlockedTip, pretension: float) -> FloatArray:
    """Return the relative errors of the three forces and of the pretension."""
    with np.errstate(over='ignore', invalid='ignore'):
        law = _law(unknown, pretension)
        forces = law.net_force(test.elongations) / test.net_forces - 1.0
        preload = law.tension(np.array([law.preload])) / pretension - 1.0
    misses: FloatArray = np.nan_to_num(np.append(forces, preload), nan=1e6, posinf=1e6)
    return misses


def tabulated(law: PowerLaw, name: str, up_to: float, spacing: float = 2e-5) -> Curve:
    """
    Return a law as a table, as a tension test would give it.

    :param law: the law.
    :param name: of the curve.
    :param up_to: the table reaches at least this tension [N].
    :param spacing: between points [m].
    :return: the curve, tensions to six digits.
    """
    end: float = brentq(lambda x: float(law.tension(np.array([x]))[0]) - up_to, 0.0, 1.0)
    count = int(np.ceil(end / spacing - 1e-9))
    elongation = [float(f'{i * spacing:.6g}') for i in range(count + 1)]
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
