"""A log that was rounded has coarser counts than its encoder."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.base.recording import Channel
from tendon_ros.diagnose.intake.counts import as_counted, step_of
from tendon_ros.model.instrument_file import load_instrument

CHANNEL = 'actuator/pulley_body/position'


@pytest.fixture(scope='module')
def body():
    """Return one body on a motor."""
    return load_instrument('single_body')


def rounded(run, step):
    """Return a recording whose log has the motor's angle to a step only."""
    own = run[CHANNEL]
    channel = Channel(CHANNEL, own.time, np.round(own.value / step) * step)
    return replace(run, channels={**run.channels, CHANNEL: channel})


def test_steps_of_a_log_count_where_they_are_coarser(body, measured_on):
    run = measured_on(body)
    own, nothing = as_counted([run], body)
    assert own == body
    assert not nothing
    coarse, [said] = as_counted([rounded(run, 1e-3)], body)
    [sensor] = [s for s in coarse.sensors if s.channel == CHANNEL]
    assert sensor.resolution == pytest.approx(1e-3)
    assert 'steps of 0.001 rad' in said
    # one recording that is finer shows what the encoder can
    assert as_counted([rounded(run, 1e-3), run], body)[0] == body


def test_what_no_step_divides_has_none():
    rng = np.random.default_rng(4)
    steps = np.cumsum(rng.integers(1, 40, 3000))
    assert step_of(2e-7 * steps, 1e-8) == pytest.approx(2e-7)
    assert step_of(np.cumsum(rng.uniform(1e-7, 4e-6, 3000)), 1e-8) == 0.0
    assert step_of(np.full(3000, 0.3), 1e-8) is None


def test_a_rounded_log_is_no_gap(body, measured_on, quick):
    run = rounded(measured_on(body), 1e-3)
    found = quick([run], body).diagnosis
    assert found.verdict == 'no_gap'
    assert any('come in steps' in said for said in found.left_out)
