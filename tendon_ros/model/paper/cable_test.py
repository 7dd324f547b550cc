"""Fig. 7: tension of one cable against its elongation, and what it makes of a preloaded loop."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tendon_ros.model.cable import elongation_at, tension_at
from tendon_ros.model.cable_identification import BlockedTip
from tendon_ros.model.instrument import Instrument
from tendon_ros.model.paper.rig import DEGREE, KILOGRAM_FORCE
from tendon_ros.model.paper.statement import at_least, at_most, Statement, Use

FloatArray = NDArray[np.float64]

#: to where the paper's look-up table was sampled, and what it worked below [N]
TABLE_END, WORKING_END = 20.0 * KILOGRAM_FORCE, 15.0 * KILOGRAM_FORCE

#: the paper's forces at the blocked tip: turn of pulley M beyond touch [rad], force [N]
STATED_FORCES = ((1.0 * DEGREE, 1.83), (5.0 * DEGREE, 18.0), (7.0 * DEGREE, 50.0))


@dataclass(frozen=True)
class CableTest:
    """
    The cable's curve: ``elongation`` [m] and ``tension`` [N] of one cable, shape (n,).

    A loop of two, each preloaded to ``pretension`` [N] at ``preload`` [m], has the net force
    ``loop_force`` [N] when stretched by ``loop_elongation`` [m]; ``stated`` are the points that
    follow from the paper's three forces [m], [N], shape (3, 2).
    """

    elongation: FloatArray
    tension: FloatArray
    pretension: float
    preload: float
    loop_elongation: FloatArray
    loop_force: FloatArray
    stated: FloatArray
    statements: tuple[Statement, ...]


def cable_test(rig: Instrument) -> CableTest:
    """
    Return the tension test that the rig's cables would give.

    :param rig: the paper's rig; its loops are equal.
    :return: the curve, and the loop's.
    """
    [curve], loop = rig.curves, rig.loops[0]
    elongation = np.linspace(0.0, elongation_at(curve, TABLE_END), 400)
    preload = elongation_at(curve, loop.pretension)
    [arm], [radius] = {c.arm for c in rig.contacts}, {abs(r) for r in loop.route.values()}
    test = BlockedTip(STATED_FORCES, radius, arm, len(rig.loops))
    reach = np.linspace(0.0, 1.1 * test.elongations[-1], 300)
    end = curve.tension[-1]
    statements = (
        Statement(
            'Fig. 7', 'table of the cable reaches', '20 kgf = 196.1 N', end, 'N',
            within=at_least(TABLE_END), use=Use.INPUT,
            note='curve identified from three forces of Figs. 11 and 13; no table is printed',
        ),
        Statement(
            'Fig. 7', 'hysteresis up to 20 kgf', 'less than 1 %', 0.0, '%',
            within=at_most(1.0), use=Use.INPUT,
            note='the model has none unless the effect is switched on',
        ),
    )  # fmt: skip
    return CableTest(
        elongation,
        tension_at(curve, elongation),
        loop.pretension,
        preload,
        reach,
        tension_at(curve, preload + reach) - tension_at(curve, preload - reach),
        np.column_stack([test.elongations, test.net_forces]),
        statements,
    )
