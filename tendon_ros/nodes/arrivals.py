"""Which channels still come: a topic may go on while one of its numbers does not."""

from __future__ import annotations

from collections.abc import Container, Mapping
import math

from tendon_ros.bags.topics import place_of

#: what has not come for so long has stopped [s]
STALE = 1.0


class Arrivals:
    """
    When each channel came last, by the clock of whoever listens.

    :param channels: those that are listened to; others are left.
    """

    def __init__(self, channels: Container[str]) -> None:
        self._channels = channels
        self._at: dict[str, float] = {}

    def note(self, values: Mapping[str, float], now: float) -> None:
        """
        Take in what a message said.

        :param values: by channel; what is not finite did not come.
        :param now: a steady clock [s].
        """
        for name, value in values.items():
            if name in self._channels and math.isfinite(value):
                self._at[name] = now

    def silent(self, now: float) -> dict[str, str]:
        """
        Return the channels that came once and do no longer, with sentences.

        :param now: the same clock [s].
        :return: by channel.
        """
        late = {name: now - at for name, at in self._at.items() if now - at > STALE}
        going = {place_of(name)[0] for name in self._at.keys() - late.keys()}
        found = {}
        for name, seconds in late.items():
            topic = place_of(name)[0]
            found[name] = (
                f'{name}: no number for {seconds:.1f} s while others of {topic} come; see what '
                'its driver measures'
                if topic in going
                else f'{topic}: nothing for {seconds:.1f} s; see whether its driver still runs'
            )
        return found

    def clear(self) -> None:
        """Forget everything."""
        self._at.clear()
