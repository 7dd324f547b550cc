"""Guesses that are far off: a fit of what swings finds its way from afar, but not from there."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tendon_ros.bags.importing import import_runs
from tendon_ros.bags.mapping import load_mapping
from tendon_ros.base.resources import config_path
from tendon_ros.blind.case import made, Settings
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.identify.afar import afar, FAR, KEPT
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.driving import as_recorded
from tendon_ros.model.instrument import Curve
from tendon_ros.model.instrument_file import load_instrument

TABLE = Path(__file__).parents[2] / 'docs' / 'rigs' / 'belt_by_voltage.csv'
WITHOUT_SIGN = Candidate('sensor_rectified', 'speed_roller')
SOFT, SMOOTH, HEAVY = 0.1, 0.1, 5.0  # times what the file of the tutorial guesses
MOTORS = ('left', 'right')


@pytest.fixture(scope='module')
def problem():
    """Return the tutorial's recording with a file that guesses another belt."""
    [run] = import_runs(TABLE, load_mapping(config_path('imports/belt_by_voltage.yaml')))
    belt = as_recorded(load_instrument('belt_by_voltage'), set(run.channels))
    soft = tuple(
        Curve(c.name, c.elongation, tuple(SOFT * t for t in c.tension)) for c in belt.curves
    )
    loops = tuple(replace(loop, pretension=SOFT * loop.pretension) for loop in belt.loops)
    wheels = tuple(
        replace(
            p, damping=SMOOTH * p.damping, inertia=p.inertia * (HEAVY if p.name in MOTORS else 1.0)
        )
        for p in belt.pulleys
    )
    wrong = replace(belt, curves=soft, loops=loops, pulleys=wheels)
    return prepared([run], wrong).problem


@pytest.fixture(scope='module')
def rectified(problem):
    return problem.empty.joined(WITHOUT_SIGN, {'rectified': 1.0})


def power(problem, fit):
    """Return what a fit leaves, in noise power per sample."""
    return fit.cost / len(fit.left)


def test_a_fit_from_afar_finds_what_one_from_nearby_does_not(problem, rectified):
    nearby = problem.fitted(rectified, rounds=20, accuracy=1e-3)
    begun = [problem.fitted(m, rounds=12, accuracy=1e-2) for m in afar(problem, rectified)]
    assert min(power(problem, fit) for fit in begun) < 0.5 * power(problem, nearby)


def test_guesses_alone_move_and_not_beyond_what_a_guess_may_be(problem, rectified):
    models = afar(problem, rectified)
    assert len(models) == KEPT
    for model in models:
        assert model.causes == rectified.causes
        for t, z in zip(problem.tolerances, model.moved, strict=True):
            if not t.guessed:
                assert z == 0.0
            elif t.axis.log:
                assert abs(np.log(t.axis.value(float(z)))) <= 1.001 * np.log(FAR)


def test_what_is_worst_is_not_kept(problem, rectified):
    costs = [float(np.sum(problem.left(m) ** 2)) for m in afar(problem, rectified)]
    assert costs == sorted(costs)


def test_where_motions_are_known_fits_begin_with_the_file(sound_problem):
    assert afar(sound_problem, sound_problem.empty) == []


def test_bodies_behind_cables_are_found_from_afar_alone():
    # every inertia, damping, stiffness and preload is up to two times off
    case = made(608, 1, Settings(bench='guessed', channels=('force',)))
    assert case.label['stratum'] == 'none'
    problem = prepared(list(case.recordings.values()), case.instrument).problem
    nearby = problem.fitted(problem.empty, rounds=20, accuracy=1e-3)
    begun = [problem.fitted(m, rounds=20, accuracy=1e-3) for m in afar(problem, problem.empty)]
    assert power(problem, nearby) > 2.0
    assert min(power(problem, fit) for fit in begun) < 1.1
