"""Bins are as short as what swings behind a spring needs, or what they miss is noise."""

import numpy as np
import pytest

from tendon_ros.base.recording import Channel, Recording
from tendon_ros.diagnose import bins as on_bins
from tendon_ros.diagnose.bins import in_bins
from tendon_ros.diagnose.hidden import coarse_words, loud_words
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.model.instrument_file import load_instrument

MOTOR = (1e-4, 5e-4)  # inertia [kg m^2] and damping [N m s/rad]
FLYWHEEL = (8e-4, 2e-3)
STIFFNESS, DAMPING = 30.0, 6e-3  # [N m/rad], [N m s/rad]: it swings at 31 Hz
COUNT = 2 * np.pi / 4194304
FILE = f"""
pulleys:
  motor: {{inertia: 1e-4 kg*m^2 ± 3 %, damping: 5e-4 N*m*s/rad}}
  fly: {{inertia: 8e-4 kg*m^2 ± 3 %, damping: 2e-3 N*m*s/rad}}
couplings:
  shaft:
    route: {{motor: 1, fly: -1}}
    stiffness: {STIFFNESS} N*m/rad ± 5 %
    damping: {DAMPING} N*m*s/rad guessed
motors:
  motor:
    torque_gain: ± 2 %
    encoder: {{counts: 4194304}}
    torque_sensor: {{resolution: 0.1 mN*m, noise: 1.6 mN*m}}
joint_sensors:
  fly: {{counts: 4194304}}
control: {{rate: 1 kHz}}
"""


@pytest.fixture
def rig(tmp_path):
    path = tmp_path / 'flywheel.yaml'
    path.write_text(FILE, encoding='utf-8')
    return load_instrument(path)


def swung(tones, seconds=6.0):
    """Return what a motor with a flywheel does at tones [Hz] of amplitudes [rad], from rest."""
    time = np.arange(0.0, seconds, 1e-3)
    angle = sum(size * np.sin(2 * np.pi * f * time + n) for n, (f, size) in enumerate(tones))
    angle = angle * np.sin(np.pi * time / seconds) ** 4  # at rest at both ends
    # a response that has died away before it comes round again
    s = 2j * np.pi * np.fft.rfftfreq(4 * len(time), 1e-3)
    turns = np.fft.rfft(angle, 4 * len(time))
    link = STIFFNESS + s * DAMPING
    follows = link / (FLYWHEEL[0] * s**2 + (FLYWHEEL[1] + DAMPING) * s + STIFFNESS)
    own = MOTOR[0] * s**2 + MOTOR[1] * s
    behind, torque = (
        np.fft.irfft(turns * by)[: len(time)] for by in (follows, own + link * (1.0 - follows))
    )
    torque += 1.6e-3 * np.random.default_rng(1).standard_normal(len(time))
    channels = {
        'actuator/pulley_motor/position': COUNT * np.round(angle / COUNT),
        'actuator/pulley_motor/effort': 1e-4 * np.round(1e4 * torque),
        'pulley/pulley_fly/position': COUNT * np.round(behind / COUNT),
    }
    return Recording('swung', {name: Channel(name, time, row) for name, row in channels.items()})


SLOW = ((0.3, 2.0), (1.1, 0.5))
FAST = (*SLOW, (24.0, 3e-4), (29.0, 1e-4))


def off(binned):
    """Return how far the file is off each channel, in noise deviations."""
    [segment], [rows] = binned.segments, binned.predicted
    used = segment.time > 1.0
    return {
        m.sensor.channel: np.sqrt(np.mean((m.value - row)[used] ** 2 / m.noise[used] ** 2))
        for m, row in zip(segment.measured, rows, strict=True)
    }


def test_what_swings_within_few_bins_has_shorter_ones(rig):
    assert in_bins([swung(SLOW)], rig).segments[0].period == pytest.approx(0.008)
    assert in_bins([swung(FAST)], rig).segments[0].period < 0.006


def test_a_true_file_is_right_to_within_noise(rig, monkeypatch):
    assert max(off(in_bins([swung(FAST)], rig)).values()) < 1.2
    monkeypatch.setattr(on_bins, 'DROWNS', np.inf)  # whatever longer bins get wrong
    assert max(off(in_bins([swung(FAST)], rig)).values()) > 2.0


def test_a_guessed_damping_stays_where_it_is_true(rig):
    problem = prepared([swung(FAST)], rig).problem
    fit = problem.fitted(problem.empty)
    [found] = [
        t.use(z).parameters[t.parameter]
        for t, z in zip(problem.tolerances, fit.model.moved, strict=True)
        if t.guessed
    ]
    assert abs(found) < 0.2 * DAMPING


def test_counts_of_a_fine_encoder_make_next_to_nothing(rig):
    [[torque, angle]] = in_bins([swung(SLOW)], rig).noise.counts
    assert np.median(torque) < 1e-4
    assert np.median(angle) < 2 * COUNT


def test_what_too_few_bins_miss_is_noise(rig, monkeypatch):
    monkeypatch.setattr(on_bins, 'BINS', 1000)
    ready = prepared([swung(FAST)], rig)
    [segment] = ready.whole.rollouts.segments
    assert segment.period == pytest.approx(0.008)
    [[torque, _]] = ready.noise.bins
    assert np.max(torque) > 1e-3
    assert np.all(segment.measured[0].noise >= torque)
    assert not loud_words(ready)
    assert any('bins of 8 ms' in said for said in coarse_words(ready))
