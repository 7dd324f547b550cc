"""On what terms to listen to a topic, so that each of its publishers is heard."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Terms:
    """
    How a topic is sent, or heard.

    ``reliable``: what is lost on the way is sent again. ``latched``: who comes late gets what was
    said before.
    """

    reliable: bool = True
    latched: bool = False


def terms_for(offered: Sequence[Terms], now: Terms, *, heard: bool) -> Terms:
    """
    Return how to listen: who asks for more than a publisher offers hears nothing of it.

    :param offered: by each publisher that is known; none changes nothing.
    :param now: how it is listened to.
    :param heard: whether something was heard already, which to latch would bring again.
    :return: the most that all publishers offer, but never again reliable.
    """
    if not offered:
        return now
    return Terms(
        reliable=now.reliable and all(one.reliable for one in offered),
        latched=all(one.latched for one in offered) and (now.latched or not heard),
    )
