"""What is said beside the verdict: channels that scatter more than anything accounts for."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.diagnose.gather import loud_words, worse_words
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.result import ChannelGap
from tendon_ros.model.instrument_file import load_instrument

EFFORT = 'actuator/pulley_body/effort'


@pytest.mark.parametrize(('more', 'told'), [(0.0, True), (0.05, True), (0.05, False)])
def test_what_shakes_faster_than_bins_is_said_where_the_sensor_is_known(measured_on, more, told):
    body = load_instrument('single_body')
    run = measured_on(body)
    effort = run[EFFORT]
    shaken = effort.value + more * np.random.default_rng(1).standard_normal(effort.value.size)
    run = run.with_channels([replace(effort, value=shaken)])
    if not told:
        sensors = [replace(s, noise=0.0, resolution=0.0) for s in body.sensors]
        body = replace(body, sensors=tuple(sensors))
    words = loud_words(prepared([run], body))
    assert [w.split()[0] for w in words] == ([EFFORT] if more and told else [])
    # the sensor's own noise is 5 mN m, and counts make some more
    assert all(4 <= int(w.split()[2]) <= 10 for w in words)


@pytest.mark.parametrize(
    ('before', 'after', 'said'), [(1.1, 1.7, True), (1.1, 1.2, False), (0.5, 0.9, False)]
)
def test_a_channel_that_others_spoil_is_said(before, after, said):
    gap = ChannelGap(
        channel=EFFORT, unit='N m', before=before, after=after, noise_floor=0.9, ci95=(0.0, 2.0)
    )
    assert bool(worse_words([gap])) is said
