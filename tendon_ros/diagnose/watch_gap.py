"""Whether the gap of a channel has grown past what is known of it, without flickering."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
import math
from pathlib import Path

from tendon_ros.base.errors import RecordingError
from tendon_ros.diagnose.result import Diagnosis

#: looks in a row that make a gap grown, and that make it small again
RAISED, LOWERED = 2, 3
#: part of the limit below which a grown gap is small again
RELIEF = 0.8


@dataclass(frozen=True)
class WatchedGap:
    """
    The gap of one channel over one window.

    ``gap`` and ``floor`` (of the noise) are RMSE in ``unit``; ``explained`` is what is known not
    to be explained any better, NaN while it is being learnt; ``limit`` is what the gap may reach.
    """

    channel: str
    unit: str
    gap: float
    floor: float
    explained: float
    limit: float
    grown: bool


class GapJudge:
    """
    Judges the gap of one channel from look to look.

    :param channel: its name.
    :param unit: its unit.
    :param ratio: times what is explained, or times the noise where that is more, a gap may reach.
    :param explained: what the effects of the file leave, RMSE; NaN: the largest gap of the first
        looks.
    :param learn: how many looks those are.
    """

    def __init__(
        self, channel: str, unit: str, ratio: float, explained: float, learn: int
    ) -> None:
        self._channel = channel
        self._unit = unit
        self._ratio = ratio
        self._explained = explained
        self._left = learn if math.isnan(explained) else 0
        self._largest = 0.0
        self._floor = math.inf
        self._grown = False
        self._against = 0

    def take(self, gap: float, floor: float) -> WatchedGap:
        """
        Judge one look.

        :param gap: RMSE over the window.
        :param floor: of the noise.
        :return: the gap with its limit.
        """
        if self._left > 0:
            self._largest = max(self._largest, gap)
            self._left -= 1
            if self._left > 0:
                return WatchedGap(
                    self._channel, self._unit, gap, floor, math.nan, math.inf, grown=False
                )
            self._explained = self._largest
        explained = 0.0 if math.isnan(self._explained) else self._explained
        # noise is heard where residuals change fast, and a gap may do so too
        self._floor = min(self._floor, floor)
        limit = self._ratio * max(explained, self._floor)
        other = gap < RELIEF * limit if self._grown else gap > limit
        self._against = self._against + 1 if other else 0
        if self._against >= (LOWERED if self._grown else RAISED):
            self._grown = not self._grown
            self._against = 0
        return WatchedGap(
            self._channel, self._unit, gap, floor, explained, limit, grown=self._grown
        )


def gap_after(path: Path) -> Mapping[str, float]:
    """
    Return the gap that the effects of a diagnosed file leave.

    :param path: its ``diagnosis.json``.
    :return: RMSE by channel, in the channels' units.
    :raises RecordingError: where the file cannot be read or is no diagnosis.
    """
    try:
        found = Diagnosis.model_validate_json(path.read_text())
    except OSError as error:
        raise RecordingError(
            f'{path}: cannot be read ({error.strerror}); give the diagnosis.json that `tendon '
            'diagnose` wrote'
        ) from None
    except ValueError:
        raise RecordingError(
            f'{path}: is no diagnosis; give the diagnosis.json that `tendon diagnose` wrote'
        ) from None
    return {gap.channel: gap.after for gap in found.gap}
