"""Small motions about rest: natural frequencies and damping of a network."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from tendon_ros.model.instrument import Instrument
from tendon_ros.model.numbers import Numbers
from tendon_ros.model.statics import Statics


@dataclass(frozen=True)
class Mode:
    """
    One way to vibrate, or to creep back: ``frequency`` [Hz], ``damping`` relative to critical.

    At a damping of 1 it does not vibrate and returns with ``rate`` [1/s]; at a negative one it
    grows. ``pulley`` is the one that moves most.
    """

    frequency: float
    damping: float
    rate: float
    pulley: str


def modes(instrument: Instrument, held: Iterable[str] = ()) -> tuple[Mode, ...]:
    """
    Return the modes about rest, contacts open, effects left out, slowest first.

    :param instrument: the network.
    :param held: pulleys that do not move, such as those of the motors.
    :return: one mode for each conjugate pair or real root; free turning is left out.
    """
    held = set(held)
    free = [i for i, name in enumerate(instrument.pulley_names) if name not in held]
    n = len(free)
    if n == 0:
        return ()
    still = np.zeros(len(instrument.pulleys))
    balance = Statics(instrument, effects=(), engine='plain').at(still, still)
    inertia = Numbers(instrument)['inertia'][free]
    pick = np.ix_(free, free)
    system = np.zeros((2 * n, 2 * n))
    system[:n, n:] = np.eye(n)
    system[n:, :n] = -balance.stiffness[pick] / inertia[:, None]
    system[n:, n:] = -balance.damping[pick] / inertia[:, None]
    roots, shapes = np.linalg.eig(system)
    nothing = 1e-6 * float(np.max(np.abs(roots), initial=0.0))
    found = []
    for root, shape in zip(roots, shapes.T, strict=True):
        if abs(root) <= nothing or root.imag < 0.0:
            continue
        most = free[int(np.argmax(np.abs(shape[:n])))]
        found.append(
            Mode(
                frequency=float(abs(root)) / (2.0 * np.pi),
                damping=float(-root.real / abs(root)),
                rate=float(-root.real),
                pulley=instrument.pulley_names[most],
            )
        )
    return tuple(sorted(found, key=lambda mode: mode.frequency))
