"""
The model for prediction: all that foretells what no fit has seen, whether it is believed or not.

What a machine does is often told by effects that stand in for others which no catalogue has. They
are no explanation, and no report may name them as causes; a simulator or an estimator is better
off with them.
"""

from __future__ import annotations

from collections.abc import Sequence

from tendon_ros.diagnose.evidence import Predicting
from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.gap import gaps
from tendon_ros.diagnose.judge import foretells
from tendon_ros.diagnose.naming import causes_of, Weighed
from tendon_ros.diagnose.patch import doubted, patched
from tendon_ros.diagnose.prepare import Prepared
from tendon_ros.model.instrument import Instrument


def predicting(
    ready: Prepared,
    found: Found,
    weighed: Sequence[Weighed],
    accepted: Sequence[int],
    instrument: Instrument,
) -> tuple[Predicting, Instrument] | None:
    """
    Return what predicts best.

    :param ready: the problem.
    :param found: what the search has found.
    :param weighed: its causes.
    :param accepted: which of its causes are believed.
    :param instrument: the file as it was.
    :return: the effects that stand in and the gaps with them, and the instrument; None where
        nothing that is not believed foretells anything.
    """
    causes = found.final.model.causes
    extra = [k for k in range(len(causes)) if k not in accepted and foretells(ready, found, k)]
    extra = [k for k in extra if not causes[k].instants]  # nothing that happened happens again
    if not extra:
        return None
    kept = sorted({*accepted, *extra})
    model = found.final.model.without(*(k for k in range(len(causes)) if k not in kept))
    heard = ready.heard_again(model)
    fit = heard.problem.fitted(model, rounds=6)
    channels = gaps(heard.held, heard.held.empty, fit.model)
    repaired = doubted(patched(heard.problem, fit.model, instrument), channels)
    everything = causes_of(heard, found, fit, [weighed[k] for k in kept])
    stand_ins = [c for k, c in zip(kept, everything, strict=True) if k in extra]
    stand_ins.sort(key=lambda c: c.shrink.after - c.shrink.without_this)
    return Predicting(tuple(stand_ins), channels), repaired
