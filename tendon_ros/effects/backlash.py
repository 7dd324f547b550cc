"""
Backlash: dead play in a gear, a key or a coupling.

Within the play the two sides turn freely against each other; only at its ends does torque pass. It
shows where the torque changes sign, and nowhere else: an instrument that is loaded one way all
along hides it.

Equation, with x the twist (at a coupling) or the elongation (at the motor's loops)::

    T = T(x - w/2) for x > w/2,  T(x + w/2) for x < -w/2,  T(0) between

``angle`` is the full width of the play. At a coupling w = angle, measured in its twist. At a motor
w = angle * |R| in each loop (ratio for R in each coupling) on the pulley that it drives: the play
lies between the motor's encoder and its cables, the inertia of the pulley on the motor's side.

Source: Nordin and Gutman, "Controlling mechanical systems with backlash - a survey", Automatica
38 (2002): dead zone of an elastic connection.
"""

from __future__ import annotations

from tendon_ros.base.effect import Effect, Numbers
from tendon_ros.base.parameter import Parameter


def modify(numbers: Numbers, index: int, angle: float) -> None:
    """Widen the play of a coupling, or of all that hangs on a motor's pulley."""
    if numbers.kind == 'coupling':
        numbers['play'][index] += angle
        return
    pulley = int(numbers['motor_pulley'][index])
    for k in numbers.loops_on(pulley):
        numbers['play'][k] += angle * abs(numbers['radius'][k, pulley])


EFFECT = Effect(
    id='backlash',
    title='Backlash',
    kinds=('motor', 'coupling'),
    parameters=(
        Parameter(
            name='angle',
            unit='rad',
            meaning='full width of the play',
            neutral=0.0,
            low=0.0,
            high=0.5,
            typical=0.005,
        ),
    ),
    modify=modify,
)
