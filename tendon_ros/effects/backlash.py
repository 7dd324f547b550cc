"""
Backlash: dead play in a gear, a key or a coupling.

Within the play the two sides turn freely against each other. What happens to the far side
meanwhile is a question of what holds it. Where nothing does, the cables pull it to one end of the
play, and it changes sides when the torque changes sign: an instrument that is loaded one way all
along hides it. Where friction holds it, as in a worm gear or a tight bearing, it stays until the
other end of the play takes it along, and motion is lost at every reversal, whatever the torque.

Equations, with w the width of the play, x the twist (at a coupling) or the elongation (at a
motor's loops), theta the motor's angle and b the angle behind the play::

    free:  T = T(x - w/2) for x > w/2,  T(x + w/2) for x < -w/2,  T(0) between
    held:  b stays, and is taken along where |theta - b| would pass w/2

``angle`` is the full width of the play, ``held`` the part of it that friction holds. At a coupling
the play is free, measured in its twist. At a motor the free part has w = angle * |R| in each loop
(ratio for R in each coupling) on the pulley that it drives: the play lies between the motor's
encoder and its cables, the inertia of the pulley on the motor's side.

Source: Nordin and Gutman, "Controlling mechanical systems with backlash - a survey", Automatica
38 (2002): dead zone of an elastic connection, and friction-driven hysteresis.
"""

from __future__ import annotations

import math

from tendon_ros.base.effect import Effect, Numbers
from tendon_ros.base.parameter import Parameter


def modify(numbers: Numbers, index: int, angle: float, held: float) -> None:
    """Widen the play of a coupling, or of all that hangs on a motor's pulley."""
    if numbers.kind == 'coupling':
        numbers['play'][index] += angle
        return
    pulley = int(numbers['motor_pulley'][index])
    numbers['lash'][pulley] += held * angle
    for k in numbers.loops_on(pulley):
        numbers['play'][k] += (1.0 - held) * angle * abs(numbers['radius'][k, pulley])


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
        Parameter(
            name='held',
            unit='1',
            meaning='part of the play that friction holds; none at a coupling',
            neutral=math.nan,
            low=0.0,
            high=1.0,
            typical=0.0,
            search='share',
        ),
    ),
    modify=modify,
    form=0.06,
)
