"""
The mechanics at a given state: torques, and how they change with the angles.

For whoever solves for a state instead of running through time: quasi-static estimation, the
linearisation of an observer, checks of stiffness.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tendon_ros.model.instrument import EffectUse, Instrument
from tendon_ros.model.layout import arrays_of
from tendon_ros.model.runner import Runner
from tendon_ros.model.signals import Signals

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Balance:
    """
    Torques at one state, in the instrument's order, n pulleys, m loops and couplings.

    ``torque`` [N m], shape (n,): of everything but the motors, dry friction and contacts included.
    ``stiffness`` [N m/rad], shape (n, n): minus its derivative by the angles.
    ``damping`` [N m s/rad], shape (n, n): minus its derivative by the velocities.
    ``loop_force``, shape (m,); ``loop_stiffness``, shape (m,): its derivative by the elongation.
    """

    torque: FloatArray
    stiffness: FloatArray
    damping: FloatArray
    loop_force: FloatArray
    loop_stiffness: FloatArray


def without_contacts(instrument: Instrument) -> Instrument:
    """
    Return an instrument that touches nothing: the force at its contacts is then an unknown.

    :param instrument: the instrument.
    :return: the same with every contact taken away; its structure is the same.
    """
    away = tuple(replace(contact, enabled=False) for contact in instrument.contacts)
    return replace(instrument, contacts=away)


def balance_of(runner: Runner) -> Balance:
    """
    Return the torques and derivatives that a runner's kernel has just linearised.

    :param runner: after ``weigh`` or ``glide``.
    :return: the balance, in the instrument's order.
    """
    at = runner.structure
    n, m, width = at['N'], at['M'], at['WIDTH']
    order = np.array(at.order)
    work = runner.work

    def part(name: str, count: int) -> FloatArray:
        return np.asarray(work[at[name] : at[name] + count], dtype=np.float64)

    def matrix(name: str) -> FloatArray:
        out = np.zeros((m, n))
        flat = part(name, m * width)
        for k, row in enumerate(at.loop_pulley):
            for e, i in enumerate(row):
                out[k, order[i]] = flat[width * k + e]
        return out

    def own(values: FloatArray) -> FloatArray:
        out = np.empty(n)
        out[order] = values
        return out

    radius, arm, grip = matrix('J_RADIUS'), matrix('J_ARM'), matrix('J_GRIP')
    loop_stiffness = part('J_LOOP', m)
    stiffness = arm.T @ (loop_stiffness[:, None] * radius)
    stiffness -= grip.T @ (part('J_TOTAL', m)[:, None] * radius)
    stiffness -= np.diag(own(part('J_ANGLE', n)))
    damping = arm.T @ (part('J_LOOP_RATE', m)[:, None] * radius)
    damping -= np.diag(own(part('J_SPEED', n)))
    torque = own(part('TORQUE', n) + part('SIDE', n) * part('BUDGET', n))
    return Balance(torque, stiffness, damping, part('TENSION', m), loop_stiffness)


class Statics:
    """
    Evaluates an instrument's torques at states that the caller chooses, contacts left out.

    :param instrument: the network.
    :param effects: effects in force; the instrument's own where None.
    :param engine: ``auto``, ``compiled`` or ``plain``.
    """

    def __init__(
        self,
        instrument: Instrument,
        *,
        effects: Sequence[EffectUse] | None = None,
        engine: str = 'auto',
    ) -> None:
        everyone = {name: row for row, name in enumerate(instrument.pulley_names)}
        free = without_contacts(instrument)
        self._runner = Runner(free, arrays_of(free, effects, prescribed=everyone), engine)

    def at(self, angle: FloatArray, velocity: FloatArray) -> Balance:
        """
        Return the torques at a state.

        :param angle: [rad], shape (n,).
        :param velocity: [rad/s], shape (n,).
        :return: torques and derivatives there; memories of friction and cables as carried so far.
        """
        self._runner.place(angle, velocity)
        self._runner.weigh()
        return balance_of(self._runner)

    def carry(self, before: FloatArray, after: FloatArray, gap: float) -> None:
        """
        Carry the memories of friction and cables on along a straight motion.

        :param before: angles at the beginning [rad], shape (n,).
        :param after: angles at the end [rad], shape (n,).
        :param gap: the time between [s].
        """
        now = self._runner.time
        path = np.column_stack([before, after])
        self._runner.glide(now + gap, Signals.smooth(now, gap, path))

    def reset(self, pose: Mapping[str, float] | None = None) -> None:
        """
        Forget all memories and put the clock at zero.

        :param pose: angles [rad] by pulley.
        """
        self._runner.rest(pose or {})
