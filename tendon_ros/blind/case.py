"""
One case: three recordings of a rig that differs from its file, and a label of what differs.

:func:`made` depends on seed, index and settings only.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
import math
from typing import Any

import numpy as np

from tendon_ros.base.errors import SimulationError
from tendon_ros.base.recording import Recording
from tendon_ros.blind import columns as k
from tendon_ros.blind.bench import LOOPS, MOTORS, nominal, nominal_rig, PULLEYS
from tendon_ros.blind.faults import chosen, Fault, renewed, rig_with
from tendon_ros.blind.gap import gap_of, Ran
from tendon_ros.blind.laws import KIN
from tendon_ros.blind.motion import setpoints
from tendon_ros.blind.rig import Rig, run
from tendon_ros.blind.sensing import clean, recorded
from tendon_ros.blind.setup import channel_sets, Setup
from tendon_ros.model.instrument import Instrument

#: the strata in the order in which cases take them; single effects make half of all
PATTERN = ('one', 'none', 'two_three', 'one', 'unknown', 'one', 'weak', 'withheld')
#: all strata; ``mixed`` is asked for by name: known effects beside one that no catalogue has
STRATA = (*dict.fromkeys(PATTERN), 'mixed')

#: a gap in noise floors: what is plain to see, and what is weak
PLAIN, WEAK = (3.0, 400.0), (1.0, 3.0)
_TRIES = 60
_SAME = 6  # tries at one place
_WHEEL = 0.03  # [m]: the motors' pulleys for which the motions are written
#: where the tables have what a file knows how well
_COLUMNS = {
    'inertia': k.INERTIA,
    'damping': k.DAMPING,
    'torque_gain': k.GAIN,
    'stiffness': k.STIFFNESS,
    'pretension': k.PRELOAD,
    'gravity.torque': k.WEIGHT,
    'gravity.phase': k.WEIGHT_PHASE,
}
#: what is guessed may be so many times as large or as small
_GUESS = 2.0


@dataclass(frozen=True)
class Settings:
    """
    What cases are like.

    ``bench``: the rig, one of :data:`~tendon_ros.blind.bench.BENCHES`; ``nuisance``: one standard
    deviation of the relative error of every inertia, stiffness and preload, three times that for
    damping; ``strata``, ``channels``: those to take in turn, of channels all that the rig has
    where none are given.
    """

    bench: str = 'bench'
    nuisance: float = 0.01
    strata: tuple[str, ...] = PATTERN
    channels: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Take all sets of channels that the rig has where none are given."""
        if not self.channels:
            object.__setattr__(self, 'channels', channel_sets(self.bench))


@dataclass(frozen=True)
class Case:
    """Recordings by kind, the label, and the file's instrument; ``withhold`` is for the run."""

    name: str
    recordings: Mapping[str, Recording]
    label: Mapping[str, Any]
    instrument: Instrument
    withhold: tuple[str, ...] = ()


def made(seed: int, index: int, settings: Settings | None = None) -> Case:
    """
    Return a case.

    :param seed: of the whole benchmark.
    :param index: of the case in it.
    :param settings: what cases are like.
    :return: recordings as a bag would give them, with the label.
    """
    settings = settings or Settings()
    rng = np.random.default_rng([seed, index])
    stratum = settings.strata[index % len(settings.strata)]
    turn = index % len(settings.strata) + index // len(settings.strata)
    channels = settings.channels[turn % len(settings.channels)]
    setup = Setup(settings.bench, channels)
    instrument = nominal(settings.bench)
    base = disturbed(nominal_rig(settings.bench), settings.nuisance, rng)
    _misjudge(base, instrument, rng)
    wheels = np.abs(base.routes).max(axis=0)[:2]
    reach = np.divide(_WHEEL, wheels, out=np.ones(2), where=wheels > 0.0)
    commands = {kind: setpoints(kind, reach, rng) for kind in setup.kinds}
    faults, ran, gaps = _faulty(base, stratum, setup, commands, settings.nuisance, rng)
    recordings = {
        kind: recorded(kind, one.values, one.out, commands[kind], instrument, setup.sampling, rng)
        for kind, one in ran.items()
    }
    label = {
        'stratum': stratum,
        'channels': channels,
        'bench': settings.bench,
        'nuisance': settings.nuisance,
        'seed': seed,
        'index': index,
        'effects': [
            {
                'effect': fault.effect,
                'place': fault.place,
                'values': fault.values(base),
                'recordings': list(fault.recordings),
                'gap_over_floor': gap,
            }
            for fault, gap in zip(faults, gaps, strict=True)
        ],
    }
    withhold: tuple[str, ...] = ()
    if stratum == 'withheld':
        withhold = KIN.get(faults[0].effect, (faults[0].effect,))
    return Case(f'case_{index:04d}', recordings, label, instrument, withhold)


