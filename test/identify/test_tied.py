"""What is alike in the file is alike at first: a belt that rubs is found from guesses far off."""

import numpy as np
import pytest

from tendon_ros.diagnose.everywhere import everywhere
from tendon_ros.identify.candidate import Candidate, everyone
from tendon_ros.identify.multistart import afar, kinds_of
from tendon_ros.identify.tied import FITTED, RUBS, tied

WITHOUT_SIGN = Candidate('sensor_rectified', 'speed_roller')


@pytest.fixture(scope='module')
def of_size(far_off_belt):
    """Return the belt, its counter without a sign, with all that rubs at a part of its size."""
    belt = far_off_belt.rollouts.instrument
    candidates = everyone(belt, [s.channel for s in belt.sensors])
    without_sign = far_off_belt.empty.joined(WITHOUT_SIGN, {'rectified': 1.0})
    return lambda part: everywhere(candidates, without_sign, part)


@pytest.fixture(scope='module')
def begun(far_off_belt, of_size):
    return tied(far_off_belt, lambda sizes: of_size(*sizes))


def left(problem, model):
    return float(np.sum(problem.left(model) ** 2))


def test_what_leaves_least_comes_first(far_off_belt, begun):
    assert 1 < len(begun) <= FITTED
    costs = [far_off_belt.fitted(model, rounds=0).cost for model in begun]
    assert costs == sorted(costs)


def test_guesses_of_a_kind_and_sizes_move_alike(far_off_belt, of_size, begun):
    kinds = kinds_of(far_off_belt)
    whole = of_size(1.0)
    for model in begun:
        factors = {}
        for n, kind in kinds.items():
            axis = far_off_belt.tolerances[n].axis
            if axis.log:
                factors.setdefault(kind, []).append(axis.value(float(model.moved[n])))
        assert all(np.ptp(f) < 1e-9 * max(f) for f in factors.values())
        assert all(z == 0.0 for n, z in enumerate(model.moved) if n not in kinds)
        assert model.causes == whole.causes
        parts = [
            model.values(k)['torque'] / whole.values(k)['torque']
            for k, cause in enumerate(model.causes)
            if cause.effect == 'coulomb_friction'
        ]
        assert len(parts) > 1
        assert np.ptp(parts) < 1e-9
        assert RUBS[0] <= parts[0] <= RUBS[1]


def test_with_what_rubs_less_is_left_than_from_afar_without(far_off_belt, of_size, begun):
    without = of_size(1.0)
    without = without.without(*range(1, len(without.causes)))
    frictionless = min(left(far_off_belt, model) for model in afar(far_off_belt, without))
    assert left(far_off_belt, begun[0]) < 0.5 * frictionless
