"""A log that was rounded has coarser counts than its encoder."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.base.recording import Channel
from tendon_ros.diagnose.intake.counts import as_counted, step_of
from tendon_ros.diagnose.intake.limits import strong_words
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


def test_a_step_that_is_a_unit_off_is_said(body, measured_on):
    run = measured_on(body)
    thousand = replace(
        body,
        sensors=tuple(
            replace(s, resolution=1e-6) if s.channel == CHANNEL else s for s in body.sensors
        ),
    )
    [said] = as_counted([rounded(run, 1e-3)], thousand)[1]
    assert 'as if in mrad instead of rad' in said


def test_a_torque_far_beyond_its_limit_is_said(body, measured_on, quick):
    run = measured_on(body)
    name = 'actuator/pulley_body/effort'
    strong = Channel(name, run[name].time, 1e3 * run[name].value)
    assert strong_words([run], body) == ()
    found = strong_words([replace(run, channels={**run.channels, name: strong})], body)
    assert len(found) == 1
    assert f'{name} reaches' in found[0]
    assert 'times what motor body' in found[0]