def disturbed(rig: Rig, nuisance: float, rng: np.random.Generator) -> Rig:
    """
    Return a rig whose every number is a little off.

    :param rig: as the file says.
    :param nuisance: one standard deviation, relative.
    :param rng: draws.
    :return: a new rig.
    """
    one = rig.copy()

    def off(by: float, size: int) -> np.ndarray[Any, np.dtype[np.float64]]:
        return 1.0 + by * nuisance * np.clip(rng.standard_normal(size), -3.0, 3.0)

    one.pulleys[:, k.INERTIA] *= off(1.0, 5)
    one.pulleys[:, k.DAMPING] *= off(3.0, 5)
    one.loops[:, k.STIFFNESS] *= off(1.0, 3)
    one.loops[:, k.PRELOAD] *= off(1.0, 3)
    one.contact[k.CONTACT] *= off(1.0, 1)[0]
    one.contact[k.CONTACT_DAMPING] *= off(3.0, 1)[0]
    return one


def _misjudge(rig: Rig, instrument: Instrument, rng: np.random.Generator) -> None:
    """Let what the file guesses be something else, and what it knows so well be as far off."""
    tables = {
        'motor': (rig.motors, MOTORS),
        'pulley': (rig.pulleys, PULLEYS),
        'cable': (rig.loops, LOOPS),
    }
    for name, tolerance in instrument.tolerances.items():
        place, quantity = name.split('.', 1)
        kind, _, of = place.partition('_')
        table, names = tables[kind]
        row = table[names.index(of)]
        if math.isinf(tolerance):
            row[_COLUMNS[quantity]] *= _GUESS ** rng.uniform(-1.0, 1.0)
        elif quantity.endswith('.phase'):
            row[_COLUMNS[quantity]] += tolerance * rng.standard_normal()
        else:
            row[_COLUMNS[quantity]] *= math.exp(tolerance * rng.standard_normal())


def ran_all(
    base: Rig, faults: tuple[Fault, ...], setup: Setup, commands: Mapping[str, Any]
) -> dict[str, Ran]:
    """
    Return the three runs of a rig with faults.

    :param base: the rig without them.
    :param faults: what is wrong.
    :param setup: which rig, and which of its sensors there are.
    :param commands: set-points by kind.
    :return: runs by kind.
    """
    result = {}
    for kind in setup.kinds:
        rig = rig_with(base, faults, kind)
        closed = setup.closed(kind)
        out = run(rig, commands[kind], closed=closed)
        result[kind] = Ran(out, clean(rig, out, setup.channels, closed=closed), closed)
    return result


def _faulty(
    base: Rig,
    stratum: str,
    setup: Setup,
    commands: Mapping[str, Any],
    nuisance: float,
    rng: np.random.Generator,
) -> tuple[tuple[Fault, ...], dict[str, Ran], list[float]]:
    """Draw faults until each one's gap is in the window of its stratum."""
    if stratum == 'none':
        return (), ran_all(base, (), setup, commands), []
    low, high = WEAK if stratum == 'weak' else PLAIN
    faults = chosen(stratum, setup, rng)
    for attempt in range(1, _TRIES):
        try:
            ran = ran_all(base, faults, setup, commands)
            gaps = [gap_of(base, faults, n, ran, commands, setup) for n in range(len(faults))]
        except SimulationError:
            gaps = [math.inf] * len(faults)
        if all(low <= gap <= high for gap in gaps):
            return faults, ran, gaps
        faults = tuple(
            f if low <= gap <= high else f.larger(_factor(gap, low, high, rng))
            for f, gap in zip(faults, gaps, strict=True)
        )
        for n, fault in enumerate(faults):
            late = attempt % _SAME == 0 and not low <= gaps[n] <= high
            if late or fault.out_of_bounds(nuisance):
                # the same effect elsewhere at first, so that subtle ones have their chance too
                keep = attempt < _SAME
                faults = renewed(faults, n, setup, rng, keep=keep)
    raise SimulationError(
        f'blind case: no fault of stratum {stratum} found within {_TRIES} draws; take another seed'
    )


def _factor(gap: float, low: float, high: float, rng: np.random.Generator) -> float:
    """Return by what a fault has to grow, so that its gap comes into a window."""
    if gap > 1e4:
        return 0.5
    aim = math.exp(rng.uniform(math.log(1.15 * low), math.log(0.9 * min(high, 8.0 * low))))
    return min(10.0, max(0.1, aim / max(gap, 1e-3)))
