"""Observers see what was there: what the file knows of its sensors and motors is taken off."""

from dataclasses import replace

import pytest

from tendon_ros.estimate.methods import build_observer, METHODS
from tendon_ros.estimate.offline import estimate_recording
from tendon_ros.estimate.readings import Readings
from tendon_ros.estimate.rubbing import readable
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.session import simulate
from tendon_ros.model.trajectory_choice import chosen_trajectory

WRONG = (
    EffectUse('torque_gain', 'motor_L', {'gain': 1.3}),
    EffectUse('torque_bias', 'motor_M', {'torque': 0.1}),
    EffectUse('encoder_gain', 'encoder_L', {'gain': 1.05}),
    EffectUse('encoder_offset', 'encoder_M', {'angle': 0.01}),
)


def test_readings_become_what_was_there(bench):
    readings = Readings(replace(bench, effects=WRONG))
    said = {
        'actuator/pulley_L/effort': 2.0,
        'actuator/pulley_M/effort': 2.0,
        'actuator/pulley_L/position': 0.21,
        'actuator/pulley_M/position': 0.21,
        'something/else': 5.0,
    }
    assert readings.truth(said) == pytest.approx(
        {
            'actuator/pulley_L/effort': 2.6,
            'actuator/pulley_M/effort': 2.1,
            'actuator/pulley_L/position': 0.2,
            'actuator/pulley_M/position': 0.2,
            'something/else': 5.0,
        }
    )
    assert readings.slope('actuator/pulley_L/effort') == pytest.approx(1.3)
    assert readings.slope('actuator/pulley_L/position') == pytest.approx(1.0 / 1.05)


@pytest.mark.parametrize('method', METHODS)
def test_a_force_is_found_whatever_its_sensors_make_of_it(method, bench, rms):
    """What a diagnosis found of sensors and motors is in the file, and the estimate is right."""
    spoilt = replace(bench, effects=WRONG)
    run = simulate(spoilt, chosen_trajectory('paper_fig12', bench.motor_names), rate=100.0)
    truth = run['load_cell/force']
    off = {}
    for name, file in (('known', spoilt), ('unknown', bench)):
        found = estimate_recording(run, build_observer(file, method))['estimate/force']
        late = found.time > 4.0
        off[name] = rms((found.value - truth.at(found.time))[late])
    assert off['known'] < 0.03 * truth.value.max()
    assert off['unknown'] > 3.0 * off['known']


def test_friction_builds_up_over_no_less_than_a_count(bench):
    bent = EffectUse(
        'presliding_friction', 'pulley_3', {'torque': 0.0, 'angle': 1e-6, 'dither': 0.0}
    )
    soft = replace(bent, parameters={'torque': 0.1, 'angle': 0.01, 'dither': 1e-4})
    [finer, kept, other] = readable(replace(bench, effects=(bent, soft, WRONG[0])), 1e-3).effects
    assert finer.parameters == {'torque': 0.0, 'angle': 1e-3, 'dither': 0.0}
    assert kept == soft
    assert other == WRONG[0]
