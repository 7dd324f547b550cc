"""
The mechanics at a given state: torques, and how they change with the angles.

For whoever solves for a state instead of running through time: quasi-static estimation, the
linearisation of an observer, checks of stiffness.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tendon_ros.model.bristles import Bristles
from tendon_ros.model.instrument import EffectUse, Instrument
from tendon_ros.model.layout import arrays_of
from tendon_ros.model.runner import Runner
from tendon_ros.model.signals import Signals
from tendon_ros.model.structure import Structure

FloatArray = NDArray[np.float64]

#: [s] that a step aside takes: cables have no time to creep
MOMENT = 1e-3


@dataclass(frozen=True)
class Balance:
    """
    Torques at one state, in the instrument's order, n pulleys, m loops and couplings.

    ``torque`` [N m], shape (n,): of everything but the motors, dry friction and contacts included.
    ``stiffness`` [N m/rad], shape (n, n): minus its derivative by the angles.
    ``damping`` [N m s/rad], shape (n, n): minus its derivative by the velocities.
    ``loop_force``, shape (m,); ``loop_stiffness``, shape (m,): its derivative by the elongation.
    ``friction`` [N m], shape (n,): the part of the torque that is dry friction; ``budget``: the
    most that it can be.
    """

    torque: FloatArray
    stiffness: FloatArray
    damping: FloatArray
    loop_force: FloatArray
    loop_stiffness: FloatArray
    friction: FloatArray
    budget: FloatArray


def without_contacts(instrument: Instrument) -> Instrument:
    """
    Return an instrument that touches nothing: the force at its contacts is then an unknown.

    :param instrument: the instrument.
    :return: the same with every contact taken away; its structure is the same.
    """
    away = tuple(replace(contact, enabled=False) for contact in instrument.contacts)
    return replace(instrument, contacts=away)


@dataclass(frozen=True)
class Since:
    """Up to where memories were carried, ``angle`` [rad], shape (n,), and ``gap`` [s] ago."""

    angle: FloatArray
    gap: float


class Linearisation:
    """
    Reads what a kernel has just linearised, in the instrument's order.

    :param structure: of the runner that is read.
    """

    def __init__(self, structure: Structure) -> None:
        at = structure
        n, m, width = at['N'], at['M'], at['WIDTH']
        order = np.array(at.order)
        entries = [
            (k, order[i], width * k + e)
            for k, row in enumerate(at.loop_pulley)
            for e, i in enumerate(row)
        ]
        table = np.array(entries, dtype=np.intp).reshape(-1, 3)
        self._shape = (m, n)
        self._cell = (table[:, 0], table[:, 1])
        own, every = np.argsort(order), np.arange(m)
        by_pulley = ('J_ANGLE', 'J_SPEED', 'TORQUE', 'SIDE', 'BUDGET')
        by_cell = ('J_RADIUS', 'J_ARM', 'J_GRIP')
        by_loop = ('J_LOOP', 'J_LOOP_RATE', 'J_TOTAL', 'TENSION')
        # all are taken at once: estimators do so several times a sample
        self._places = np.concatenate(
            [at[name] + own for name in by_pulley]
            + [at[name] + table[:, 2] for name in by_cell]
            + [at[name] + every for name in by_loop]
        )
        self._ends = (len(by_pulley) * n, len(by_pulley) * n + len(by_cell) * len(table))

    def read(self, runner: Runner) -> Balance:
        """
        Return the torques and derivatives.

        :param runner: after ``weigh`` or ``glide``.
        :return: the balance.
        """
        work = np.asarray(runner.work, dtype=np.float64)
        taken = work[self._places]
        m, n = self._shape
        first, last = self._ends
        by_angle, by_speed, torque, side, budget = taken[:first].reshape(5, n)
        dense = np.zeros((3, m, n))
        dense[:, self._cell[0], self._cell[1]] = taken[first:last].reshape(3, -1)
        radius, arm, grip = dense
        loop, rate, total, tension = taken[last:].reshape(4, m)
        stiffness = arm.T @ (loop[:, None] * radius)
        stiffness -= grip.T @ (total[:, None] * radius)
        damping = arm.T @ (rate[:, None] * radius)
        stiffness.flat[:: n + 1] -= by_angle
        damping.flat[:: n + 1] -= by_speed
        friction = side * budget
        return Balance(torque + friction, stiffness, damping, tension, loop, friction, budget)


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
        arrays = arrays_of(free, effects, prescribed=everyone)
        self._runner = Runner(free, arrays, engine)
        self._linearisation = Linearisation(self._runner.structure)
        self._bristles = Bristles.of(arrays)
        self._remember()

    def at(self, angle: FloatArray, velocity: FloatArray, since: Since | None = None) -> Balance:
        """
        Return the torques at a state.

        :param angle: [rad], shape (n,).
        :param velocity: [rad/s], shape (n,).
        :param since: where friction has built up from, on a straight way; its derivative by the
            angle is then part of the stiffness.
        :return: torques and derivatives there; other memories, and all where ``since`` is None, as
            carried so far.
        """
        own = self._bristles.pulley
        bent, slope = self._bent, np.zeros(len(own))
        if since is not None and own.size:
            bent, slope = self._bristles.bent(bent, (angle - since.angle)[own], since.gap)
        self._runner.place(angle, velocity)
        self._runner.bend(self._bristles.place, bent)
        self._runner.weigh()
        balance = self._linearisation.read(self._runner)
        balance.stiffness[own, own] += balance.budget[own] * slope
        return balance

    def _remember(self) -> None:
        self._bent = self._runner.bending(self._bristles.place)

    def carry(self, before: FloatArray, after: FloatArray, gap: float) -> None:
        """
        Carry the memories of friction and cables on along a straight motion.

        :param before: angles at the beginning [rad], shape (n,).
        :param after: angles at the end [rad], shape (n,).
        :param gap: the time between [s]; where it is 0 nothing happens.
        """
        if self._runner.memories and gap > 0.0:
            now = self._runner.time
            self._runner.bend(self._bristles.place, self._bent)
            self._runner.glide(now + gap, Signals.straight(now, gap, before, after))
            self._remember()

    def friction_beside(self, angle: FloatArray, shift: FloatArray) -> FloatArray:
        """
        Return by how much dry friction would change, had the pulleys gone a little further.

        :param angle: [rad], shape (n,), up to which the memories were carried.
        :param shift: how much further, one way and the other [rad], shape (n,).
        :return: the larger change of each pulley's friction [N m], shape (n,).
        """
        change = still = np.zeros(len(angle))
        if not self._runner.memories:
            return change
        here = self.at(angle, still).friction
        for further in (angle + shift, angle - shift):
            with self.trial():
                self.carry(angle, further, MOMENT)
                change = np.maximum(change, np.abs(self.at(further, still).friction - here))
        return change

    @contextmanager
    def trial(self) -> Iterator[None]:
        """Put all memories back to where they were, afterwards."""
        kept = self._runner.kept()
        try:
            yield
        finally:
            self._runner.back(kept)
            self._remember()

    def reset(self, pose: Mapping[str, float] | None = None) -> None:
        """
        Forget all memories and put the clock at zero.

        :param pose: angles [rad] by pulley.
        """
        self._runner.rest(pose or {})
        self._remember()
