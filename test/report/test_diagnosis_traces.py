"""The traces that show most are chosen, judged on what no fit has seen, and drawn."""

from dataclasses import replace
import struct

import numpy as np
import pytest

from tendon_ros.diagnose.evidence import Trace
from tendon_ros.report.diagnosis_traces import rmse, telling, trace_figure

NAMES = ('actuator/pulley_M/effort', 'load_cell/force')


def trace(recording: str, channel: str, off: float, n: int = 400) -> Trace:
    """Return a trace that is off by a constant before, and by a tenth of it after."""
    time = np.linspace(0.0, 4.0, n)
    wave = np.sin(time)
    held = time > 3.0
    return Trace(recording, channel, 'N m', time, wave, wave + off, wave + 0.1 * off, held)


def test_rmse_is_that_of_held_out_data():
    one = trace('a', NAMES[0], 0.5)
    before = one.before + np.where(one.held_out, 0.5, 7.0)
    assert rmse(replace(one, before=before)) == pytest.approx((1.0, 0.05))
    # where everything was fitted, there is nothing else to judge by
    assert rmse(replace(one, held_out=np.zeros(400, dtype=bool))) == pytest.approx((0.5, 0.05))


def test_worst_against_its_noise_comes_first_and_no_channel_is_missing():
    traces = [trace(f'r{k}', NAMES[0], 1.0 + 0.1 * k) for k in range(10)]
    traces.append(trace('weak', NAMES[1], 0.5))
    chosen = telling(traces, dict.fromkeys(NAMES, 0.1), 6)
    assert len(chosen) == 6
    assert chosen[0].recording == 'r9'
    assert chosen[-1].recording == 'weak'
    noisy = telling(traces, {NAMES[0]: 10.0, NAMES[1]: 0.1}, 6)
    assert noisy[0].recording == 'weak'


def test_traces_without_samples_are_not_drawn():
    assert telling([trace('empty', NAMES[0], 1.0, 1)], {}, 6) == ()


@pytest.mark.parametrize('floor', [0.02, None])
def test_figure_is_drawn_for_light_and_dark(floor):
    light, dark = trace_figure(trace('a', NAMES[0], 0.5), floor)
    assert light != dark
    for png in (light, dark):
        assert png.startswith(b'\x89PNG')
        width, height = struct.unpack('>II', png[16:24])
        assert 600 < width < 700
        assert height > width


def test_figure_of_a_flat_or_broken_channel():
    flat = trace('flat', NAMES[0], 0.0)
    trace_figure(replace(flat, measured=np.zeros(400), before=np.zeros(400)), 0.0)
    broken = flat.before.copy()
    broken[10:20] = np.nan
    trace_figure(replace(flat, before=broken), 0.01)
