"""
The next experiment: the motion and the channel that tell two explanations apart.

Every motion of a small library is tried on the model, with the channels that were measured and
with each one more that could be. How far the closest imitation of one explanation by the other
stays away, in noise deviations, says which experiment is worth its time.
"""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import partial
import math

from tendon_ros.base.errors import SimulationError
from tendon_ros.identify.axis import Axis
from tendon_ros.identify.driving import as_recorded, Drive, drives
from tendon_ros.identify.effort import Effort
from tendon_ros.identify.excitation_channel import channels, Sensed
from tendon_ros.identify.excitation_evidence import CYCLES, Evidence
from tendon_ros.identify.excitation_motion import library, Motion
from tendon_ros.identify.excitation_rig import fitting, reaches
from tendon_ros.identify.excitation_trial import Explanation, Trial
from tendon_ros.identify.tolerance import Tolerance, tolerances
from tendon_ros.model.instrument import contact_place, Instrument

Pair = tuple[Explanation, Explanation | None]

#: seconds of experiment that it is worth to do without a channel
PRICE = {'': 0.0, 'measured': 0.0, 'silent': 60.0, 'missing': 600.0}
#: [rad] how well it is known where a contact will be that is set up for an experiment
PLACED = Axis('position', 'rad', -0.03, 0.03, 0.0, 0.01, spread=1.0)


@dataclass(frozen=True)
class Suggestion:
    """
    An experiment and what it would tell.

    ``separates``: effects with their places. ``do``: a sentence. ``add_channel``: to be recorded
    besides, empty for none; ``status`` says whether its sensor is there ('silent') or not
    ('missing'). ``seconds``: until the explanations are five deviations apart, infinite where they
    never are. ``deviations``: of one second, growing with the root of time.
    """

    separates: tuple[tuple[str, str], ...]
    motion: Motion
    do: str
    add_channel: str
    status: str
    seconds: float
    deviations: float

    @property
    def order(self) -> tuple[float, float]:
        """Small where it is good: what time and channel cost, then how little it tells."""
        return self.seconds + PRICE[self.status], -self.deviations


def separating(
    instrument: Instrument,
    measured: Sequence[str],
    pairs: Sequence[Pair],
    jobs: int = 2,
    effort: Effort | None = None,
) -> list[Suggestion]:
    """
    Return the experiments that would tell explanations apart.

    :param instrument: the file, with the effects that are settled, and with the encoders by which
        its motors are controlled, recorded or not.
    :param measured: names of the channels that were recorded.
    :param pairs: what recordings could not tell apart: the one that is taken to hold, and the one
        that imitates it; None in its place for the file as it is.
    :param jobs: threads.
    :param effort: where what it costs is counted, if anywhere.
    :return: for each pair each motion with each channel, best first.
    :raises EffectError: where an effect cannot act at its place.
    :raises RecordingError: where a motor has neither an encoder nor a torque sensor.
    """
    # what drives a model of the recordings drives one of the experiment
    driving = drives(as_recorded(instrument, measured))
    sensed = channels(instrument, driving, measured)
    contacts = [contact_place(instrument, c) for c in instrument.contacts]
    movable = [
        *tolerances(instrument),
        *(Tolerance('contact_position', place, 'position', 'angle', PLACED) for place in contacts),
    ]
    rivals: dict[tuple[str, str, tuple[tuple[str, float], ...]], list[Pair]] = {}
    for (candidate, values), other in pairs:
        key = (candidate.effect, candidate.place, tuple(sorted(values.items())))
        rivals.setdefault(key, []).append(((candidate, values), other))
    with ThreadPoolExecutor(max(1, jobs)) as pool:
        wished = library(instrument, reaches(instrument))
        fitting(instrument, wished[0])  # alone: a kernel is loaded once, not by two threads
        motions = [m for m in pool.map(partial(fitting, instrument), wished) if m is not None]
        tasks = [(motion, group) for group in rivals.values() for motion in motions]
        counted = effort or Effort()
        tried = pool.map(
            lambda task: _tried(instrument, driving, sensed, movable, counted, *task), tasks
        )
        return sorted((s for found in tried for s in found), key=lambda s: s.order)


def together(suggestions: Sequence[Suggestion]) -> list[Suggestion]:
    """
    Return the experiments that serve several pairs at once.

    :param suggestions: of all pairs.
    :return: one for each motion and channel that every pair has, as good as for its worst pair,
        best first.
    """
    groups: dict[tuple[object, ...], list[Suggestion]] = {}
    for s in suggestions:
        made = (s.motion.shape, *s.motion.settings.values(), s.add_channel)
        groups.setdefault(made, []).append(s)
    most = max((len(group) for group in groups.values()), default=0)
    found = []
    for group in groups.values():
        if len(group) < most:
            continue
        worst = max(group, key=lambda s: s.order)
        names = dict.fromkeys(name for s in group for name in s.separates)
        found.append(replace(worst, separates=tuple(names)))
    return sorted(found, key=lambda s: s.order)


def _tried(
    instrument: Instrument,
    driving: Sequence[Drive],
    sensed: Sequence[Sensed],
    movable: Sequence[Tolerance],
    effort: Effort,
    motion: Motion,
    pairs: Sequence[Pair],
) -> list[Suggestion]:
    """Return what one motion tells of pairs with the same first explanation."""
    found = []
    try:
        trial = Trial(instrument, driving, sensed, movable, motion, pairs[0][0], effort)
        for truth, rival in pairs:
            rounds = trial.evidence(rival)
            names = [(e[0].effect, e[0].place) for e in (truth, rival) if e is not None]
            measured = [n for n, s in enumerate(sensed) if s.status == 'measured']
            added = [n for n, s in enumerate(sensed) if s.status != 'measured']
            for chosen in [measured, *([*measured, n] for n in added)]:
                if chosen:
                    # of what was found on the way, the closest imitation counts
                    closest = min(
                        (Evidence.joined(parts[n] for n in chosen) for parts in rounds),
                        key=lambda e: e.distance(1.0),
                    )
                    new = sensed[chosen[-1]] if chosen is not measured else None
                    found.append(_suggested(names, motion, new, closest))
    except SimulationError:
        # a motion that this rig cannot perform is none to suggest
        return []
    return found


def _suggested(
    names: Sequence[tuple[str, str]], motion: Motion, added: Sensed | None, evidence: Evidence
) -> Suggestion:
    seconds = evidence.seconds
    if math.isfinite(seconds):
        span = f'for {seconds:.0f} s'
    else:
        span = f'of which even {CYCLES[-1] * evidence.cycle:.0f} s decide nothing'
    also = f', with {added.title} recorded ({added.sensor.channel})' if added else ''
    return Suggestion(
        separates=tuple(names),
        motion=motion,
        do=f'{motion.sentence}, {span}{also}',
        add_channel=added.sensor.channel if added else '',
        status=added.status if added else '',
        seconds=seconds,
        deviations=evidence.rate,
    )
