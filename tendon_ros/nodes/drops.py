"""Count messages that were sent and never came, from the numbers that publishers put on them."""

from __future__ import annotations

from collections.abc import Mapping


class Drops:
    """Gaps in the publication sequence numbers, by topic; right for one publisher a topic."""

    def __init__(self) -> None:
        self._last: dict[str, int] = {}
        self._lost: dict[str, int] = {}

    def note(self, topic: str, number: int | None) -> None:
        """
        Take in the number of a message.

        :param topic: its topic.
        :param number: the publisher's count, None where the middleware gives none.
        """
        if number is None:
            return
        last = self._last.get(topic)
        # A number that steps back is a publisher that was started again.
        if last is not None and number > last + 1:
            self._lost[topic] = self._lost.get(topic, 0) + number - last - 1
        self._last[topic] = number

    @property
    def lost(self) -> Mapping[str, int]:
        """Messages lost by topic; topics without a loss are absent."""
        return dict(self._lost)
