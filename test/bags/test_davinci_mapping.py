"""The signs and scales of ``config/imports/davinci_grasper.yaml``, from the data themselves."""

import numpy as np
import pytest

from tendon_ros.bags.importing import import_runs
from tendon_ros.bags.mapping import load_mapping
from tendon_ros.base.resources import config_path


@pytest.fixture(scope='module')
def runs(davinci_npz):
    mapping = load_mapping(config_path('imports/davinci_grasper.yaml'))
    return list(import_runs(davinci_npz, mapping))


def value(run, name):
    return run[name].value


def work(torque, angle):
    """Return the work over a loop, closed by a straight line [J]."""
    closing = 0.5 * (torque[0] + torque[-1]) * (angle[0] - angle[-1])
    return float(np.trapezoid(torque, angle) + closing)


def test_all_runs_come_whole(runs):
    assert len(runs) == 50
    for run in runs:
        assert run.warnings == ()
        assert {c.value.size for c in run.channels.values()} <= set(range(19_000, 20_001))
        assert 'ODbL' in run.metadata['licence']
        assert 'Sine wave' in run.metadata['source_header']
        assert 'GUESSED'.lower() in ' '.join(run.metadata)


def test_angles_rise_together(runs):
    for run in runs:
        spindle = value(run, 'pulley/pulley_spindle/position')
        motor = value(run, 'actuator/pulley_motor/position')
        jaw = value(run, 'pulley/pulley_jaw/position')
        assert np.corrcoef(spindle, motor)[0, 1] > 0.999
        assert np.corrcoef(spindle, jaw)[0, 1] > 0.99


def test_power_falls_along_the_chain(runs):
    for run in runs:
        motor = work(
            value(run, 'actuator/pulley_motor/effort'),
            value(run, 'actuator/pulley_motor/position'),
        )
        spindle = work(
            value(run, 'pulley/pulley_spindle/effort'),
            value(run, 'pulley/pulley_spindle/position'),
        )
        jaw = work(value(run, 'load_cell/torque'), value(run, 'pulley/pulley_jaw/position'))
        assert motor > spindle > jaw > 0.0


def test_drive_and_jaw_push_the_same_way_and_harder_under_load(runs):
    by_key = {run.name: run for run in runs}
    for speed in '01234':
        light, heavy = by_key[f'{speed}0'], by_key[f'{speed}9']
        for name in ('pulley/pulley_spindle/effort', 'load_cell/torque'):
            assert value(heavy, name).mean() > value(light, name).mean() + 0.08


def slope(runs, counts):
    """Return d spindle / d motor with the wind-up of the coupling taken out, by run."""
    slopes = []
    for run in runs:
        spindle = value(run, 'pulley/pulley_spindle/position')
        motor = value(run, 'actuator/pulley_motor/position') * 4096 / counts
        torque = value(run, 'pulley/pulley_spindle/effort')
        direction = np.sign(np.gradient(motor))
        table = np.stack([motor, torque, direction, np.ones_like(motor)], axis=1)
        slopes.append(np.linalg.lstsq(table, spindle, rcond=None)[0][0])
    return np.array(slopes)


def test_the_motor_encoder_has_4096_counts(runs):
    assert np.median(slope(runs, 4096)) == pytest.approx(1.0, abs=0.003)
    assert np.abs(slope(runs, 4096) - 1.0).max() < 0.01
    assert np.abs(slope(runs, 4196) - 1.0).min() > 0.015


def test_zeros_agree_without_load(runs):
    for run in runs:
        motor = value(run, 'actuator/pulley_motor/position')
        spindle = value(run, 'pulley/pulley_spindle/position')
        torque = value(run, 'pulley/pulley_spindle/effort')
        _, at_rest = np.polyfit(torque, spindle - motor, 1)
        assert abs(at_rest) < 0.08


def test_the_tool_alone_reads_the_same(runs, davinci_npz):
    [alone] = import_runs(
        davinci_npz, load_mapping(config_path('imports/davinci_tool.yaml')), ['24']
    )
    [whole] = [run for run in runs if run.name == '24']
    same = {
        'actuator/pulley_input/position': 'pulley/pulley_spindle/position',
        'pulley/pulley_spindle/effort': 'pulley/pulley_spindle/effort',
        'pulley/pulley_jaw/position': 'pulley/pulley_jaw/position',
        'load_cell/torque': 'load_cell/torque',
    }
    assert set(alone.channels) == set(same)
    for name, original in same.items():
        np.testing.assert_array_equal(value(alone, name), value(whole, original))
