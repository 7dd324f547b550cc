"""Guesses that are far off: a fit of what swings finds its way from afar, but not from there."""

import numpy as np
import pytest

from tendon_ros.blind.case import made, Settings
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.multistart import afar, FAR, KEPT

WITHOUT_SIGN = Candidate('sensor_rectified', 'speed_roller')


@pytest.fixture(scope='module')
def rectified(far_off_belt):
    return far_off_belt.empty.joined(WITHOUT_SIGN, {'rectified': 1.0})


def power(problem, fit):
    """Return what a fit leaves, in noise power per sample."""
    return fit.cost / len(fit.left)


def test_a_fit_from_afar_finds_what_one_from_nearby_does_not(far_off_belt, rectified):
    nearby = far_off_belt.fitted(rectified, rounds=20, accuracy=1e-3)
    begun = [
        far_off_belt.fitted(m, rounds=12, accuracy=1e-2) for m in afar(far_off_belt, rectified)
    ]
    assert min(power(far_off_belt, fit) for fit in begun) < 0.5 * power(far_off_belt, nearby)


def test_guesses_alone_move_and_not_beyond_what_a_guess_may_be(far_off_belt, rectified):
    models = afar(far_off_belt, rectified)
    assert len(models) == KEPT
    for model in models:
        assert model.causes == rectified.causes
        for t, z in zip(far_off_belt.tolerances, model.moved, strict=True):
            if not t.guessed:
                assert z == 0.0
            elif t.axis.log:
                assert abs(np.log(t.axis.value(float(z)))) <= 1.001 * np.log(FAR)


def test_what_is_worst_is_not_kept(far_off_belt, rectified):
    costs = [float(np.sum(far_off_belt.left(m) ** 2)) for m in afar(far_off_belt, rectified)]
    assert costs == sorted(costs)


def test_where_motions_are_known_fits_begin_with_the_file(sound_problem):
    assert afar(sound_problem, sound_problem.empty) == []


def test_bodies_behind_cables_are_found_from_afar_alone():
    # every inertia, damping, stiffness and preload is up to two times off
    case = made(608, 1, Settings(bench='guessed', channels=('force',)))
    assert case.label['stratum'] == 'none'
    problem = prepared([case.recordings['mixed']], case.instrument).problem
    nearby = problem.fitted(problem.empty, rounds=20, accuracy=1e-3)
    begun = [problem.fitted(m, rounds=20, accuracy=1e-3) for m in afar(problem, problem.empty)]
    assert power(problem, nearby) > 2.0
    assert min(power(problem, fit) for fit in begun) < 0.4 * power(problem, nearby)
