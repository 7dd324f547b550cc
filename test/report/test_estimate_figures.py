"""The picture and the score of an estimate, where messages of some channels were lost."""

import numpy as np
import pytest

from tendon_ros.base.recording import Channel, Recording
from tendon_ros.estimate.score import scored
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.report.estimate_figures import estimate_figure

TIME = np.arange(0.0, 4.0, 0.01)


def recording(lost):
    """Return live estimates of a force, without one message of some channels."""
    force = 5.0 * np.sin(TIME)
    values = {
        'load_cell/force': force,
        'estimate/force': force + 0.1,
        'estimate/force_std': np.full(len(TIME), 0.2),
        'estimate/pulley_3/position': 0.1 * np.sin(TIME),
        'pulley/pulley_3/position': 0.1 * np.sin(TIME) + 1e-3,
    }
    channels = {}
    for n, (name, value) in enumerate(values.items()):
        there = np.ones(len(TIME), dtype=bool)
        there[50 + 7 * n] = name not in lost
        channels[name] = Channel(name, TIME[there], value[there])
    return Recording('live', channels)


@pytest.mark.parametrize(
    'lost',
    [
        (),
        ('estimate/force',),
        ('estimate/force_std',),
        ('estimate/pulley_3/position', 'pulley/pulley_3/position', 'load_cell/force'),
    ],
)
def test_a_lost_message_of_one_channel_spoils_neither_picture_nor_score(lost):
    one = recording(lost)
    top, error, low = estimate_figure.__wrapped__(one).axes
    estimate, cell = top.lines[:2]
    assert len(estimate.get_xdata()) == len(one['estimate/force'].time)
    assert np.array_equal(estimate.get_xdata(), cell.get_xdata())
    assert error.lines[0].get_ydata() == pytest.approx(0.1, abs=1e-3)
    found, true = (line.get_ydata() for line in low.lines[:2])
    assert true - found == pytest.approx(np.rad2deg(1e-3), abs=1e-3)
    score = scored(one, load_instrument('bench_rig'))
    assert score.rmse == pytest.approx(0.1, abs=1e-3)
    assert score.coverage == 1.0
    assert score.samples == len(one['estimate/force'].time)
