"""How much simulated time is due: physics follows the elapsed time, whatever the loop does."""

from __future__ import annotations

#: how much time may be made up for at once [s]
MOST = 0.1


class Pace:
    """
    Counts the controller periods that are due.

    A loop that wakes late gets the periods that it missed, up to :data:`MOST`; what is beyond is
    given up, simulated time then falls behind by that, and nothing else changes.

    :param period: of the controllers [s].
    :param origin: when the first period begins, by a steady clock [s].
    """

    def __init__(self, period: float, origin: float) -> None:
        self._period = period
        self._origin = origin
        self._done = 0
        #: simulated time given up since the start [s]
        self.slipped = 0.0

    def due(self, now: float) -> int:
        """
        Return how many periods to run, and count them as run.

        :param now: the same clock [s].
        :return: periods; one at the origin, the period that begins there.
        """
        # A clock read a rounding error early must not cost a whole period.
        ticks = int((now - self._origin) / self._period + 1e-6) + 1 - self._done
        most = max(int(MOST / self._period), 1)
        if ticks > most:
            lost = (ticks - most) * self._period
            self.slipped += lost
            self._origin += lost
            ticks = most
        self._done += max(ticks, 0)
        return max(ticks, 0)

    def wait(self, now: float, every: int) -> float:
        """
        Return how long to sleep until the next period that is a multiple of ``every``.

        :param now: the same clock [s].
        :param every: periods.
        :return: [s], not below zero.
        """
        # Period n is run when n + 1 are counted, so the next one to publish is at or after `done`.
        following = -(-self._done // every) * every
        return max(self._origin + following * self._period - now, 0.0)
