"""What makes a verdict itself doubtful: units that cannot be, moments that spoil it."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
import math

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.errors import listed
from tendon_ros.base.recording import Recording
from tendon_ros.diagnose.bent import far_fetched
from tendon_ros.diagnose.evidence import Moved
from tendon_ros.diagnose.gap import noise_of, offs
from tendon_ros.diagnose.prepare import Prepared
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Problem
from tendon_ros.model.instrument import Instrument

FloatArray = NDArray[np.float64]

#: times that a motor's torque is weaker than it can be
WEAK = 20.0
#: part of what an angle varies by, and times its noise, beyond which it is not foretold at all
LOST, UNFORETOLD = 0.5, 10.0
#: times its noise that a channel is off from which on one wants to know when; and the part of that
#: which lies in one second, where something happened once
OFF, AT_ONCE = 2.0, 0.5
#: numbers at the end of their tolerance of which each may be the reason
FEW = 3
#: effects, and numbers of the file, by which torques or motions are another number of times as
#: large: other guesses may well be off by fifty times
SCALING = frozenset({'torque_gain', 'encoder_gain', 'inertia'})


def unheard_words(
    given: Sequence[Recording], kept: Sequence[Recording], instrument: Instrument
) -> list[str]:
    """
    Say which channels a verdict knows nothing of, since no recording's could be relied on.

    :param given: the recordings as they came.
    :param kept: what is left of them.
    :param instrument: its sensors measure the channels that matter.
    :return: a sentence for each.
    """
    known = {name for recording in kept for name in recording.channels}
    came = {name for recording in given for name in recording.channels}
    return [
        f'{sensor.channel} could not be judged: it was left out of every recording, as the notes '
        'say, and whatever shows there alone is not found'
        for sensor in instrument.sensors
        if sensor.channel in came - known
    ]


def absurd_words(moved: Sequence[Moved]) -> list[str]:
    """
    Say which guesses turned out so far off that the reason is rather another unit.

    :param moved: the numbers of the file as they were fitted.
    :return: a sentence for each.
    """
    return [
        f'the {one.quantity.replace("_", " ")} of {one.place} fits best as {one.value:.3g} times '
        'what the file guesses; where that cannot be, a recorded channel has another unit than '
        'its import says'
        for one in moved
        if one.absurd
    ]


def ended_words(moved: Sequence[Moved]) -> list[str]:
    """
    Say which numbers of the file something takes to the end of their tolerance.

    :param moved: the numbers of the file as they were fitted.
    :return: a sentence for each; one for all where they are too many for each to be the reason.
    """
    ended = [one for one in moved if one.ended]
    if len(ended) > FEW:
        names = listed(f'{one.quantity.replace("_", " ")} of {one.place}' for one in ended)
        return [
            f'{len(ended)} numbers of the file have moved to the ends of their tolerances, and '
            'still more is wanted: none of them is the reason, but whatever moves is taken to '
            'make up for something else. Where nothing is wrong with the recordings (a column, '
            'stamps or samples that were lost on the way), it is something that no effect is like '
            f'({names})'
        ]
    return [
        f'the {one.quantity.replace("_", " ")} of {one.place} has moved to the end of its '
        f'tolerance ({one.off:.2g} deviations), and still more is wanted: the file knows it less '
        'well than it says, it changes from one recording to the next, or something unknown is '
        'told by it'
        for one in ended
    ]


def weak_words(ready: Prepared, final: Model) -> list[str]:
    """
    Say which motors report far less than the motion takes, with all that was found.

    Without the causes, that is, by which torques or motions are another number of times as large:
    they are what a unit or a column that is another would be told as.

    :param ready: the problem.
    :param final: what was found.
    :return: a sentence for each motor's torque.
    """
    causes = enumerate(final.causes)
    whole = ready.whole
    uses = whole.uses(final.without(*(k for k, c in causes if c.effect in SCALING)))
    powers: dict[str, list[tuple[float, float]]] = {}
    for segment, rows in zip(whole.rollouts.segments, whole.rollouts.predicted(uses), strict=True):
        for m, row in zip(segment.measured, rows, strict=True):
            known = np.isfinite(m.value)
            if m.sensor.kind == 'motor_torque' and known.any():
                powers.setdefault(m.sensor.channel, []).append(
                    (float(np.sum(row[known] ** 2)), float(np.sum(m.value[known] ** 2)))
                )
    found = []
    for channel, parts in powers.items():
        expected, measured = np.sqrt(np.sum(parts, axis=0))
        if math.isfinite(expected) and expected > WEAK * measured:
            found.append(
                f'{channel} is {expected / max(measured, 1e-30):.0f} times weaker than this '
                'motion takes by the file: a column that was taken for another, or a unit (of the '
                'torque, or degrees as rad), is likelier than any effect'
            )
    return found


def scaled_words(final: Model, contested: Collection[Candidate] = ()) -> list[str]:
    """
    Say which encoders would be further off than any is.

    :param final: what was found, and what is used beside it.
    :param contested: those in whose place another effect does as well: friction, for one, of which
        a gain takes what part it can.
    :return: a sentence for each.
    """
    gains = [
        (cause.place, final.values(k)['gain'])
        for k, cause in enumerate(final.causes)
        if cause.effect == 'encoder_gain'
        and cause not in contested
        and far_fetched(cause, final.values(k))
    ]
    return [
        f'{place} would read {gain:.3g} times its angle, and no encoder is that far off: a unit '
        '(degrees as rad), its counts a turn, a gear ratio or a column that was taken for another '
        'is likelier than any effect'
        for place, gain in gains
    ]


def lost_words(ready: Prepared, final: Model) -> list[str]:
    """
    Say which angles are hardly foretold at all, with all that was found.

    :param ready: the problem.
    :param final: what was found.
    :return: a sentence for each.
    """
    problem = ready.whole
    off, noise = offs(problem, final), noise_of(problem)
    varies: dict[str, float] = {}
    for segment in problem.rollouts.segments:
        for m in segment.measured:
            if m.sensor.kind == 'angle' and m.sensor.channel in off:
                most = max(varies.get(m.sensor.channel, 0.0), float(np.nanstd(m.value)))
                varies[m.sensor.channel] = most
    return [
        f'{channel} varies by {spread:.2g} rad, and with all that was found it is foretold to '
        f'{off[channel].rms:.2g}: a column that was taken for another, a unit (degrees as rad) or '
        'a wrong route in the file is likelier than any effect'
        for channel, spread in varies.items()
        if off[channel].rms > max(LOST * spread, UNFORETOLD * noise[channel])
    ]


def brief_words(ready: Prepared, final: Model) -> list[str]:
    """
    Say of which channels most of what stays lies in one second: something happened there.

    :param ready: the problem, with its noise.
    :param final: what was found.
    :return: a sentence for each.
    """
    found = []
    noise = noise_of(ready.whole)
    for channel, seconds in _seconds(ready.whole, final).items():
        worst = max(seconds, key=lambda one: one.misfit)
        # every moment counts in two of them
        every = 0.5 * sum(one.misfit for one in seconds)
        usual = 0.5 * noise[channel] ** 2 * sum(one.samples for one in seconds)
        much = math.isfinite(every) and every > OFF**2 * usual
        if much and worst.misfit > AT_ONCE * every:
            found.append(
                f'{worst.misfit / every:.0%} of what stays of {channel} lies between '
                f'{worst.begin:.1f} and {worst.begin + 1.0:.1f} s of {worst.recording}: something '
                'happened there once (lost counts, a knock, a late message), and what acts all '
                'along is told the worse for it; leave that second out (--only), or record '
                'again'
            )
    return found


@dataclass(frozen=True)
class _Second:
    """What a model leaves of a channel in one second, as a sum of squares in its unit."""

    recording: str
    begin: float
    misfit: float
    samples: float


def _seconds(problem: Problem, model: Model) -> dict[str, list[_Second]]:
    """Return by channel what a model leaves, by seconds that begin every half second."""
    found: dict[str, list[_Second]] = {}
    predicted = problem.rollouts.predicted(problem.uses(model))
    for segment, rows, masks in zip(
        problem.rollouts.segments, predicted, problem.masks, strict=True
    ):
        half = np.floor(2.0 * (segment.start + segment.time)).astype(np.int64)
        begin = 0.5 * (np.arange(half[0], half[-1] + 2) - 1)
        for m, row, mask in zip(segment.measured, rows, masks, strict=True):
            off = np.where(mask, m.value - row, 0.0)
            halves = [np.bincount(half - half[0], weights) for weights in (off**2, mask)]
            misfit, samples = (np.convolve(part, (1.0, 1.0)) for part in halves)
            found.setdefault(m.sensor.channel, []).extend(
                _Second(segment.name, *one)
                for one in zip(begin.tolist(), misfit.tolist(), samples.tolist(), strict=True)
            )
    return found
