"""Fixtures that several folders of tests share."""

from dataclasses import replace
import math
from pathlib import Path

from hypothesis import HealthCheck, settings
import pytest

from tendon_ros.base.threads import use_one_thread

use_one_thread()  # as all programs do; pytest runs a process on every core

# these import numpy, which reads then how many threads it may use
from tendon_ros.bags.importing import import_runs  # noqa: E402
from tendon_ros.bags.mapping import load_mapping  # noqa: E402
from tendon_ros.base.recording import Channel  # noqa: E402
from tendon_ros.base.resources import config_path  # noqa: E402
from tendon_ros.diagnose.prepare import prepared  # noqa: E402
from tendon_ros.identify.driving import as_recorded  # noqa: E402
from tendon_ros.model.instrument import Curve, EffectUse  # noqa: E402
from tendon_ros.model.instrument_file import load_instrument  # noqa: E402
from tendon_ros.model.session import simulate  # noqa: E402
from tendon_ros.model.trajectory_choice import chosen_trajectory  # noqa: E402

# machines are shared and noisy: no test passes or fails by the time it took
settings.register_profile('untimed', deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile('untimed')

#: recordings that do not come with the package; tests that want them skip without
SHARED = Path(__file__).resolve().parents[2] / 'shared'

BY_VOLTAGE = Path(__file__).parents[1] / 'docs' / 'rigs' / 'belt_by_voltage.csv'
SOFT, SMOOTH, HEAVY = 0.1, 0.1, 5.0  # times what the file of that tutorial guesses
MOTORS = ('left', 'right')


def _shared(relative: str) -> Path:
    path = SHARED / relative
    if not path.exists():
        pytest.skip(f'{path} is not there')
    return path


@pytest.fixture(scope='session')
def shared():
    """Return the folder with shared recordings; skip where it is absent."""
    return _shared('.')


@pytest.fixture(scope='session')
def practice():
    """Return the folder of the practice bags; skip where it is absent."""
    return _shared('practice')


@pytest.fixture(scope='session')
def davinci_npz():
    """Return the file of the da Vinci grasper's runs; skip where it is absent."""
    return _shared('recordings/davinci_grasper/Tool_5_Maryland_L_3.npz')


@pytest.fixture(scope='session')
def curve_of(tmp_path_factory):
    """Return a function that reads the file of a cable's curve as an instrument does."""

    def read(path):
        file = tmp_path_factory.mktemp('curves') / 'rig.yaml'
        file.write_text(f'base: paper_rig\ncurves: {{{path.stem}: {{file: {path}}}}}\n')
        [curve] = [c for c in load_instrument(file).curves if c.name == path.stem]
        return curve

    return read


@pytest.fixture(scope='session')
def measured_on():
    """Return a function that records what an instrument's sensors see of a motion."""

    def record(
        instrument,
        *effects,
        touching=False,
        trajectory='multisine',
        settings=(('duration', '6 s'), ('amplitude', '5 deg')),
        rate=500.0,
        seed=1,
        without=(),
        name='free',
    ):
        uses = tuple(EffectUse(*effect) for effect in effects)
        contacts = tuple(replace(c, enabled=touching) for c in instrument.contacts)
        rig = replace(instrument, effects=(*instrument.effects, *uses), contacts=contacts)
        motion = chosen_trajectory(trajectory, rig.motor_names, dict(settings))
        run = simulate(rig, motion, rate=rate, seed=seed)
        kept = {s.channel for s in rig.sensors}
        kept |= {f'setpoint/pulley_{driven}/position' for driven in rig.driven}
        kept = {c for c in kept if not c.startswith(tuple(without))}
        channels = {c: values for c, values in run.channels.items() if c in kept}
        return replace(run, name=name, channels=channels)

    return record


@pytest.fixture(scope='session')
def by_voltage():
    """Return a function that gives the recording of a belt by voltage, or its beginning."""
    [run] = import_runs(BY_VOLTAGE, load_mapping(config_path('imports/belt_by_voltage.yaml')))
    return lambda until=math.inf: run.with_channels(
        Channel(c.name, c.time[c.time < until], c.value[c.time < until])
        for c in run.channels.values()
    )


@pytest.fixture(scope='session')
def far_off_belt(by_voltage):
    """Return the first half with a file that is far off, as a problem."""
    return _far_off(by_voltage(10.0))


@pytest.fixture(scope='session')
def far_off_whole_belt(by_voltage):
    """Return all of it with a file that is far off, as a problem."""
    return _far_off(by_voltage())


def _far_off(run):
    belt = as_recorded(load_instrument('belt_by_voltage'), set(run.channels))
    soft = tuple(
        Curve(c.name, c.elongation, tuple(SOFT * t for t in c.tension)) for c in belt.curves
    )
    loops = tuple(replace(loop, pretension=SOFT * loop.pretension) for loop in belt.loops)
    wheels = tuple(
        replace(
            p, damping=SMOOTH * p.damping, inertia=p.inertia * (HEAVY if p.name in MOTORS else 1.0)
        )
        for p in belt.pulleys
    )
    wrong = replace(belt, curves=soft, loops=loops, pulleys=wheels)
    return prepared([run], wrong).problem
