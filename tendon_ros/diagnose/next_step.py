"""The next experiment: what would separate the explanations that these data cannot."""

from __future__ import annotations

from collections.abc import Sequence

from tendon_ros.diagnose.prepare import Prepared
from tendon_ros.diagnose.result import Cause, NextExperiment
from tendon_ros.diagnose.search import Found
from tendon_ros.model.instrument import Instrument


def next_experiments(
    instrument: Instrument,
    measured: Sequence[str],
    ready: Prepared,
    found: Found,
    causes: Sequence[Cause],
) -> tuple[NextExperiment, ...]:
    """
    Return what to measure next, the most telling first.

    :param instrument: the network.
    :param measured: channels that were measured.
    :param ready: the problem.
    :param found: what the search has found.
    :param causes: with what they cannot be told from.
    :return: experiments; none where nothing is left to separate.
    """
    return ()
