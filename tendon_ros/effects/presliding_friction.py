"""
Pre-sliding friction: friction that builds up over a small displacement after a reversal.

Asperities bend before they slip. After each reversal the friction goes from one side to the other
over an angle, like a spring that yields; seen over torque it is a rounded hysteresis loop.

Equation, with s the used part of the budget and sigma = sign(omega)::

    tau = -s * (torque + budgets of all other dry friction of this pulley)
    ds/dt = (omega * (1 - sigma * s) - dither * s) / angle

``torque`` is the effect's own budget. ``angle`` shapes all dry friction of the pulley, also that
which other effects bring: it can be used with ``torque`` 0 to round off those. With ``angle`` 0
the pulley sticks rigidly, and the effect is Coulomb friction.

A trembling that no encoder tells, of the mean speed ``dither``, lets friction go that holds, and
takes the part dither / (dither + |omega|) of it from slow motions: friction under vibration.

Over small enough movements the bending gives energy back; over a closed cycle it never gives any.

Source: Dahl, "A solid friction model", Aerospace Corporation, TOR-0158 (1968), with exponent one;
the trembling is averaged in it.
"""

from __future__ import annotations

from tendon_ros.base.effect import Effect, Numbers
from tendon_ros.base.parameter import Parameter


def presliding_friction_law(
    speed: float, side: float, load: float, torque: float, angle: float, dither: float
) -> tuple[float, float, float]:
    """Return the limit of the dry friction [N m], and its slopes."""
    return torque, 0.0, 0.0


def modify(numbers: Numbers, index: int, torque: float, angle: float, dither: float) -> None:
    """Let the dry friction of a pulley build up over an angle, and a trembling take it away."""
    numbers['breakaway'][index] += angle
    numbers['dither'][index] += dither


#: angle [rad] over which any dry friction builds up: what takes more is pre-sliding by name
BENDING = 3e-3


def bending(torque: float, angle: float) -> tuple[str, dict[str, float]] | None:
    """Return the Coulomb friction that it is where it builds up as all dry friction does."""
    return None if angle >= BENDING else ('coulomb_friction', {'torque': torque})


EFFECT = Effect(
    id='presliding_friction',
    title='Pre-sliding friction',
    kinds=('pulley',),
    parameters=(
        Parameter(
            name='torque',
            unit='N m',
            meaning='friction when fully built up',
            neutral=0.0,
            low=0.0,
            high=1e5,
            typical=0.05,
        ),
        Parameter(
            name='angle',
            unit='rad',
            meaning='angle over which all dry friction of the pulley builds up',
            neutral=0.0,
            low=0.0,
            high=0.5,
            typical=0.005,
            search='shape',
        ),
        Parameter(
            name='dither',
            unit='rad/s',
            meaning='mean speed of a trembling under which the dry friction of the pulley lets go',
            neutral=0.0,
            low=0.0,
            high=1.0,
            typical=1e-4,
            search='guess',
        ),
    ),
    hook='budget',
    law=presliding_friction_law,
    modify=modify,
    dissipative=True,
    form=0.06,
    other=bending,
)
