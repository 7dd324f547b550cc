"""What is named: causes with their parameters, every candidate's probability, the verdict."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

from tendon_ros.diagnose.evidence import STRAINED
from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.gap import shrink_of
from tendon_ros.diagnose.intervals import parameter_intervals
from tendon_ros.diagnose.prepare import Prepared
from tendon_ros.diagnose.result import Candidate as Named
from tendon_ros.diagnose.result import Cause, FittedParameter, Judged, Verdict
from tendon_ros.diagnose.signs import Signs
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Fit, Problem
from tendon_ros.model.effect_use import units_at

#: a cause is named from here on
NAMED = 0.5
#: effects that change what links see of a body
BETWEEN = frozenset({'backlash', 'eccentricity'})
#: norm of a signature in noise deviations below which an effect cannot be seen
SHOWS = 5.0
#: part of a signature that must be its own, not what tolerances and causes can do as well
OWN = 0.05


@dataclass(frozen=True)
class Weighed:
    """
    A cause that was considered to the end.

    ``equal``: whoever cannot be told from it; ``signs``: what speaks for it; ``chance``: the
    probability that it is true, or one that equals it; ``without``: the fit without it.
    """

    cause: Candidate
    equal: tuple[Candidate, ...]
    signs: Signs
    chance: float
    without: Fit


def causes_of(heard: Prepared, start: Fit, final: Fit, kept: Sequence[Weighed]) -> list[Cause]:
    """
    Return causes with their parameters, and what each is worth.

    :param heard: the problem.
    :param start: the fit without any.
    :param final: the fit of what is kept.
    :param kept: its causes, in the order of that fit.
    :return: the causes in the same order.
    """
    intervals = parameter_intervals(heard.problem, final)
    causes = []
    for n, weighed in enumerate(kept):
        cause = weighed.cause
        values = final.model.values(n)
        units = units_at(heard.problem.rollouts.instrument, cause.effect, cause.place)
        # at another time, or in another recording, it goes by the same name
        names = dict.fromkeys((c.effect, c.place) for c in weighed.equal)
        names.pop((cause.effect, cause.place), None)
        causes.append(
            Cause(
                effect=cause.effect,
                place=cause.place,
                probability=weighed.chance,
                parameters={
                    p.name: FittedParameter(
                        value=values[p.name], unit=units[p.name], ci95=intervals[n][p.name]
                    )
                    for p in cause.parameters
                },
                indistinguishable=tuple(Named(effect=e, place=p) for e, p in names),
                shrink=shrink_of(heard.held, start.model, weighed.without.model, final.model),
                recording=cause.only,
            )
        )
    return causes


def verdict_of(causes: Sequence[Cause], beyond: float) -> Verdict:
    """
    Return the verdict.

    :param causes: that are named.
    :param beyond: probability that something of the gap has a cause that was not named.
    :return: one word.
    """
    if beyond < NAMED:
        return 'explained' if causes else 'no_gap'
    return 'partly_explained' if causes else 'unexplained'


def judged(
    found: Found,
    causes: Sequence[Cause],
    chances: Sequence[float],
    candidates: Sequence[Candidate],
    strain: Mapping[tuple[str, str], float],
    lone: Collection[str] = (),
    signed: Collection[Candidate] = (),
    adrift: Collection[str] = (),
) -> tuple[Judged, ...]:
    """
    Return every candidate with its probability, and whether these data could have shown it.

    :param found: what the search has found.
    :param causes: that are named.
    :param chances: of all causes that the search ended with.
    :param candidates: all that may be named.
    :param strain: by effect and place how many deviations a number has moved that was measured
        (:func:`strained`).
    :param lone: places of bodies that nothing is linked with.
    :param signed: lost signs of sensors whose readings show it.
    :param adrift: motors that torque drives: where they are is not known for long.
    :return: most probable first.
    """
    named = {(c.effect, c.place): c for c in causes}
    shared: dict[tuple[str, str], float] = {
        (c.effect, c.place): p for c, p in zip(found.final.model.causes, chances, strict=True)
    }
    for cause in causes:
        for other in cause.indistinguishable:
            part = cause.probability / (1 + len(cause.indistinguishable))
            shared[other.effect, other.place] = max(shared.get((other.effect, other.place), 0.0),
                                                    part)  # fmt: skip
    alike: dict[tuple[str, str], list[str]] = {}
    for cause in causes:
        members = [(cause.effect, cause.place)]
        members += [(o.effect, o.place) for o in cause.indistinguishable]
        for member in members:
            alike[member] = [f'{e} at {p}' for e, p in members if (e, p) != member]
    seen = {(p.candidate.effect, p.candidate.place): p for p in found.proposals}
    rows = []
    for candidate in candidates:
        key = (candidate.effect, candidate.place)
        proposal = seen.get(key)
        why = ''
        if alike.get(key):
            why = f'the data cannot tell it from {", ".join(alike[key])}'
        elif key in named:
            why = ''  # beside other causes it was seen, whatever trace it left at first
        elif candidate.effect in BETWEEN and candidate.place in lone:
            why = (
                'it acts between bodies: describe what is behind it as a second one, coupled to it'
            )
        elif candidate.waves and candidate.place in adrift:
            why = (
                'the angle was not recorded, and that of the model drifts: record it, or import '
                'the integral of a speed that has its sign as the position'
            )
        elif candidate in signed:
            why = 'its readings go below zero by more than noise'
        elif key in strain:
            why = (
                f'its number in the file has moved by {strain[key]:.2g} deviations of its '
                'tolerance, in which it may hide'
            )
        elif proposal is None or proposal.seen < SHOWS:
            why = 'at a size worth looking for it leaves no trace in these channels and motions'
        elif proposal.own < OWN * proposal.seen:
            why = 'what it does, the tolerances of the file do as well'
        chance = named[key].probability if key in named else shared.get(key, 0.0)
        rows.append(
            Judged(
                effect=candidate.effect,
                place=candidate.place,
                probability=chance,
                identifiable=not why,
                why_not=why,
            )
        )
    return tuple(sorted(rows, key=lambda r: (-r.probability, r.identifiable)))


def strained(problem: Problem, model: Model) -> dict[tuple[str, str], float]:
    """
    Return the numbers that were measured and have moved as far as they hardly can.

    :param problem: the fitted bins.
    :param model: the fitted model.
    :return: deviations of the tolerance, by the effect and place that move the number.
    """
    found: dict[tuple[str, str], float] = {}
    for t, z in problem.moved(model):
        cause = Candidate(t.effect, t.place)
        # what only a guess opens is no part of it
        if not t.guessed and any(p.name == t.parameter for p in cause.parameters):
            found[t.effect, t.place] = max(abs(z), found.get((t.effect, t.place), STRAINED))
    return {key: off for key, off in found.items() if off > STRAINED}
