"""Where laws leave much beside guesses, channels weigh by what stays of them."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.base.recording import Channel
from tendon_ros.diagnose import beyond
from tendon_ros.diagnose.beyond import outweighed
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.search import Search
from tendon_ros.identify.candidate import Candidate, everyone
from tendon_ros.model.instrument_file import load_instrument

SETTINGS = (('duration', '6 s'), ('amplitude', '40 deg'))


@pytest.fixture(scope='module')
def axis():
    return load_instrument('driven_axis')


@pytest.fixture(scope='module')
def two(axis):
    """Return two such axes in one file."""

    def named(one):
        return replace(one, name=one.name.replace('axis', 'other'))

    again = tuple(replace(named(m), pulley='other') for m in axis.motors)
    sensors = tuple(
        replace(named(s), of='other', channel=s.channel.replace('axis', 'other'))
        for s in axis.sensors
    )
    guesses = {name.replace('axis', 'other'): by for name, by in axis.tolerances.items()}
    return replace(
        axis,
        pulleys=(*axis.pulleys, *map(named, axis.pulleys)),
        motors=(*axis.motors, *again),
        sensors=(*axis.sensors, *sensors),
        tolerances={**axis.tolerances, **guesses},
    )


@pytest.fixture(scope='module')
def recorded(measured_on):
    """Return what records a rig of which each body is lighter than guessed, and rubs."""

    def record(instrument):
        light = tuple(replace(p, inertia=0.5 * p.inertia) for p in instrument.pulleys)
        friction = [
            ('coulomb_friction', f'pulley_{p.name}', {'torque': 0.2}) for p in instrument.pulleys
        ]
        return measured_on(replace(instrument, pulleys=light), *friction, settings=SETTINGS)

    return record


@pytest.fixture(scope='module')
def run(two, recorded):
    return recorded(two)


def wavering(run):
    """Return a recording with torques that follow the time, and nothing that moves."""
    efforts = [c for name, c in run.channels.items() if name.endswith('effort')]
    return run.with_channels(
        [Channel(c.name, c.time, c.value + 0.05 * np.sin(1.2 * c.time)) for c in efforts]
    )


def searched(ready, instrument, run):
    return Search(ready.problem, everyone(instrument, sorted(run.channels)), 1).run()


def test_what_laws_explain_weighs_by_its_noise(two, run):
    found = searched(prepared([run], two), two, run)
    assert found.unweighed is None
    assert {c.effect for c in found.final.model.causes} == {'coulomb_friction'}


def test_what_no_law_explains_asks_for_other_weights_once(two, run):
    other = wavering(run)
    ready = prepared([other], two)
    first = searched(ready, two, other)
    assert first.unweighed is not None
    weighed = ready.weighed(first.unweighed.model)
    again = searched(weighed, two, other)
    assert again.unweighed is None
    assert ('coulomb_friction', 'pulley_axis') in {
        (c.effect, c.place) for c in again.final.model.causes
    }


def test_one_channel_has_none_to_be_weighed_against(axis, two, recorded):
    def asked(instrument):
        problem = prepared([wavering(recorded(instrument))], instrument).problem
        model = problem.empty
        for body in instrument.pulleys:
            rubs = Candidate('coulomb_friction', f'pulley_{body.name}')
            model = model.joined(rubs, {'torque': 0.2})
        return outweighed(problem, problem.fitted(problem.empty), problem.fitted(model))

    assert asked(two)
    assert not asked(axis)


@pytest.mark.parametrize(('times', 'drowned'), [(0.5, True), (2.0, False)])
def test_noise_is_no_weight_where_much_more_stays(two, run, monkeypatch, times, drowned):
    """However wrong laws may be."""
    monkeypatch.setattr(beyond, 'MACHINE', np.inf)
    problem = prepared([wavering(run)], two).problem
    start = problem.fitted(problem.empty)
    stays = problem.structured(start.left)
    assert stays > 1.0
    monkeypatch.setattr(beyond, 'DROWNED', times * stays)
    assert outweighed(problem, start, start) is drowned
