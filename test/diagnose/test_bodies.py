"""A motor, its pulley and who reads them are one body, on which two effects may be one."""

import pytest

from tendon_ros.diagnose.bodies import of_one_body
from tendon_ros.diagnose.challenge import Challenge
from tendon_ros.diagnose.found import Found
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.steps import Steps
from tendon_ros.identify.candidate import Candidate

COUNTS = Candidate('encoder_gain', 'encoder_M')
WHEEL = Candidate('eccentricity', 'pulley_M')
STRONGER = Candidate('torque_gain', 'motor_M')
DAMPED = Candidate('viscous_friction', 'pulley_L')


@pytest.mark.parametrize(
    ('place', 'other', 'same'),
    [
        ('motor_M', 'pulley_M', True),
        ('encoder_M', 'torque_M', True),
        ('pulley_3', 'encoder_3', True),
        ('motor_M', 'pulley_L', False),
        ('pulley_1', 'cable_m1', False),
        ('cable_m1', 'cable_m1', True),
        ('contact', 'load_cell', False),
    ],
)
def test_what_belongs_to_one_body(bench, place, other, same):
    assert of_one_body(bench, Candidate('', place), Candidate('', other)) is same


def test_two_effects_on_one_body_that_are_one_are_told_as_one(bench, measured_on):
    true = (
        (COUNTS.effect, COUNTS.place, {'gain': 1.06}),
        (DAMPED.effect, DAMPED.place, {'damping': 0.2}),
    )
    run = measured_on(bench, *true, touching=True, without=('pulley/', 'load_cell'))
    problem = prepared([run], bench).problem
    three = problem.empty.joined(WHEEL, {'amplitude': 0.06, 'phase': 0.0})
    three = three.joined(STRONGER, {'gain': 1.06}).joined(DAMPED, {'damping': 0.2})
    found = Found()
    found.states += [problem.fitted(problem.empty), problem.fitted(three)]
    Challenge(Steps(problem, [COUNTS, WHEEL, STRONGER, DAMPED], 1, lambda *_: None), {}).of(found)
    assert set(found.final.model.causes) == {COUNTS, DAMPED}
    gain = found.final.model.values(found.final.model.causes.index(COUNTS))['gain']
    assert gain == pytest.approx(1.06, abs=0.01)
