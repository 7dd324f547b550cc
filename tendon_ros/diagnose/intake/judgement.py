"""What a recording tells of one channel: sound, dead, of the wrong sign or unit, or nothing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tendon_ros.base.recording import FloatArray
from tendon_ros.diagnose.intake.expected import Comparison, Expectation
from tendon_ros.diagnose.intake.units import factor_name

OPPOSITE = -0.8  # correlation of a channel whose sign is wrong
ALIKE = 0.9  # size of the correlation at which a factor means something
SOUND = 0.5
SUPPORT = 0.8  # agreement of the other channels with the run that condemns one
WORK = 0.05  # share of the moved energy that is spent, below which its sign tells nothing


@dataclass(frozen=True)
class Finding:
    """A fault in words; ``spreads`` where it then holds in all recordings that cannot tell."""

    words: str
    spreads: bool = False


#: the recording tells nothing of the channel
UNTOLD = Finding('')


def judged(name: str, runs: Sequence[Expectation]) -> Finding | None:
    """
    Judge a channel by the run of the model that agrees best with all channels.

    :param name: the channel.
    :param runs: of the model, best first.
    :return: the fault; None for a sound channel; :data:`UNTOLD` where nothing can be said.
    """
    run = next((run for run in runs if name in run.comparisons and _trusted(run, name)), None)
    if run is None:
        return UNTOLD
    one = run.comparisons[name]
    if one.unmoved:
        dead = _dead(name, run, runs)
        # what is noise from one sample to the next may still tell, once that is smoothed
        if dead is not UNTOLD or one.constant:
            return dead
    if not one.telling:
        return UNTOLD
    r, factor = one.correlation, one.factor
    if abs(r) > ALIKE:
        unit = factor_name(factor, one.sensor.kind, one.sensor.resolution)
        if unit:
            sign = ' and the wrong sign' if r < 0.0 else ''
            return Finding(
                f'{factor:.4g} times what the motion asks for (correlation {r:.2f}), as if '
                f'{unit}{sign}; convert it on import',
                spreads=True,
            )
    if r < OPPOSITE and not may_be_rectified(one) and _sign_is_sure(name, one, run):
        also = (
            f', or {name.removesuffix("effort")}position has'
            if one.sensor.kind == 'motor_torque'
            else ''
        )
        return Finding(
            f'it has the wrong sign (correlation {r:.2f} with what the motion asks for){also}; '
            'turn it on import',
            spreads=True,
        )
    return None if r > SOUND else UNTOLD


def may_be_rectified(one: Comparison) -> bool:
    """
    Say whether a channel may have lost its sign, which is an effect and no fault.

    :param one: the channel.
    :return: whether it is of a kind that can, and never goes below zero.
    """
    low, high = float(one.measured.min()), float(one.measured.max())
    return one.sensor.kind != 'angle' and low > -0.05 * (high - low)


def spent(torque: FloatArray, angle: FloatArray) -> float:
    """
    Return the share of the energy moved to and fro that a torque spends on a motion.

    :param torque: [N m], shape (n,).
    :param angle: [rad], shape (n,).
    :return: -1 to 1; what springs and weights take they give back.
    """
    power = 0.5 * (torque[1:] + torque[:-1]) * np.diff(angle)
    moved = float(np.abs(power).sum())
    return float(power.sum()) / moved if moved else 0.0


def _trusted(run: Expectation, name: str) -> bool:
    """Say whether a run may judge a channel: a load that bends the angles may be wrong."""
    if not run.loaded:
        return True
    angles = [c for c in run.comparisons.values() if c.sensor.kind == 'angle']
    return run.comparisons[name].sensor.kind != 'angle' and all(
        c.correlation > SOUND for c in angles if c.telling
    )


def _sign_is_sure(name: str, one: Comparison, run: Expectation) -> bool:
    """
    Say whether only a wrong sign explains an opposite correlation.

    A spring or a weight that the model lacks can turn the correlation of a torque, but only a
    wrong sign makes a drive take up energy where the model says that it gives some.
    """
    kind = one.sensor.kind
    if kind == 'angle':
        return 0.4 < one.factor < 2.5
    if kind not in ('motor_torque', 'loop_torque'):
        return True
    position = f'{name.removesuffix("effort")}position'
    angle = run.motion.get(position)
    if angle is None and position in run.comparisons:
        angle = run.comparisons[position].measured
    if angle is None:
        return False
    return spent(one.measured, angle) < -WORK and spent(one.expected, angle) > WORK


def _dead(name: str, run: Expectation, runs: Sequence[Expectation]) -> Finding:
    """Judge a channel that does not change, or by noise alone."""
    one = run.comparisons[name]
    # a load that nothing touches is noise as well, whichever run agrees best with all others
    sure = one.constant or one.sensor.kind != 'contact_force'
    silent = [r.comparisons[name].silent for r in runs if name in r.comparisons]
    if one.silent if sure and run.agreement > SUPPORT else all(silent):
        noise = '' if one.constant else ' but for noise'
        return Finding(
            f'it stays at {float(one.measured.mean()):.4g}{noise} where the motion should change '
            f'it by {float(np.ptp(one.expected)):.3g}: the sensor is dead or unplugged; mend it'
        )
    return UNTOLD
