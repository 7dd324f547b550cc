"""
The first round of a search, from wherever guesses may have to begin.

Where numbers of the file are guesses, fits without any cause may have gone far to do without one,
and to sensors that know no sign. So causes are looked for beside the file's own numbers as well,
beside all that transmissions usually have, and beside a sign that is lost.
"""

from __future__ import annotations

from collections.abc import Sequence

from tendon_ros.diagnose.asking import lost, signless
from tendon_ros.diagnose.beyond import hopeless, outweighed
from tendon_ros.diagnose.everywhere import thinned_out
from tendon_ros.diagnose.excusing import excused
from tendon_ros.diagnose.guesses import astray, better, far_off
from tendon_ros.diagnose.rounds import MOST, Round
from tendon_ros.diagnose.steps import Steps
from tendon_ros.diagnose.valleys import from_afar, SETTLED
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.fit import Fit
from tendon_ros.identify.screening import Proposal, Screen, Seen


class FirstRound:
    """
    Looks for the first causes.

    :param steps: of the search.
    :param start: without any cause.
    :param usual: what a round is that has nothing special.
    :param seen: signatures beside the tolerances as they were fitted.
    """

    def __init__(self, steps: Steps, start: Fit, usual: Round, seen: Seen) -> None:
        self.problem = steps.problem
        self._steps = steps
        self._start = start
        self._usual = usual
        self._seen = seen
        #: what was found where channels should weigh by what it leaves of them
        self.unweighed: Fit | None = None

    def grown(self, screen: Screen, proposals: Sequence[Proposal]) -> Fit | None:
        """
        Return the start with the first causes.

        :param screen: of the start.
        :param proposals: beside the start, best first.
        :return: the best state; None where none needs a cause.
        """
        many = self._of_many()
        grown: Fit | None = None
        if many is None:
            grown = self._usual.grown(self._start, screen, proposals)
            if astray(self.problem, self._start, grown):
                grown = better(self.problem, grown, self._from_the_file())
        best = better(self.problem, many, grown, self._without_sign())
        if many is not None and best is many and outweighed(self.problem, self._start, many):
            self.unweighed = many
        return best

    def _without_sign(self) -> Fit | None:
        """Return the best state in which a sensor knows no sign: guesses were fitted to one."""
        fits = []
        asked = self._steps.candidates
        # to numbers that were fitted to a reading without its sign nothing looks like itself: who
        # left no trace beside them may be there all the same
        self._steps.candidates = self._steps.everybody
        for candidate in signless(self.problem, asked):
            alone = lost(self.problem.begun, candidate)
            afar = from_afar(self._steps, lost(self._start.model, candidate))
            fits += [afar, self._of_many(alone), self._from_the_file(alone)]
        self._steps.candidates = asked
        believed = [fit for fit in fits if fit and self._usual.believes(self._start, fit)]
        return better(self.problem, *believed)

    def _of_many(self, known: Model | None = None) -> Fit | None:
        """Return what is needed of what is known and usually there, if guesses ask for it."""
        if not far_off(self.problem, self._start):
            return None
        # guesses that have explained nearly all have little to come back for
        if self.problem.structured(self._start.left) < SETTLED:
            return None
        fit = thinned_out(self._steps, self._start, MOST, known)
        # where it leaves much, it is something else that is behind it
        if fit is None or hopeless(self.problem, self._start, fit):
            return None
        return fit if self._usual.believes(self._start, fit) else None

    def _from_the_file(self, known: Model | None = None) -> Fit | None:
        """Return causes that are found beside the numbers of the file as they are."""
        file = self.problem.fitted(known or self.problem.begun, rounds=0)
        # where nothing has moved far, signatures are what they are beside the tolerances fitted
        seen = None if far_off(self.problem, self._start) else self._seen
        screen = Screen(self.problem, file, seen)
        proposals = self._steps.screened(screen)
        grown = self._usual.grown(self._start, screen, proposals)
        # what is there or not shows only once the guesses have followed
        for asked in (proposals, [p for p in proposals if not p.sizes]):
            alone = self._usual.alone(file, asked)
            # an excuse has to be better than all others, and few are asked here
            if alone is None or excused(self.problem, alone.model):
                continue
            if self._usual.believes(self._start, alone):
                grown = better(self.problem, grown, alone)
        return grown
