"""What slipped between two recordings may as well have been homed."""

from dataclasses import replace

import pytest

from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.steps import Steps
from tendon_ros.diagnose.warm_start import Begun
from tendon_ros.identify.candidate import Candidate, everyone
from tendon_ros.model.instrument_file import load_instrument

#: an arm behind a gear, both with an encoder
GEARED = """
pulleys: {rotor: {inertia: 1e-3 kg*m^2}, arm: {inertia: 5e-3 kg*m^2, damping: 0.01 N*m*s/rad}}
couplings: {gear: {route: {rotor: 1, arm: -1}, stiffness: 60 N*m/rad, damping: 0.05 N*m*s/rad}}
motors:
  rotor:
    controller: {kp: 20 N*m/rad, kd: 0.3 N*m*s/rad, limit: 5 N*m}
    encoder: {counts: 65536}
    torque_sensor: {noise: 0.02 N*m}
joint_sensors: {arm: {counts: 65536}}
"""
HOMED = 0.006
SLIP = Candidate('cable_slip', 'coupling_gear', only='later')


@pytest.fixture(scope='module')
def homed(tmp_path_factory, measured_on, spoilt):
    """Return the steps of a search in recordings between which an encoder was homed."""
    path = tmp_path_factory.mktemp('geared') / 'geared.yaml'
    path.write_text(GEARED)
    rig = load_instrument(path)
    runs = [
        measured_on(rig, settings=(('duration', '6 s'), ('amplitude', f'{far} deg')), name=name)
        for name, far in (('first', 20), ('later', 25))
    ]
    runs[1:] = spoilt(runs[1:], 'pulley/pulley_arm/position', lambda t, x: (t, x + HOMED))
    problem = prepared(runs, rig).problem
    asked = everyone(rig, sorted(runs[0].channels))
    return Steps(problem, asked, 1, lambda *_: None)


def slipped(steps, time):
    """Return the fit of a slip in the later recording."""
    return steps.problem.fitted(steps.problem.empty.joined(SLIP, {'jump': HOMED, 'time': time}))


def test_a_slip_since_the_beginning_has_zeros_as_rivals(homed):
    state = slipped(homed, 0.0)
    rivals = {r.candidate: r.fit for r in Begun(homed).homed_again(state, SLIP)}
    assert {c.effect for c in rivals} == {'encoder_offset'}
    assert {c.only for c in rivals} == {'later'}
    [arm] = [c for c in rivals if c.place == 'encoder_arm']
    assert rivals[arm].model.values(0)['angle'] == pytest.approx(HOMED, abs=1e-4)
    assert rivals[arm].cost < 1.05 * state.cost


def test_what_was_seen_to_happen_has_none(homed):
    state = slipped(homed, 0.0)
    [row] = state.model.z
    axes = SLIP.coordinates
    at = axes.place({'jump': HOMED, 'time': 3.0})[1]
    later = replace(state, model=replace(state.model, z=((row[0], at),)))
    assert Begun(homed).homed_again(later, SLIP) == []
