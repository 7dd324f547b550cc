"""A motor of which nobody knows the controller: it is driven along recordings, by no command."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.base.errors import InstrumentError
from tendon_ros.diagnose.session import diagnose
from tendon_ros.identify.excitation_rig import controlled, performed
from tendon_ros.model.instrument_file import load_instrument, save_instrument
from tendon_ros.model.simulation import Simulation
from tendon_ros.model.trajectory import Trajectory

FILE = """
pulleys: {axis: {inertia: 1e-3 kg*m^2, damping: 0.02 N*m*s/rad}}
motors: {axis: {}}
"""


@pytest.fixture
def loose(tmp_path):
    """Return an instrument whose motor has nothing but a name."""
    file = tmp_path / 'loose.yaml'
    file.write_text(FILE)
    return load_instrument(file)


def test_a_file_needs_no_controller_and_is_written_without(loose, tmp_path):
    assert loose.motors[0].controller is None
    save_instrument(loose, tmp_path / 'again.yaml')
    assert 'controller' not in (tmp_path / 'again.yaml').read_text()
    assert load_instrument(tmp_path / 'again.yaml').motors == loose.motors


def test_it_follows_no_command(loose):
    with pytest.raises(InstrumentError, match=r'makes axis follow .* motors\.axis\.controller'):
        Simulation(loose)


def test_an_experiment_is_planned_with_a_usual_one(loose):
    time = np.array([0.0, 0.5, 1.0])
    step = Trajectory('step', time, {'axis': np.array([0.0, 0.2, 0.2])})
    rows, _ = performed(loose, step)
    assert rows.angle[-1, 0] == pytest.approx(0.2, abs=0.01)
    own = replace(loose, motors=controlled(loose).motors)
    assert controlled(own) == own


def test_a_recording_is_diagnosed_without_a_closed_loop(measured_on):
    body = load_instrument('single_body')
    friction = ('coulomb_friction', 'pulley_body', {'torque': 0.2})
    run = measured_on(body, friction)
    loose = replace(body, motors=(replace(body.motors[0], controller=None),))
    diagnosis = diagnose([run], loose, plan=False).diagnosis
    assert [(c.effect, c.place) for c in diagnosis.causes] == [friction[:2]]
    assert diagnosis.closed_loop == ()
    said = 'no closed loop: the instrument file has no controller of motor body'
    assert said in diagnosis.left_out
