"""
What a diagnosis says, as it is written to ``diagnosis.json``.

Names and nesting are a contract with other programs. Lists are sorted, most first; numbers are in
the unit of their channel or parameter. :meth:`Diagnosis.model_dump_json` writes it, and
:meth:`Diagnosis.model_validate_json` reads it back.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

Verdict = Literal['no_gap', 'explained', 'partly_explained', 'unexplained']
Interval = tuple[float, float]


class _Frozen(BaseModel):
    model_config = ConfigDict(frozen=True, extra='forbid', ser_json_inf_nan='null')


class ChannelGap(_Frozen):
    """RMSE of one channel on segments that no fit has seen; ``ci95`` is that of ``after``."""

    channel: str
    unit: str
    before: float
    after: float
    noise_floor: float
    ci95: Interval


class Where(_Frozen):
    """A place, a regime, and the share of the gap that lies there."""

    place: str
    regime: str
    share: float = Field(ge=0.0, le=1.0)


class FittedParameter(_Frozen):
    """A parameter of a cause in SI units, with its 95 % interval."""

    value: float
    unit: str
    ci95: Interval


class Candidate(_Frozen):
    """An effect at a place."""

    effect: str
    place: str


class Shrink(_Frozen):
    """
    What one cause is worth on held-out data: RMSE of the channel in which it shows most.

    ``before``: no cause; ``without_this``: all others refitted; ``after``: all of them.
    """

    channel: str
    unit: str
    before: float
    without_this: float
    after: float


class Cause(_Frozen):
    """An effect that was found; ``recording``: that in which it happened, empty where in all."""

    effect: str
    place: str
    probability: float = Field(ge=0.0, le=1.0)
    parameters: Mapping[str, FittedParameter]
    indistinguishable: tuple[Candidate, ...] = ()
    shrink: Shrink
    recording: str = ''


class Judged(_Frozen):
    """An effect that was considered, and whether these data could have shown it."""

    effect: str
    place: str
    probability: float = Field(ge=0.0, le=1.0)
    identifiable: bool
    why_not: str = ''


class Unexplained(_Frozen):
    """The alternative 'none of these'."""

    probability: float = Field(ge=0.0, le=1.0)
    where: tuple[str, ...] = ()
    regime: str = ''


class NextExperiment(_Frozen):
    """What would separate what these data cannot."""

    separates: tuple[tuple[str, str], ...]
    do: str
    add_channel: str = ''


class Diagnosis(_Frozen):
    """
    The whole answer.

    ``beside``: effects that ``instrument.yaml`` has beside the named causes, since they hold on
    what no fit has seen; each may stand in for something else. ``fitted``: by channel of ``gap``
    the RMSE with numbers of the file fitted within their tolerances, and no effect added: what is
    gone by that is no merit of a cause. ``doubts``: why to mistrust the
    verdict itself, such as a unit that cannot be; ``left_out``: all else that is to be said.
    """

    schema_: Literal[1] = Field(default=1, alias='schema')
    verdict: Verdict
    gap: tuple[ChannelGap, ...]
    fitted: Mapping[str, float] = Field(default_factory=dict)
    closed_loop: tuple[ChannelGap, ...] = ()
    where: tuple[Where, ...]
    causes: tuple[Cause, ...]
    beside: tuple[Cause, ...] = ()
    candidates: tuple[Judged, ...]
    unexplained: Unexplained
    next_experiment: tuple[NextExperiment, ...] = ()
    doubts: tuple[str, ...] = ()
    left_out: tuple[str, ...] = ()
