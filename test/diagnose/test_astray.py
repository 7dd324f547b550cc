"""Single readings that nothing around agrees with are taken out and told, and no others."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.base.recording import Channel
from tendon_ros.diagnose.intake import admitted
from tendon_ros.diagnose.intake.astray import without_astray
from tendon_ros.model.instrument_file import load_instrument

POSITION, EFFORT = 'actuator/pulley_axis/position', 'actuator/pulley_axis/effort'


@pytest.fixture(scope='module')
def axis():
    return load_instrument('driven_axis')


@pytest.fixture(scope='module')
def swings(axis, measured_on):
    """Return a recording of an axis in motion."""
    return measured_on(axis, settings=(('duration', '6 s'), ('amplitude', '40 deg')))


def shifted(run, rows, by):
    """Return a recording in which some readings of the motor's angle are off."""
    channel = run[POSITION]
    value = channel.value.copy()
    value[rows] += by
    return run.with_channels([Channel(POSITION, channel.time, value)])


@pytest.mark.parametrize('by', [0.02, -3.0])
def test_single_readings_are_taken_out_and_told(axis, swings, by):
    intake = admitted([shifted(swings, [700, 1500], by)], axis)
    [run] = intake.recordings  # and it is not cut there
    assert np.array_equal(run[POSITION].value, np.delete(swings[POSITION].value, [700, 1500]))
    [told] = [words for words in intake.left_out if 'nothing around agrees' in words]
    assert f'2 readings of {POSITION} are left out' in told
    assert f'off by {abs(by):.2g} rad' in told


@pytest.mark.parametrize(
    ('rows', 'by'),
    [
        (slice(None, 0), 0.0),  # sound
        (slice(700, 704), 0.02),  # something happened for longer than a reading
        (slice(700, None), 0.02),  # counts were lost
        (slice(None, None, 20), 0.02),  # so it reads
        ([700], 1e-5),  # within counts
        ([2], 0.02),  # at the end
    ],
)
def test_others_stay(axis, swings, rows, by):
    run = shifted(swings, rows, by)
    assert without_astray([run], axis) == ((run,), [])


def test_stamps_that_scatter_hide_none(axis, swings):
    """Beside their stamps, readings are as late as this one; beside the time of a reading not."""
    rng = np.random.default_rng(8)
    even = 3.0 + 0.002 * np.arange(3000)
    read = even.copy()
    read[1500] += 1.5e-4
    angle = np.round((0.4 * np.sin(5.0 * read) + 0.2 * np.sin(11.0 * read)) / 1e-5) * 1e-5
    stamps = even + rng.uniform(0.0, 2e-4, 3000)
    run = swings.with_channels(
        [Channel(POSITION, stamps, angle), Channel(EFFORT, stamps, np.cos(5.0 * read))]
    )
    fine = replace(axis, sensors=tuple(replace(s, resolution=1e-5) for s in axis.sensors))
    assert without_astray([run], fine)[1] == []
    said = ' '.join(admitted([run], fine).left_out)
    assert 'sampled evenly' in said
    assert f'1 reading of {POSITION} is left out' in said


def test_of_a_few_readings_none_is_judged(axis, swings):
    short = swings.with_channels(
        [replace(c, time=c.time[:40], value=c.value[:40]) for c in swings.channels.values()]
    )
    assert without_astray([short], axis) == ((short,), [])


def test_a_count_that_comes_and_goes_at_rest_is_none_however_large(axis, swings):
    channel = swings[POSITION]
    value = np.zeros(channel.value.size)
    value[700:1500] = 10.0 * np.round(10.0 * np.sin(0.01 * np.arange(800)))
    value[[100, 400, 2000]] = 10.0
    run = swings.with_channels([Channel(POSITION, channel.time, value)])
    assert without_astray([run], axis) == ((run,), [])
