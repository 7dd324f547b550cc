"""
Equation (6) as printed against the energy-consistent one.

Virtual work gives ``J_3 dd(theta_3) + B_3 d(theta_3) = R_1 T_12 + R_3 T_L3``; the paper prints
``R_1 T_12`` on the other side. With that sign the stiffness is not symmetric: the cables are no
spring any more, and around a closed path they give energy. Linear loops of one stiffness show it
in closed form; it is the one that gives the force of Fig. 11.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from tendon_ros.model.instrument import Instrument
from tendon_ros.model.modes import modes
from tendon_ros.model.paper.rig import (
    DEGREE,
    paper_rig,
    with_damping,
    with_ideal_motors,
    with_linear_cables,
)
from tendon_ros.model.rows import Rows
from tendon_ros.model.statics import Statics
from tendon_ros.model.trajectory_profiles import step

FloatArray = NDArray[np.float64]

#: net stiffness of each loop [N/m]: 1.83 N at the tip for 1 degree in three such loops
STIFFNESS = 17.5e3


@dataclass(frozen=True)
class Form:
    """
    One form of equation (6), motors held or M turned by 1 degree, linear cables.

    ``growth`` [1/s]: largest real part of any eigenvalue, tip free, for each damping. ``blocked``:
    1 degree on M, tip blocked; ``link`` [deg] and ``force`` [N] are those at rest, solved, not
    simulated. ``asymmetry`` of the stiffness: its largest difference to its transpose by its
    largest entry.
    """

    growth: FloatArray
    blocked: Rows
    link: float
    force: float
    asymmetry: float


@dataclass(frozen=True)
class EquationSix:
    """Both forms; ``damping`` [N m s/rad] of ``growth``; up to ``bound`` the printed one grows."""

    damping: FloatArray
    consistent: Form
    printed: Form
    bound: float


def equation_six() -> EquationSix:
    """
    Compare the two forms.

    :return: what each does.
    """
    damping = np.geomspace(1e-3, 1.0, 60)
    consistent, printed = (
        with_linear_cables(paper_rig(printed=form), STIFFNESS) for form in (False, True)
    )
    bound: float = brentq(lambda b: _growth(printed, b), 0.02, 0.2, xtol=1e-5)
    return EquationSix(damping, _form(consistent, damping), _form(printed, damping), bound)


def _form(rig: Instrument, damping: FloatArray) -> Form:
    still = np.zeros(len(rig.pulleys))
    stiffness = Statics(rig, effects=(), engine='plain').at(still, still).stiffness
    turned, free = rig.index('M'), [rig.index('1'), rig.index('3')]
    # L and the blocked 2 stay at zero
    angle = np.linalg.solve(stiffness[np.ix_(free, free)], -stiffness[free, turned] * DEGREE)
    [arm] = {c.arm for c in rig.contacts}
    torque = -float(stiffness[rig.index('2'), free] @ angle)
    turn = step(rig.motor_names, amplitude=DEGREE, start=0.1, duration=2.0)
    return Form(
        growth=np.array([_growth(rig, b) for b in damping]),
        blocked=with_ideal_motors(rig, turn),
        link=float(np.rad2deg(angle[1])),
        force=torque / arm,
        asymmetry=float(np.max(np.abs(stiffness - stiffness.T)) / np.max(np.abs(stiffness))),
    )


def _growth(rig: Instrument, damping: float) -> float:
    """Return the largest real part of any eigenvalue with the motors held, tip free [1/s]."""
    return max(-mode.rate for mode in modes(with_damping(rig, damping), rig.driven))
