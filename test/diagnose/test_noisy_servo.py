"""A servo that is read a hundred times a second, with noise as large as what its friction does."""

from pathlib import Path

import pytest

from tendon_ros.bags.importing import import_runs
from tendon_ros.bags.mapping import load_mapping
from tendon_ros.base.resources import config_path
from tendon_ros.diagnose.bent import degenerate
from tendon_ros.diagnose.logged import is_logged
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.session import diagnose
from tendon_ros.identify.candidate import Candidate
from tendon_ros.model.instrument_file import load_instrument

FILE = Path(__file__).resolve().parents[2] / 'docs' / 'rigs' / 'pendulum_arm.csv'


@pytest.fixture(scope='module')
def polled():
    [run] = import_runs(FILE, load_mapping(config_path('imports/pendulum_arm.yaml')))
    return run


@pytest.fixture(scope='module')
def arm():
    return load_instrument('pendulum_arm')


def test_friction_is_found_where_no_structure_is_to_be_seen(polled, arm):
    diagnosis = diagnose([polled], arm, plan=False).diagnosis
    [cause] = diagnosis.causes
    assert (cause.effect, cause.place) == ('coulomb_friction', 'pulley_arm')
    # the servo gives four fifths of what it reports, and friction is told in what it reports
    low, high = cause.parameters['torque'].ci95
    assert low < 0.06 / 0.8 < high


@pytest.mark.parametrize(('late', 'loggers'), [(0.004, True), (0.012, False)])
def test_registers_are_read_one_after_the_other(polled, arm, late, loggers):
    problem = prepared([polled], arm).problem
    delay = Candidate('sensor_delay', 'encoder_arm'), {'time': late}
    assert not degenerate(problem, *delay)
    assert is_logged(problem, *delay) is loggers
