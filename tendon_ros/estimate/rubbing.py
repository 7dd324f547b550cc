"""
How uncertain dry friction is, for a balance of torques.

Where a pulley rests or turns round, a hair of an angle decides how much of its friction acts.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from tendon_ros.estimate.channels import sensors_of
from tendon_ros.estimate.rigid import Rigid
from tendon_ros.model.instrument import Instrument
from tendon_ros.model.statics import Statics

FloatArray = NDArray[np.float64]

BENT = 'presliding_friction'
#: a pulley that has not gone further in this time than its angle is uncertain may as well have
#: turned round [s]
TURNED = 0.05
#: the shortest way and uncertainty that divide others [rad]
LEAST = 1e-9


def readable(instrument: Instrument, count: float) -> Instrument:
    """
    Return an instrument whose friction builds up over no less than what can be read of an angle.

    Friction that turns round within a hair of a count would follow the counts, and not the motion.

    :param instrument: the network.
    :param count: of its encoders [rad].
    :return: the same but for pre-sliding angles below that.
    """
    effects = [
        replace(
            use,
            parameters={**use.parameters, 'angle': max(count, use.parameters.get('angle', 0.0))},
        )
        if use.effect == BENT
        else use
        for use in instrument.effects
    ]
    return replace(instrument, effects=tuple(effects))


def unsure_angles(
    instrument: Instrument, rigid: Rigid, measured: Mapping[int, float]
) -> FloatArray:
    """
    Return by how much each pulley's angle is uncertain.

    What a diagnosis left of a joint's angle is how far the model misses it from the motor's side.
    A pulley that no diagnosis saw is missed like the worst of the others, by how far it turns.

    :param instrument: the network.
    :param rigid: where the angles that are not measured would be without stretch.
    :param measured: by pulley, how uncertain the angles are that are [rad].
    :return: one deviation [rad], shape (pulleys,).
    """
    count = len(instrument.pulleys)
    unsure = np.zeros(count)
    unsure[list(measured)] = list(measured.values())
    turns = np.eye(count)  # of each pulley by one of each that is measured
    free = [i for i in range(count) if i not in measured]
    turns[free] = rigid.free(np.eye(count))
    reach = np.linalg.norm(turns, axis=1)
    missed = {
        instrument.index(s.of): s.misfit
        for s in sensors_of(instrument, ('angle',)).values()
        if s.misfit > 0.0
    }
    worst = max((missed[i] / reach[i] for i in missed if i in free and reach[i]), default=0.0)
    spread = np.linalg.norm(turns * unsure, axis=1)
    for i in free:
        spread[i] = np.hypot(spread[i], missed.get(i, worst * reach[i]))
    return spread


class Rubbing:
    """
    The friction of pulleys whose angles are known so well.

    :param statics: that carries the memories of friction.
    :param unsure: by how much each angle is uncertain [rad], shape (pulleys,).
    """

    def __init__(self, statics: Statics, unsure: FloatArray) -> None:
        self._statics = statics
        self._unsure = unsure
        self._late: FloatArray | None = None

    def reset(self) -> None:
        """Forget where the pulleys have come from."""
        self._late = None

    def doubt(
        self,
        before: FloatArray,
        angle: FloatArray,
        gap: float,
        change: FloatArray,
        friction: FloatArray,
    ) -> FloatArray:
        """
        Return how uncertain each pulley's friction is.

        :param before: angles at the last measurement [rad], shape (pulleys,).
        :param angle: the same now, up to which the memories were carried.
        :param gap: the time between [s].
        :param change: of friction on the way [N m], shape (pulleys,).
        :param friction: that acts now [N m], shape (pulleys,).
        :return: one deviation [N m], shape (pulleys,).
        """
        span = np.maximum(np.abs(angle - before), LEAST)
        part = np.minimum(float(self._unsure.max()) / span, 1.0)
        turning = np.minimum(np.abs(change) * part, 2.0 * np.abs(friction))
        gone = (angle - self._followed(before, angle, gap)) / np.maximum(self._unsure, LEAST)
        resting = self._statics.friction_beside(angle, self._unsure) * np.exp(-0.5 * gone**2)
        return np.asarray(np.maximum(turning, resting))

    def carry(self, before: FloatArray, angle: FloatArray, gap: float) -> None:
        """
        Take a measurement in.

        :param before: as for :meth:`doubt`.
        :param angle: the same now.
        :param gap: the time between [s].
        """
        self._late = self._followed(before, angle, gap)

    def _followed(self, before: FloatArray, angle: FloatArray, gap: float) -> FloatArray:
        """Return where the pulleys have come from, seen from these angles."""
        late = before if self._late is None else self._late
        return np.asarray(late + (angle - late) * gap / (gap + TURNED))


def doubts_after(
    frictions: Sequence[Rubbing],
    statics: Statics,
    before: FloatArray,
    angle: FloatArray,
    velocity: FloatArray,
    gap: float,
) -> list[FloatArray]:
    """
    Return how uncertain friction would be after a motion.

    :param frictions: of the same pulleys, on several grounds of uncertainty.
    :param statics: that carries their memories, which stay where they are.
    :param before: angles up to which they were carried [rad], shape (pulleys,).
    :param angle: the same now.
    :param velocity: [rad/s], shape (pulleys,).
    :param gap: the time between [s].
    :return: one deviation for each pulley [N m], on each of the grounds.
    """
    rubbed = statics.at(angle, velocity).friction
    with statics.trial():
        statics.carry(before, angle, gap)
        now = statics.at(angle, velocity).friction
        return [f.doubt(before, angle, gap, now - rubbed, now) for f in frictions]
