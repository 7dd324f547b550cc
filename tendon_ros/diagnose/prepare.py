"""From admitted recordings to a least-squares problem: bins, walls, noise, what is held out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tendon_ros.base.recording import Recording
from tendon_ros.diagnose.bins import in_bins
from tendon_ros.diagnose.enough import BLOCK, enough, KEPT
from tendon_ros.diagnose.form import form_profile
from tendon_ros.diagnose.gap import beyond_noise, noise_of, offs
from tendon_ros.diagnose.noise import Noise
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Problem
from tendon_ros.identify.loosest import loosest
from tendon_ros.identify.rollout import Rollouts
from tendon_ros.identify.segment import ENDING, Segment, SETTLING
from tendon_ros.identify.tolerance import Tolerance, tolerances
from tendon_ros.model.instrument import Instrument

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

QUIETER = 2.0  # times less noise that call for another look
WHOLE = 6  # recordings from which on whole ones are held out


@dataclass(frozen=True)
class Prepared:
    """
    The problem of the fitted bins, that of those held out, and of both.

    ``shift``: by how many blocks what is held out has moved; ``looser``: times what is usual that
    numbers may be off of which the file does not say how well it knows them; ``likely``: where
    tolerances are likely to be, on their axes, where that is not the file.
    """

    problem: Problem
    held: Problem
    whole: Problem
    noise: Noise
    shift: int = 0
    looser: float = 1.0
    likely: tuple[float, ...] = ()

    def _on(self, rollouts: Rollouts) -> Prepared:
        """Return the same with other rollouts."""
        known = self.noise, self.shift, self.looser, self.likely
        return _problems(rollouts, self.problem.tolerances, *known)

    def toleranced(self, tolerances: Sequence[Tolerance]) -> Prepared:
        """
        Return the same with other tolerances.

        :param tolerances: what may move.
        :return: the problems.
        """
        problems = (self.problem, self.held, self.whole)
        problem, held, whole = (one.toleranced(tolerances) for one in problems)
        return replace(self, problem=problem, held=held, whole=whole)

    def heard_again(self, model: Model) -> Prepared:
        """
        Return the same with the noise that is heard once a model has taken its part away.

        :param model: what is believed.
        :return: the problems with the lower noise.
        """
        rollouts = self.whole.rollouts
        uses = self.whole.uses(model)
        predicted = rollouts.predicted(uses)
        noise = self.noise.beside(rollouts, uses, predicted)
        before = rollouts.segments
        segments = [
            replace(
                was,
                measured=tuple(
                    min(pair, key=lambda m: float(np.median(m.noise)))
                    for pair in zip(was.measured, now.measured, strict=True)
                ),
            )
            for was, now in zip(before, noise.given(before, predicted), strict=True)
        ]
        return replace(self, noise=noise)._on(rollouts.like(segments))

    def unrepeated(self, model: Model) -> Prepared:
        """
        Return the same where what differs when a motion is repeated is no noise.

        :param model: what is believed.
        :return: the problems with the noise beside it; these where no motion is repeated.
        """
        rollouts = self.whole.rollouts
        predicted = rollouts.predicted(self.whole.uses(model))
        every, within = (
            self.noise.given(rollouts.segments, predicted, repeated=repeated)
            for repeated in (True, False)
        )
        if all(
            np.array_equal(a.noise, b.noise)
            for one, other in zip(every, within, strict=True)
            for a, b in zip(one.measured, other.measured, strict=True)
        ):
            return self
        return self._on(rollouts.like(within))

    def read_again(self) -> Prepared:
        """Return the same had the motors been read once more, with other errors as large."""
        rollouts = self.whole.rollouts
        segments = [
            replace(segment, motion=again)
            for segment, (again, _) in zip(rollouts.segments, self.noise.motions, strict=True)
        ]
        return self._on(rollouts.like(segments))

    def quieter(self, other: Prepared) -> bool:
        """
        Return whether a channel tells much more here.

        :param other: the same recordings.
        :return: whether what was taken for noise there was not, and noise is what counts.
        """
        return any(
            np.median(b.doubt) > QUIETER * np.median(a.doubt)
            for mine, its in zip(
                self.whole.rollouts.segments, other.whole.rollouts.segments, strict=True
            )
            for a, b in zip(mine.measured, its.measured, strict=True)
        )

    def weighed(self, model: Model) -> Prepared:
        """
        Return the same with channels that weigh by what a model leaves of them.

        Where no law is quite right, noise says nothing of how well a channel can be foretold: the
        one with least noise would have all of its misfit explained by what spoils all others.

        :param model: what is believed.
        :return: the problems with what stays of each channel as its misfit.
        """
        noise = noise_of(self.problem)
        misfit = {
            channel: beyond_noise(off.rms, noise[channel])
            for channel, off in offs(self.problem, model).items()
        }
        segments = [
            replace(
                segment,
                measured=tuple(
                    replace(m, misfit=misfit.get(m.sensor.channel, 0.0)) for m in segment.measured
                ),
            )
            for segment in self.whole.rollouts.segments
        ]
        rollouts = self.whole.rollouts
        tolerance = loosest(rollouts.instrument, segments)
        again = rollouts.like(segments, tolerance)
        return self._on(again)

    def allowing(self, start: Model, model: Model) -> Prepared:
        """
        Return the same where bins count the less, the more laws may get wrong of them.

        Friction creeps where a motor trembles within a count. Where a pulley then stands is
        chance, for as long as the hold lasts: beside it all that moves would hardly count.

        :param start: without any cause.
        :param model: with causes, whose laws are doubted where they explain much.
        :return: the problems with what laws may get wrong of each bin.
        """
        whole = self.whole
        before = whole.fitted(start, rounds=0)
        state = whole.centred(whole.fitted(model, rounds=0))
        wrong = [np.zeros(mask.shape) for mask in whole.masks]
        for n, c, power in whole.groups(form_profile(whole, before, state)):
            wrong[n][c, whole.masks[n][c]] = np.sqrt(power)
        segments = [
            replace(
                segment,
                measured=tuple(
                    replace(m, by_law=part * m.doubt)
                    for m, part in zip(segment.measured, parts, strict=True)
                ),
            )
            for segment, parts in zip(whole.rollouts.segments, wrong, strict=True)
        ]
        return self._on(whole.rollouts.like(segments))

    def moved(self, shift: int) -> Prepared:
        """
        Return the same with other blocks held out.

        :param shift: by how many blocks to move them.
        :return: the problems.
        """
        return replace(self, shift=shift)._on(self.whole.rollouts)

    def loosened(self, looser: float) -> Prepared:
        """
        Return the same with other tolerances where the file states none.

        :param looser: times what is usual.
        :return: the problems.
        """
        moving = tolerances(self.whole.rollouts.instrument, looser)
        wider = replace(self, looser=looser).toleranced(moving)
        return wider.leaning(self.likely) if self.likely else wider

    def leaning(self, likely: Sequence[float]) -> Prepared:
        """
        Return the same with another opinion of where the numbers of the file are.

        :param likely: place of each tolerance on its axis.
        :return: the problems.
        """
        moving = [
            replace(t, axis=replace(t.axis, likely=z))
            for t, z in zip(self.problem.tolerances, likely, strict=True)
        ]
        return replace(self, likely=tuple(likely)).toleranced(moving)

    def unleant(self) -> Prepared:
        """
        Return the same where numbers lean on nothing.

        What a search has made likely is no knowledge, and makes no interval narrower.

        :return: the problems; these where no number leans.
        """
        if not self.likely:
            return self

        return self.toleranced(
            [
                replace(t, axis=replace(t.axis, repeated=False)) if t.guessed else t
                for t in self.problem.tolerances
            ]
        )


def prepared(recordings: Sequence[Recording], instrument: Instrument, jobs: int = 1) -> Prepared:
    """
    Make recordings ready to be diagnosed.

    :param recordings: admitted ones.
    :param instrument: the network.
    :param jobs: threads.
    :return: the problem.
    """
    binned = in_bins(recordings, instrument)
    tolerance = loosest(instrument, binned.segments)
    rollouts = Rollouts(instrument, binned.segments, jobs, tolerance)
    return _problems(rollouts, tolerances(instrument), binned.noise)


def _problems(
    rollouts: Rollouts,
    moving: Sequence[Tolerance],
    noise: Noise,
    shift: int = 0,
    looser: float = 1.0,
    likely: tuple[float, ...] = (),
) -> Prepared:
    segments = rollouts.segments
    usable = [(s.time > SETTLING) & (s.time < s.time[-1] - ENDING) for s in segments]
    held = held_out(segments, shift)
    return Prepared(
        Problem(rollouts, moving, [u & ~h for u, h in zip(usable, held, strict=True)]),
        Problem(rollouts, moving, [u & h for u, h in zip(usable, held, strict=True)]),
        Problem(rollouts, moving, usable),
        noise,
        shift,
        looser,
        likely,
    )


def held_out(segments: Sequence[Segment], shift: int = 0) -> list[BoolArray]:
    """
    Return which bins no fit may see.

    :param segments: the recordings.
    :param shift: by how many blocks, or recordings, to move what is held out.
    :return: one mask a segment: all but the recordings that differ most where there is more than
        fits need, every fourth recording where there are many, else blocks.
    """
    if len(segments) >= WHOLE:
        fitted = enough(segments, shift)
        return [np.full(len(s.time), n not in fitted) for n, s in enumerate(segments)]
    # where even the longest is shorter than that, its last block is held out all the same
    block = min(BLOCK, max(s.time[-1] for s in segments) / KEPT)
    # blocks of different recordings are staggered, so that no phase of a motion is always unseen
    return [
        (np.floor(s.time / block).astype(np.int64) + n + shift) % KEPT == KEPT - 1
        for n, s in enumerate(segments)
    ]
