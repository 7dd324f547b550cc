"""What a diagnosis rests on, gathered for the report."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
import math

import numpy as np

from tendon_ros.base.errors import listed
from tendon_ros.base.recording import unit_of
from tendon_ros.diagnose.belief import Belief
from tendon_ros.diagnose.evidence import Floor, Moved, Rival, Step, Trace
from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.gap import noise_of
from tendon_ros.diagnose.intervals import number_intervals
from tendon_ros.diagnose.judge import equals
from tendon_ros.diagnose.prepare import Prepared
from tendon_ros.diagnose.result import ChannelGap
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.driving import drives
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Fit, Problem

SHOWN = 30  # rivals
WORSE = 1.2  # times as far off as by the file, and as noise, that a channel is worse


def traces(ready: Prepared, final: Model) -> tuple[Trace, ...]:
    """
    Return every channel of every recording, measured and predicted.

    :param ready: the problem.
    :param final: what was found.
    :return: the signals.
    """
    whole = ready.whole
    before = whole.rollouts.predicted(whole.uses(whole.written))
    after = whole.rollouts.predicted(whole.uses(final))
    found = []
    for n, segment in enumerate(whole.rollouts.segments):
        for c, measured in enumerate(segment.measured):
            known = np.isfinite(measured.value)
            if not known.any():
                continue
            found.append(
                Trace(
                    recording=segment.name,
                    channel=measured.sensor.channel,
                    unit=unit_of(measured.sensor.channel),
                    time=segment.time[known],
                    measured=measured.value[known],
                    before=before[n][c][known],
                    after=after[n][c][known],
                    held_out=ready.held.masks[n][c][known],
                )
            )
    return tuple(found)


def steps(ready: Prepared, found: Found) -> tuple[Step, ...]:
    """
    Return the steps of the explanation.

    :param ready: the problem.
    :param found: what the search has found.
    :return: the gap after each cause.
    """
    rows = []
    known: set[Candidate] = set()
    for state in found.states:
        new = [c for c in state.model.causes if c not in known]
        known |= set(new)
        held = ready.held.left(state.model)
        rows.append(
            Step(
                effect=', '.join(c.effect for c in new),
                place=', '.join(c.place for c in new),
                gap=float(np.sqrt(np.mean(state.left**2))),
                held_out=float(np.sqrt(np.mean(held**2))) if len(held) else 0.0,
            )
        )
    return tuple(rows)


def floors(problem: Problem) -> tuple[Floor, ...]:
    """
    Return the noise of each channel, and how it was found.

    :param problem: the bins.
    :return: the floors.
    """
    return tuple(
        Floor(
            channel,
            unit_of(channel),
            value,
            'differences between neighbouring bins; the counts of the motor encoders sent through '
            'the model; where a motion is repeated, what differs from one time to the next',
        )
        for channel, value in noise_of(problem).items()
    )


def alternatives(problem: Problem, found: Found, held: Belief) -> list[Model]:
    """
    Return what may be instead of what was found.

    Guesses go to another valley with a rival that does as well, and back with a cause that is not
    there.

    :param problem: the bins.
    :param found: what the search has found.
    :param held: what is believed of it.
    :return: models with rivals that cannot be told from causes, and without those that are not
        believed.
    """
    models = []
    for k in range(len(held.weighed)):
        models += [rival.fit.model for rival in equals(problem, found, k)]
        if k not in held.accepted and math.isfinite(found.without[k].cost):
            models.append(found.without[k].model)
    return models


def read_right(ready: Prepared, final: Fit) -> list[Model]:
    """
    Return what may be instead of what was found, since the motion was read with errors.

    No force makes the errors of a motion. A fit makes little of them, by a stiff cable that is too
    soft or damped too much. With as many errors again the numbers go farther the same way: as far
    back they may be in truth.

    :param ready: the bins.
    :param final: the fit of what was found.
    :return: its model with the numbers back there, if motion drives it and the file guesses any.
    """
    by_motion = any(s.prescribed for s in ready.whole.rollouts.segments)
    if not by_motion or not any(t.guessed for t in ready.problem.tolerances):
        return []
    again = ready.read_again().problem.fitted(final.model, rounds=6, accuracy=1e-4).model.moved
    return [replace(final.model, moved=2.0 * final.model.moved - again)]


def moved(problem: Problem, final: Fit, others: Sequence[Model]) -> tuple[Moved, ...]:
    """
    Return the numbers of the file as they were fitted within their tolerances.

    :param problem: the bins.
    :param final: the fit of what was found.
    :param others: what may be instead.
    :return: the numbers with their intervals.
    """
    intervals = number_intervals(problem, final, others)
    owned = problem.owned(final.model)
    return tuple(
        Moved(
            t.place,
            t.quantity,
            t.axis.value(z),
            interval,
            t.axis.unit,
            t.guessed,
            0.0 if t.guessed else abs(z),
            t.supposed,
        )
        for t, z, interval, still in zip(
            problem.tolerances, final.model.moved, intervals, owned, strict=True
        )
        if not still
    )


def pushed_words(ready: Prepared) -> list[str]:
    """
    Say in which recordings the measured load pushes the model, since no wall of the file fits.

    :param ready: the problem.
    :return: a sentence, if there are any.
    """
    rollouts = ready.whole.rollouts
    known = {d.pulley for d in drives(rollouts.instrument) if d.by_torque}
    pushed = [s.name for s in rollouts.segments if not known.issuperset(s.pushed)]
    walls = [c.name for c in rollouts.instrument.contacts if c.enabled]
    if not pushed or not walls:
        return []
    return [
        f'no wall of the file ({listed(walls)}) fits what was met in {listed(pushed)}: there the '
        'measured load pushes the model and is no longer compared; correct position and stiffness '
        'of the wall where there is one'
    ]


def worse_words(channels: Sequence[ChannelGap]) -> list[str]:
    """
    Say which channels are foretold worse with what was found than by the file.

    :param channels: the gaps, before and after.
    :return: a sentence for each that has a gap then.
    """
    return [
        f'{gap.channel} is foretold worse than by the file ({gap.before:.3g} → {gap.after:.3g} '
        f'{gap.unit}, noise {gap.noise_floor:.3g}): what was fitted elsewhere does not hold '
        'there, so mistrust the numbers that moved'
        for gap in channels
        if gap.after > WORSE * max(gap.before, gap.noise_floor)
    ]


def rivals(found: Found) -> tuple[Rival, ...]:
    """
    Return what each candidate alone would explain.

    :param found: what the search has found.
    :return: most first.
    """
    total = max(found.start.cost, 1e-30)
    return tuple(
        Rival(p.candidate.effect, p.candidate.place, min(1.0, p.gain / total))
        for p in found.proposals[:SHOWN]
    )
