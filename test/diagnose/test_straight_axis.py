"""A straight axis, one radian of which is a metre: friction builds up over micrometres."""

import math

import pytest

from tendon_ros.diagnose.bodies import alone
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.identify.rollout import Rollouts
from tendon_ros.identify.step_size import FINE, fineness, STEPS, TOLERANCE
from tendon_ros.model.instrument_file import load_instrument

AXIS = """
name: straight_axis
pulleys:
  carriage: {inertia: 95 kg*m^2, damping: 200 N*m*s/rad}
motors:
  carriage:
    controller: {kp: 1e5 N*m/rad, kd: 4e3 N*m*s/rad, limit: 400 N*m, derivative: reading}
    encoder: {resolution: 2e-8 rad}
    torque_sensor: {noise: 1 N*m}
control: {rate: 1 kHz}
"""
LEAD = 0.01  # [m] of one wave
SLOW = (('duration', '16 s'), ('amplitude', '4 deg'), ('frequencies', '0.06 Hz, 0.13 Hz'))
PLACE = 'pulley_carriage'


@pytest.fixture(scope='module')
def axis(tmp_path_factory):
    """Return an axis with a ball screw, in metres."""
    file = tmp_path_factory.mktemp('axis') / 'axis.yaml'
    file.write_text(AXIS, encoding='utf-8')
    return load_instrument(file)


def test_steps_are_as_fine_as_counts_ask_for(axis, bench, measured_on):
    assert fineness(bench) == 1.0
    assert fineness(axis) == pytest.approx(2e-8 / FINE)
    ready = prepared([measured_on(axis, settings=SLOW, seed=2)], axis)
    fine = Rollouts(axis, ()).tolerance
    assert fine == pytest.approx(1e-3 * TOLERANCE)
    assert fine <= ready.problem.rollouts.tolerance <= 1e-3 * STEPS[0]
    assert ready.problem.rougher().rollouts.tolerance == pytest.approx(1e-3 * STEPS[0])


def test_friction_and_the_waves_of_its_screw_are_told(axis, measured_on, quick):
    friction = ('presliding_friction', PLACE, {'torque': 20.0, 'angle': 1e-5})
    waves = {'amplitude': 6.0, 'cycles': 2.0 * math.pi / LEAD, 'phase': 0.3}
    run = measured_on(
        axis, friction, ('torque_ripple', 'motor_carriage', waves), settings=SLOW, seed=2
    )
    found = {c.effect: c for c in quick([run], axis).diagnosis.causes}
    assert 'torque_ripple' in found
    ripple = found.pop('torque_ripple').parameters
    assert ripple['cycles'].value == pytest.approx(waves['cycles'], rel=0.01)
    assert ripple['amplitude'].value == pytest.approx(6.0, rel=0.1)
    [rubs] = found.values()
    assert rubs.effect in {'presliding_friction', 'coulomb_friction', 'stribeck_friction'}
    size = next(v for k, v in rubs.parameters.items() if k in {'torque', 'sliding'})
    assert size.value == pytest.approx(20.0, rel=0.1)


def test_what_plays_needs_a_second_body(axis, bench, measured_on, quick):
    assert alone(axis) == {PLACE, 'motor_carriage'}
    assert alone(bench) == frozenset()
    judged = quick([measured_on(axis, settings=SLOW, seed=2)], axis).diagnosis.candidates
    [play] = [c for c in judged if c.effect == 'backlash']
    assert not play.identifiable
    assert 'second one' in play.why_not
