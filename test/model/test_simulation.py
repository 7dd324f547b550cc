"""One step for live and batch: bit for bit; seeds, sensors, delays; what a user may do wrong."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lsim

from tendon_ros.base.errors import EffectError, SimulationError, TrajectoryError
from tendon_ros.model.instrument import EffectUse, Sensor
from tendon_ros.model.rows import joined
from tendon_ros.model.simulation import Simulation

LATE = EffectUse('sensor_delay', 'encoder_M', {'time': 0.0123})


def noisy(rig):
    """Return the rig with sensors as bad as real ones."""
    sensors = tuple(
        replace(s, noise=1e-4, resolution=1e-5 if s.kind == 'angle' else 0.0) for s in rig.sensors
    )
    controllers = tuple(
        replace(m, controller=replace(m.controller, kp=5.0, ki=10.0, kd=0.0)) for m in rig.motors
    )
    return replace(rig, sensors=sensors, motors=controllers, effects=(*rig.effects, LATE))


@pytest.mark.parametrize('engine', ['auto', 'plain'])
@pytest.mark.parametrize('pieces', [1, 7])
def test_live_is_batch_bit_for_bit(bench_rig, press, engine, pieces):
    rig = noisy(bench_rig.five_pulleys())
    wished = press if engine == 'auto' else press[:140]
    batch = Simulation(rig, seed=3, engine=engine).run(wished).table
    live = Simulation(rig, seed=3, engine=engine)
    parts = [live.run(wished[n : n + pieces]).table for n in range(0, len(wished), pieces)]
    assert np.array_equal(np.concatenate(parts), batch)


def test_recording_less_changes_nothing(bench_rig, press):
    rig = noisy(bench_rig.five_pulleys())
    rows = Simulation(rig, seed=3).run(press)
    thin = Simulation(rig, seed=3).run(press, every=7)
    assert np.array_equal(thin.table, rows.table[::7])


def test_seeds(bench_rig, press):
    rig = noisy(bench_rig.five_pulleys())
    one, same, other = (Simulation(rig, seed=n).run(press[:100]) for n in (1, 1, 2))
    assert np.array_equal(one.table, same.table)
    assert not np.array_equal(one.table, other.table)
    quiet, still = (Simulation(rig).run(press[:100]) for _ in range(2))
    assert np.array_equal(quiet.table, still.table)


def test_reset_begins_anew(bench_rig, press):
    simulation = Simulation(noisy(bench_rig.five_pulleys()), seed=5)
    first = simulation.run(press[:200]).table
    simulation.reset()
    assert simulation.time == 0.0
    assert np.array_equal(simulation.run(press[:200]).table, first)


def test_sensors_read_what_they_say(bench_rig, press):
    rig = bench_rig.five_pulleys()
    sensors = (replace(rig.sensors[0], resolution=1e-3), *rig.sensors[1:])
    gains = (
        EffectUse('encoder_offset', 'encoder_L', {'angle': 0.1}),
        EffectUse('load_cell_gain', 'load_cell', {'gain': 1.5}),
        EffectUse('load_cell_bias', 'load_cell', {'force': 0.25}),
    )
    rows = Simulation(replace(rig, sensors=sensors, effects=gains)).run(press)
    reading = rows.reading
    assert np.abs(reading[:, 0] / 1e-3 - np.round(reading[:, 0] / 1e-3)).max() < 1e-9
    assert np.abs(reading[:, 0] - rows.angle[:, 0]).max() <= 0.5e-3 + 1e-12
    assert reading[:, 1] == pytest.approx(rows.angle[:, 1] + 0.1, abs=1e-12)
    assert reading[:, 2:4] == pytest.approx(rows.effort, abs=1e-12)
    assert reading[:, 4] == pytest.approx(1.5 * rows.contact_force[:, 0] + 0.25, abs=1e-9)


def test_a_delay_is_a_shift(bench_rig, press):
    # the controller sees the delay too, so compare with the true angle of the same run
    rig = bench_rig.five_pulleys()
    late = EffectUse('sensor_delay', 'encoder_L', {'time': 0.0025})
    rows = Simulation(replace(rig, effects=(late,))).run(press)
    truth = rows.angle[:, 1]
    between = 0.5 * (truth[8:-2] + truth[7:-3])
    assert rows.reading[10:, 1] == pytest.approx(between, abs=1e-12)


@pytest.mark.parametrize('lag', [0.0002, 0.0025, 0.02])
def test_a_filter_smooths_what_a_counter_counts(bench_rig, press, lag):
    rig = bench_rig.five_pulleys()
    speed = Sensor('speed_2', 'velocity', '2', 'pulley/pulley_2/velocity')
    rig = replace(rig, sensors=(*rig.sensors, speed))
    signless = EffectUse('sensor_rectified', 'speed_2', {'rectified': 1.0})
    smooth = EffectUse('sensor_delay', 'speed_2', {'time': lag, 'filtered': 1.0})
    rows = Simulation(replace(rig, effects=(signless, smooth))).run(press)
    truth = np.abs(rows.velocity[:, rig.index('2')])
    # as scipy has it, straight between ticks
    _, expected, _ = lsim(([1.0], [lag, 1.0]), truth - truth[0], rows.time - rows.time[0])
    assert np.ptp(truth) > 0.1
    assert rows.reading[:, -1] == pytest.approx(expected + truth[0], abs=1e-9)


def test_effects_change_while_it_runs(bench_rig, press):
    rig = bench_rig.five_pulleys(friction=0.0)
    slip = EffectUse('joint_spring', 'pulley_3', {'stiffness': 2.0, 'rest': 0.1})
    changed, plain = Simulation(rig), Simulation(rig)
    before = changed.run(press[:100]).table
    assert np.array_equal(plain.run(press[:100]).table, before)
    changed.use_effects((slip,))
    pulled, free = changed.run(press[100:300]), plain.run(press[100:300])
    assert np.array_equal(pulled.angle[0], free.angle[0])
    assert np.abs(pulled.angle[-1] - free.angle[-1]).max() > 1e-4
    with pytest.raises(EffectError, match='no effect'):
        changed.use_effects((EffectUse('magic', 'pulley_3', {}),))
    assert changed.instrument.effects == (slip,)


def test_a_contact_comes_and_goes(bench_rig, press):
    simulation = Simulation(bench_rig.five_pulleys())
    assert simulation.run(press[:200]).contact_force[-1, 0] > 1.0
    simulation.use_contact('tip', enabled=False)
    assert np.all(simulation.run(press[200:220]).contact_force == 0.0)
    with pytest.raises(SimulationError, match="no contact 'nose'"):
        simulation.use_contact('nose', enabled=True)


def test_following_ends_where_running_does(bench_rig):
    rig = bench_rig.five_pulleys(continuous=True)
    held = np.tile([0.05, -0.02], (301, 1))
    followed = Simulation(rig).follow(held)
    ran = Simulation(rig).run(held)
    assert len(followed) == 301
    assert np.abs(followed.angle - ran.angle[:301]).max() < 1e-5


def test_setpoints_are_checked(bench_rig):
    simulation = Simulation(bench_rig.five_pulleys(), engine='plain')
    with pytest.raises(TrajectoryError, match=r'shape \(5, 3\); give one column for each motor'):
        simulation.run(np.zeros((5, 3)))
    bad = np.zeros((5, 2))
    bad[3, 1] = np.nan
    with pytest.raises(TrajectoryError, match='set-point 3 of motor L is not a finite number'):
        simulation.run(bad)
    with pytest.raises(SimulationError, match='sampled; use run'):
        simulation.follow(np.zeros((5, 2)))


def test_rows_say_how_many_steps_they_took(bench_rig, press):
    rig = bench_rig.five_pulleys()
    whole, parts = Simulation(rig), Simulation(rig)
    wished = press[:40]
    rows = whole.run(wished)
    assert rows.steps == whole.counts['steps'] + whole.counts['rejected']
    halves = [parts.run(wished[:25]), parts.run(wished[25:])]
    both = joined(halves)
    assert both.steps == sum(half.steps for half in halves) == rows.steps
    assert np.array_equal(both.table, rows.table)
