"""The simulator without ROS: stepped by a clock, it does what the batch does."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.base.errors import SimulationError, TrajectoryError
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.recorded import channel_values
from tendon_ros.model.simulation import Simulation
from tendon_ros.nodes.live_simulation import LiveSimulation


@pytest.fixture(scope='module')
def rig():
    return load_instrument('paper_rig')


def live_of(instrument, every=2, move_speed=0.5):
    live = LiveSimulation(Simulation(instrument), every=every, move_speed=move_speed)
    live.reset(10**18, 0.0)
    return live


def collect(live, times, at=()):
    """Advance to every time; ``at`` maps the index of a step to what is done before it."""
    stamps, values = [], {}
    for k, now in enumerate(times):
        dict(at).get(k, lambda: None)()
        samples = live.advance(now)
        if samples is not None:
            stamps += samples.stamps.tolist()
            for name, column in samples.values.items():
                values.setdefault(name, []).extend(column.tolist())
    return np.array(stamps), {name: np.array(column) for name, column in values.items()}


def test_a_stumbling_loop_gives_what_a_steady_one_and_the_batch_give(rig):
    steady = np.arange(0.0, 0.5, 0.002) + 1e-5
    rng = np.random.default_rng(1)
    stumbling = np.unique(np.concatenate([[0.0], rng.uniform(0.0, 0.5, 40), [0.499]]))
    found = []
    for times in (steady, stumbling):
        live = live_of(rig)
        command = [(0, lambda live=live: live.servo({'pulley_M': 0.02}))]
        found.append(collect(live, times, command))
    count = min(len(stamps) for stamps, _ in found)
    assert count > 240
    batch = Simulation(rig)
    wished = np.tile([0.02, 0.0], (2 * count, 1))
    rows = channel_values(batch.run(wished, 2), wished[::2])
    for stamps, values in found:
        assert np.array_equal(stamps[:count], 10**18 + 2_000_000 * np.arange(count))
        for name, column in rows.items():
            assert np.array_equal(values[name][:count], column[:count]), name


def test_every_channel_of_the_contract_is_there(rig):
    samples = live_of(rig).advance(0.0)
    wanted = {f'actuator/pulley_{n}/{f}' for n in 'ML' for f in ('position', 'effort')}
    wanted |= {f'setpoint/pulley_{n}/position' for n in 'ML'} | {'load_cell/force'}
    wanted |= {f'pulley/pulley_{n}/{f}' for n in '123' for f in ('position', 'velocity')}
    assert samples.values.keys() == wanted


def test_a_planned_motion_is_busy_until_its_goal(rig):
    live = live_of(rig)
    times = np.arange(0.0, 0.6, 0.002)
    busy = []
    collect(live, times[:1])
    live.move({'pulley_M': 0.05})
    assert live.is_busy
    _, values = collect(
        live, times[1:], [(k, lambda: busy.append(live.is_busy)) for k in (5, 290)]
    )
    assert busy == [True, False]
    wished = values['setpoint/pulley_M/position']
    assert wished[-1] == 0.05
    assert np.all(np.diff(wished) >= 0.0)
    assert np.max(np.diff(wished)) / 0.002 <= 0.5


def test_a_servo_command_ends_a_motion_where_it_is(rig):
    live = live_of(rig)
    collect(live, [0.0])
    live.move({'pulley_M': 0.05})
    collect(live, [0.05])
    live.hold()
    assert not live.is_busy
    _, values = collect(live, [0.06, 0.07])
    held = values['setpoint/pulley_M/position']
    assert 0.0 < held[0] < 0.05
    assert np.all(held == held[0])


def test_a_command_beyond_a_limit_is_refused_and_the_last_is_held(rig):
    live = live_of(rig)
    live.servo({'pulley_M': 0.01})
    for act in (live.servo, live.move):
        with pytest.raises(TrajectoryError, match=r'pulley_L: 3 rad is beyond its limits -0\.78'):
            act({'pulley_M': 0.2, 'pulley_L': 3.0})
    _, values = collect(live, [0.0, 0.1])
    assert np.all(values['setpoint/pulley_M/position'] == 0.01)


def test_a_reset_goes_to_zero_and_stamps_never_step_back(rig):
    live = live_of(rig)
    live.servo({'pulley_M': 0.05})
    before, _ = collect(live, np.arange(0.0, 0.3, 0.01))
    live.reset(0, 5.0)
    after, values = collect(live, np.arange(5.0, 5.1, 0.01))
    assert after[0] > before[-1]
    assert np.all(values['setpoint/pulley_M/position'] == 0.0)
    assert np.all(np.abs(values['actuator/pulley_M/position']) < 1e-6)


def test_effects_and_contact_act_while_it_runs(rig):
    live = live_of(rig)
    live.servo({'pulley_M': 0.05})
    times = np.arange(0.0, 2.0, 0.05)
    force = collect(live, times)[1]['load_cell/force']
    assert force[-1] > 0.5
    live.use_contact(enabled=False)
    force = collect(live, times + 2.0)[1]['load_cell/force']
    assert force[-1] == 0.0
    live.use_effects([EffectUse('load_cell_bias', 'load_cell', {'force': 3.0})])
    assert collect(live, times[:5] + 4.0)[1]['load_cell/force'][-1] == pytest.approx(3.0)


def test_contact_of_an_instrument_without_one(rig):
    bare = replace(rig, contacts=(), sensors=tuple(s for s in rig.sensors if s.of != 'tip'))
    live = LiveSimulation(Simulation(bare, engine='plain'), every=2, move_speed=0.5)
    with pytest.raises(SimulationError, match='has no contact'):
        live.use_contact(enabled=True)


class Diverging:
    """Stands for a simulation that fails at its third call."""

    def __init__(self, inner):
        self.inner, self.calls = inner, 0

    def __getattr__(self, name):
        return getattr(self.inner, name)

    def run(self, wished, every):
        self.calls += 1
        if self.calls == 3:
            raise SimulationError('rig: the simulation diverged near 0.01 s')
        return self.inner.run(wished, every)


def test_a_divergence_is_said_once_and_a_reset_mends_it(rig):
    live = LiveSimulation(Diverging(Simulation(rig)), every=2, move_speed=0.5)
    live.reset(0, 0.0)
    collect(live, [0.0, 0.002])
    assert live.failure is None
    with pytest.raises(SimulationError) as raised:
        live.advance(0.004)
    assert live.failure is raised.value
    assert live.advance(0.006) is None
    assert live.wait(0.0061) > 0.0
    live.reset(0, 0.007)
    assert live.failure is None
    assert live.advance(0.008) is not None
