"""Simulated recordings of the bench with its sensors' noise, and ways to spoil them."""

from dataclasses import replace

import pytest

from tendon_ros.base.recording import Channel
from tendon_ros.diagnose import session
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.session import simulate
from tendon_ros.model.trajectory_choice import chosen_trajectory


@pytest.fixture(scope='session')
def bench():
    """Return the practice bench as a user knows it."""
    return load_instrument('bench_rig')


@pytest.fixture(scope='session')
def recorded():
    """Return a function that simulates the recordings of a rig: in contact, and free."""

    def record(instrument, effects=()):
        rig = replace(instrument, effects=tuple(effects))
        away = replace(rig, contacts=tuple(replace(c, enabled=False) for c in rig.contacts))
        # far enough that the torques of a light rig stand out of their noise
        paper = 'M' in rig.motor_names
        motion = {'duration': '6 s', 'amplitude': '5 deg' if paper else '15 deg'}
        plans = [('free', away, 'multisine', motion)]
        if paper:
            plans.insert(0, ('contact', rig, 'paper_fig12', {}))
        measured = {s.channel for s in rig.sensors}
        measured |= {f'setpoint/pulley_{name}/position' for name in rig.driven}
        runs = []
        for name, one, trajectory, settings in plans:
            run = simulate(
                one, chosen_trajectory(trajectory, rig.motor_names, settings), rate=500.0, seed=1
            )
            kept = {n: c for n, c in run.channels.items() if n in measured}
            runs.append(replace(run, name=name, channels=kept))
        return tuple(runs)

    return record


@pytest.fixture(scope='session')
def sound(bench, recorded):
    """Return the recordings of the bench as it should be."""
    return recorded(bench)


@pytest.fixture(scope='session')
def spoilt():
    """Return a function that changes one channel of each recording, by its time and value."""

    def spoil(recordings, name, change):
        return tuple(
            run.with_channels([Channel(name, *change(run[name].time, run[name].value))])
            if name in run
            else run
            for run in recordings
        )

    return spoil


@pytest.fixture(scope='session')
def scaled(spoilt):
    """Return a function that multiplies one channel of each recording."""
    return lambda recordings, name, factor: spoilt(
        recordings, name, lambda time, value: (time, factor * value)
    )


@pytest.fixture(scope='session')
def only():
    """Return a function that keeps of each recording the channels that begin alike."""

    def keep(recordings, *starts):
        return tuple(
            replace(r, channels={n: c for n, c in r.channels.items() if n.startswith(starts)})
            for r in recordings
        )

    return keep


FRICTION = ('coulomb_friction', 'pulley_3', {'torque': 0.1})
SCALE = ('encoder_gain', 'encoder_1', {'gain': 1.03})


@pytest.fixture(scope='session')
def quick():
    """Return a diagnosis that does not simulate what to measure next: that takes longest."""

    def run(recordings, instrument, **settings):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(session, 'next_experiments', lambda *_: ())
            return session.diagnose(recordings, instrument, **settings)

    return run


@pytest.fixture(scope='session')
def sound_outcome(bench, measured_on, quick):
    """Return what is said of a bench as it should be."""
    return quick([measured_on(bench)], bench)


@pytest.fixture(scope='session')
def two_run(bench, measured_on):
    """Return a recording of the bench with two effects."""
    return measured_on(bench, FRICTION, SCALE)


@pytest.fixture(scope='session')
def two_outcome(bench, two_run, quick):
    """Return what is said of it."""
    return quick([two_run], bench)


@pytest.fixture(scope='session')
def sound_problem(bench, sound):
    """Return the problem of the bench with nothing wrong."""
    return prepared(sound, bench).problem


@pytest.fixture(scope='module')
def pressed(bench, measured_on):
    """Return a recording with the tip against the wall."""
    return measured_on(bench, trajectory='paper_fig12', settings=(), touching=True, name='contact')


@pytest.fixture(scope='module')
def free(bench, measured_on):
    """Return a recording with the tip free, and a load cell that reads noise."""
    return measured_on(bench)
