"""
Fig. 15: the profile again with 10 % less pretension in L3, and with friction.

The paper takes friction "opposite to the velocity and proportional to tension", and blames what
remains after 5 s on "static friction between the joint pulley and the stand plate". It gives no
coefficient and does not say which pulleys rub. Here the joint pulley that carries the link, 3,
rubs with 0.1: dry steel (0.17) on a face of 18 mm, by the pulley's 30 mm. All of 1, 2, 3 and
several coefficients are run beside it, because where it rubs decides what it does.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from tendon_ros.model.cable_identification import BlockedTip, identified, tabulated
from tendon_ros.model.instrument import Instrument
from tendon_ros.model.paper.cable_test import STATED_FORCES
from tendon_ros.model.paper.force_profile import rest_forces, RESTS, SAME
from tendon_ros.model.paper.rig import degrees, mean_between, under_control, with_effects
from tendon_ros.model.paper.statement import about, at_least, at_most, Statement, Use
from tendon_ros.model.rows import Rows
from tendon_ros.model.trajectory_profiles import paper_fig12

FIGURE = 'Fig. 15'

#: the friction of the figure: limit of the dry torque by radius times sum of tensions
COEFFICIENT = 0.1

#: what the survey of places and sizes of friction runs
PLACES: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {'1': ('1',), '2': ('2',), '3': ('3',), '1, 2, 3': ('1', '2', '3')}
)
COEFFICIENTS = (0.0, 0.03, 0.06, 0.1, 0.15)

#: corners of the survey's motion [s]: so round that the controllers do not overshoot, which would
#: leave the link stuck beyond where it belongs and hide what friction alone does
GENTLE = 0.2

#: pretensions that the paper's rig may have had: it gives none [N]
PRETENSIONS = (2.0, 5.0, 10.0, 20.0)

Use3 = tuple[str, str, Mapping[str, float]]
_LOOSER: Use3 = ('pretension', 'cable_L3', {'scale': 0.9})


@dataclass(frozen=True)
class AdjustedRig:
    """
    Runs of the profile: as in Fig. 13, with L3 looser, and with friction on 3 as well.

    ``survey``: change of the force at rest from the first to the second 5 deg [N], by where it
    rubs, one for each of :data:`COEFFICIENTS`. ``loss``: by pretension [N], what a looser L3 takes
    from the force at 7 deg, relative, each with the curve that meets the paper's forces with it.
    """

    even: Rows
    looser: Rows
    rubbing: Rows
    survey: Mapping[str, tuple[float, ...]]
    loss: Mapping[float, float]
    statements: tuple[Statement, ...]


def adjusted_rig(rig: Instrument) -> AdjustedRig:
    """
    Run the profile with and without what the paper adjusted.

    :param rig: the paper's rig.
    :return: what happened.
    """
    even = _run(rig)
    looser = _run(rig, _LOOSER)
    rubbing = _run(rig, _LOOSER, *_rubs(('3',), COEFFICIENT))
    survey = {
        name: tuple(_surveyed(rig, places, c) for c in COEFFICIENTS)
        for name, places in PLACES.items()
    }
    loss = {pretension: _loss(_preloaded(rig, pretension)) for pretension in PRETENSIONS}
    statements = _statements(even, looser, rubbing, loss)
    return AdjustedRig(even, looser, rubbing, survey, loss, statements)


def _run(rig: Instrument, *uses: Use3) -> Rows:
    return under_control(with_effects(rig, uses), paper_fig12(rig.motor_names))


def _rubs(places: tuple[str, ...], coefficient: float) -> tuple[Use3, ...]:
    if not coefficient:
        return ()
    return tuple(
        ('tension_friction', f'pulley_{place}', {'coefficient': coefficient}) for place in places
    )


def _surveyed(rig: Instrument, places: tuple[str, ...], coefficient: float) -> float:
    rubbing = with_effects(rig, (_LOOSER, *_rubs(places, coefficient)))
    at = rest_forces(under_control(rubbing, paper_fig12(rig.motor_names, rounding=GENTLE)))
    return at['second 5 deg'] - at['first 5 deg']


def _preloaded(rig: Instrument, pretension: float) -> Instrument:
    """Return the rig with another pretension, and the cables that meet the paper's forces then."""
    [arm], loops = {c.arm for c in rig.contacts}, rig.loops
    [radius] = {abs(r) for loop in loops for r in loop.route.values()}
    test = BlockedTip(STATED_FORCES, radius, arm, len(loops))
    curve = tabulated(identified(test, pretension), 'preloaded', rig.curves[0].tension[-1])
    return replace(
        rig,
        curves=(curve,),
        loops=tuple(replace(p, curve='preloaded', pretension=pretension) for p in loops),
    )


def _loss(rig: Instrument) -> float:
    before, after = (rest_forces(_run(rig, *uses))['7 deg'] for uses in ((), (_LOOSER,)))
    return 1.0 - after / before


def _statements(
    even: Rows, looser: Rows, rubbing: Rows, loss: Mapping[float, float]
) -> tuple[Statement, ...]:
    plain, loose, dry = rest_forces(even), rest_forces(looser), rest_forces(rubbing)
    turned = _link(looser) - _link(even)
    least, most = 100.0 * min(loss.values()), 100.0 * max(loss.values())
    return (
        Statement(
            FIGURE, 'pretension of L3, by that of M1', '10 % lower', 0.9, '',
            within=about(0.9, 0.0), use=Use.INPUT,
        ),
        Statement(
            FIGURE, 'force at the first 5 deg, L3 looser', '18 N on the rig (Fig. 14)',
            loose['first 5 deg'], 'N', within=about(18.0, 1.8), note='"similar" taken as 10 %',
        ),
        Statement(
            FIGURE, 'the same, and friction on 3', '18 N on the rig (Fig. 14)',
            dry['first 5 deg'], 'N', within=about(18.0, 1.8), note='"similar" taken as 10 %',
        ),
        Statement(
            FIGURE, 'link 3 at 7 deg turns on by', 'turns, absorbs the force', turned, 'deg',
            within=at_least(0.01),
            note='no jump: 10 % are not enough to make it turn quickly, as on the rig',
        ),
        Statement(
            FIGURE, 'force at 7 deg changes by', 'absorbed by the loose part',
            loose['7 deg'] - plain['7 deg'], 'N', within=at_most(-SAME),
            note=f'{least:.2g} to {most:.2g} % less for pretensions of 2 to 20 N: none is printed',
        ),
        Statement(
            FIGURE, 'return to 5 deg, friction on 3: change from first', 'less (Fig. 13)',
            dry['second 5 deg'] - dry['first 5 deg'], 'N', within=at_most(-SAME),
            note='friction on the link; friction on 1 or 2 does the opposite',
        ),
    )  # fmt: skip


def _link(rows: Rows) -> float:
    return mean_between(rows.time, np.asarray(degrees(rows, '3')), *RESTS['7 deg'])
