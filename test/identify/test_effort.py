"""What predictions cost is counted alike, whoever computes them and whatever is remembered."""

import pytest

from tendon_ros.diagnose.prepare import prepared
from tendon_ros.identify.effort import BIN, Effort, STEP
from tendon_ros.model.instrument import EffectUse


def test_steps_and_bins_add_up():
    effort = Effort()
    assert effort.seconds == 0.0
    effort.spend(1000, 200)
    effort.spend(500, 0)
    assert effort.seconds == pytest.approx(1500 * STEP + 200 * BIN)


def test_what_is_remembered_counts_as_what_is_computed(bench, measured_on):
    rollouts = prepared([measured_on(bench)], bench).problem.rollouts
    use = EffectUse('coulomb_friction', 'pulley_L', {'torque': 0.1})

    def spent():
        before = rollouts.effort.seconds
        rollouts.predicted([[use]])
        return rollouts.effort.seconds - before

    first = spent()
    assert first > STEP * 500
    assert spent() == pytest.approx(first)


def test_what_is_derived_from_rollouts_counts_with_them(bench, measured_on):
    ready = prepared([measured_on(bench)], bench)
    assert ready.problem.rougher().rollouts.effort is ready.problem.rollouts.effort
    assert ready.held.rollouts.effort is ready.problem.rollouts.effort
