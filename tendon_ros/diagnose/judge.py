"""How far to believe what was found: what speaks for each cause, and what speaks against it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
import math

import numpy as np
from numpy.typing import NDArray

from tendon_ros.diagnose.cancelling import its_own
from tendon_ros.diagnose.form import form_parts, form_power, own_power, summed, tie
from tendon_ros.diagnose.found import Found, Rival
from tendon_ros.diagnose.further import saved
from tendon_ros.diagnose.imitable import alike
from tendon_ros.diagnose.outstanding import stands_out_in_time
from tendon_ros.diagnose.prepare import Prepared
from tendon_ros.diagnose.signs import BOUNDLESS, LEFT_NOISE, probability, Signs
from tendon_ros.diagnose.worth import (
    by_channel,
    gains,
    LEAST,
    LEAST_IN_ONE,
    TAKES_EVENT,
    TIMES_EVENT,
)
from tendon_ros.identify.driving import drives
from tendon_ros.identify.fit import Fit, Problem

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

#: structured power that blocks which no fit has seen may leave without any effect: they are few,
#: right causes of 24 simulated cases left 0.02 to 0.15 there, those of a real joint 0.38
UNSEEN_NOISE = 0.5
#: part of what stays anywhere that counts against a cause: the unknown may be told by it, too
ELSEWHERE = 0.1
#: part of the samples where no other law acts from which on they speak for all: beside an unknown
#: stop, a weight and a spring explain what a fifth of them leaves
MOSTLY = 0.5
#: part of what laws may leave by which two places of a strong effect may differ by chance
LAW = 0.02


def equals(problem: Problem, found: Found, k: int, *, by_law: bool = True) -> list[Rival]:
    """
    Return the rivals that these data cannot tell from a cause.

    A rival whose parameters make it the cause by another name was left out before.

    :param problem: the fitted bins.
    :param found: what the search has found.
    :param k: which cause.
    :param by_law: whether also those that differ by no more than laws may be wrong by.
    :return: those whose misfit is as good.
    """
    final = found.final
    samples = len(final.left)
    allowed = tie(problem, final)
    if by_law:
        allowed += LAW * form_power(problem, found.start, final)
    return [r for r in found.rivals[k] if (r.fit.cost - final.cost) / samples <= allowed]


@dataclass(frozen=True)
class Stays:
    """
    What a model leaves that has a form, in noise power per sample: of each channel, of all.

    ``samples``: all that it leaves of the bins that were fitted, in noise deviations, shape
    (samples,).
    """

    by_channel: Mapping[str, float]
    whole: float
    samples: FloatArray


def stays(ready: Prepared, fit: Fit) -> Stays:
    """
    Return what a model leaves that has a form.

    A law that is not the machine's may be bent to what was fitted; what was held out tells.

    :param ready: the problem.
    :param fit: the model, as it was fitted.
    :return: that of the fitted bins, or of those that were held out where they leave more, by more
        than they may without any effect.
    """
    seen = _structure(ready.problem, fit.left)
    unseen = _structure(ready.held, ready.held.left(fit.model))
    return Stays(
        {
            name: max(power, unseen.by_channel.get(name, 0.0) - UNSEEN_NOISE)
            for name, power in seen.by_channel.items()
        },
        max(seen.whole, unseen.whole - UNSEEN_NOISE),
        fit.left,
    )


def _structure(problem: Problem, left: FloatArray) -> Stays:
    """Return the structured power of what is left; finite also of a model that diverges."""
    parts = problem.structured_by_channel(left)
    return Stays(
        {name: min(power / max(count, 1), BOUNDLESS) for name, (power, count) in parts.items()},
        min(problem.structured(left), BOUNDLESS),
        left,
    )


def signs_beside(problem: Problem, found: Found, without: Fit, left: Stays) -> Signs:
    """
    Return what speaks for what a fit does without.

    :param problem: the fitted bins.
    :param found: what the search has found.
    :param without: the fit without one cause, or without several that make up for one another.
    :param left: what all that may be believed leaves.
    :return: the signs; where the laws of all others, or of events, hardly act for most of the
        time, those of that time if they say more, since what a limit's law gets wrong, or one that
        lasts for a moment, says nothing of all else.
    """
    final = found.final
    parts = form_parts(problem, found.start, final)
    similar = alike(problem, final, without)
    others = [
        (cause, part)
        for cause, part in zip(final.model.causes, parts, strict=True)
        if cause in without.model.causes
    ]
    signs = [_signs(problem, found, (without, final), left, parts, similar)]
    for acting in (others, [(cause, part) for cause, part in others if cause.instants]):
        quiet = summed([part for _, part in acting], final) < LEAST_IN_ONE
        if not MOSTLY < np.mean(quiet) < 1.0:
            continue
        signs.append(
            _signs(
                problem,
                found,
                (_among(without, quiet), _among(final, quiet)),
                _structure(problem, _only(left.samples, quiet)),
                [_only(np.sqrt(part), quiet) ** 2 for part in parts],
                similar,
            )
        )
    return max(signs, key=probability)


def _only(samples: FloatArray, among: BoolArray) -> FloatArray:
    """Return samples of which only some count, those as much as if they were all."""
    return np.where(among, samples / math.sqrt(float(np.mean(among))), 0.0)


def _among(fit: Fit, among: BoolArray) -> Fit:
    """Return a fit to some of the samples."""
    left = _only(fit.left, among)
    return replace(fit, left=left, cost=fit.cost - float(fit.left @ fit.left - left @ left))


def _signs(
    problem: Problem,
    found: Found,
    fits: tuple[Fit, Fit],
    left: Stays,
    parts: Sequence[FloatArray],
    similar: Sequence[float],
) -> Signs:
    """
    Return the signs by fits without and with a cause.

    ``parts``: what the law of each cause may leave, and ``similar``: how much of it looks like
    what has gone.
    """
    without, final = fits
    channels = problem.channels()
    then, last = (by_channel(problem, fit.left) for fit in (without, final))
    # finite also of a model that diverges
    gain = {c: min(then[c], BOUNDLESS) - last[c] for c in channels}
    gained = {c: max(0.0, gain[c]) * np.count_nonzero(own) for c, own in channels.items()}
    every = max(float(sum(gained.values())), 1e-12)

    def there(power: Mapping[str, float]) -> float:
        return float(sum(power.get(c, 0.0) * gained[c] for c in channels)) / every

    wrong = [there(by_channel(problem, np.sqrt(part))) for part in parts]
    gone = set(final.model.causes) - set(without.model.causes)
    events = [cause for cause in gone if cause.instants]
    form = own_power(problem, found.start) + sum(wrong)
    grown = min(gains(problem, without, final)[0], BOUNDLESS)
    # numbers that have to be off without it speak for it, too, where it shows, if it does
    showing = sum(gained[c] * np.count_nonzero(own) for c, own in channels.items()) / every
    strain = (_strain(without) - _strain(final)) / (showing or len(final.left))
    return Signs(
        worth=max(there(gain) + strain, 1e-9),
        left=there(left.by_channel) + ELSEWHERE * left.whole,
        form=form,
        event=bool(events),
        beside=sum(power * part for power, part in zip(wrong, similar, strict=True)),
        part=grown / max(grown + left.whole, 1e-9),
        lone=bool(events)
        and all(stands_out_in_time(problem, without, final, event) for event in events),
    )


def _strain(fit: Fit) -> float:
    """Return what it costs a fit that numbers of the file are not where they are likely to be."""
    return fit.cost - float(fit.left @ fit.left)


#: probability that a cause has at most which spoils what no fit saw, which others undo, which only
#: makes less of noise, or which may be what laws get wrong once
IDLE = 0.3
#: part of what a cause gains per sample that is fitted which it may lose elsewhere
NOTHING = 0.01


def spoils(ready: Prepared, found: Found, without: Fit) -> bool:
    """
    Return whether what a fit does without makes worse what no fit has seen, by more than chance.

    A weak cause that is there may lose there what it gains: seconds differ by more than it does.
    One without which numbers of the file have to be off may lose what that costs.

    :param ready: the problem.
    :param found: what the search has found.
    :param without: the fit without one cause, or without several.
    :return: whether it loses more than seconds of no meaning would on average, and more than
        nothing beside what it gains where it was fitted; or more than it gains there, be it in one
        second.
    """
    final = found.final
    gain = saved(ready.held, without.model, final.model)
    fitted = max(0.0, without.cost - final.cost)
    held = sum(int(mask.sum()) for mask in ready.held.masks)
    samples = held / max(len(final.left), 1)
    # what was held out may be a hold, of which a damping says next to nothing
    nothing = NOTHING * fitted * samples
    strain = max(0.0, _strain(without) - _strain(final)) * samples
    chance = float(np.sqrt(gain @ gain)) + nothing + strain
    # what cannot be computed there is no help either
    return not float(gain.sum()) >= -min(chance, fitted + LEAST * held)


#: noise power per sample up to which what is left without a cause may be noise
NOISY = 1.1
#: part of what a cause takes away that neighbouring samples share, unless it is none; and the same
#: where guessed numbers can do most of what it does, all but so much of the amplitude
SHARED, SHARED_BESIDE, APART = 0.3, 0.6, 0.5


def takes_noise(problem: Problem, found: Found, k: int) -> bool:
    """
    Return whether a cause only makes less of noise.

    Much of the noise is what the counts of encoders that drive the model make of its torques, and
    how much depends on the inertia that they are multiplied by. If one is late, for one, a guessed
    inertia may be small: less is left, but what was left before was noise and no gap.

    :param problem: the fitted bins.
    :param found: what the search has found.
    :param k: which cause.
    :return: whether it is at one of these encoders, or such an inertia, nothing but noise is left
        without it, and no more of that has any form than recordings without any effect leave, or
        little of what it takes away has; more of it must have where guesses could do most of it as
        well.
    """
    without, final = found.without[k], found.final
    cause = final.model.causes[k]
    driving = {d.sensor.name for d in drives(problem.rollouts.instrument)}
    if cause.effect == 'inertia':
        driving = {f'pulley_{name}' for name in problem.rollouts.instrument.driven}
    if cause.place not in driving or without.cost > NOISY * len(without.left):
        return False
    before = problem.structured(without.left)
    shared = before - problem.structured(final.left)
    gain = gains(problem, without, final)[0]
    if before < LEFT_NOISE or shared < SHARED * gain:
        return True
    return shared < SHARED_BESIDE * gain and its_own(problem, final, k) < APART


def chance(ready: Prepared, found: Found, k: int, signs: Signs) -> float:
    """
    Return the probability that one cause is true, on all that is known.

    :param ready: the problem.
    :param found: what the search has found.
    :param k: which cause.
    :param signs: what speaks for it.
    :return: 0 to 1.
    """
    likely = probability(signs)
    # of all times, one fits what a law gets wrong; but then the law is wrong at other times, too
    alone = signs.lone or signs.part > TAKES_EVENT
    luck = signs.event and signs.worth < TIMES_EVENT * signs.form and not alone
    # and what a law gets wrong may be told by something else at its place
    drowned = signs.worth < signs.beside and not signs.lone
    happened = bool(found.final.model.causes[k].instants)
    spoilt = not happened and spoils(ready, found, found.without[k])
    noise = not happened and takes_noise(ready.problem, found, k)
    believed = not (spoilt or luck or drowned or noise)
    return likely if believed else min(IDLE, likely)
