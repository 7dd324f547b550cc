"""Where laws leave much beside guesses, channels weigh by what stays of them."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.base.recording import Channel
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.search import Search
from tendon_ros.identify.candidate import everyone
from tendon_ros.model.instrument_file import load_instrument

EFFORT = 'actuator/pulley_axis/effort'


@pytest.fixture(scope='module')
def axis():
    return load_instrument('driven_axis')


@pytest.fixture(scope='module')
def run(axis, measured_on):
    """Return a recording of an axis that is lighter than guessed, and rubs."""
    light = tuple(replace(p, inertia=0.5 * p.inertia) for p in axis.pulleys)
    friction = ('coulomb_friction', 'pulley_axis', {'torque': 0.2})
    settings = (('duration', '6 s'), ('amplitude', '40 deg'))
    return measured_on(replace(axis, pulleys=light), friction, settings=settings)


def searched(ready, axis, run):
    return Search(ready.problem, everyone(axis, sorted(run.channels)), 1).run()


def test_what_laws_explain_weighs_by_its_noise(axis, run):
    found = searched(prepared([run], axis), axis, run)
    assert found.unweighed is None
    assert [c.effect for c in found.final.model.causes] == ['coulomb_friction']


def test_what_no_law_explains_asks_for_other_weights_once(axis, run):
    effort = run[EFFORT]
    # a torque that follows the time, and nothing that moves
    more = effort.value + 0.05 * np.sin(1.2 * effort.time)
    other = run.with_channels([Channel(EFFORT, effort.time, more)])
    ready = prepared([other], axis)
    first = searched(ready, axis, other)
    assert first.unweighed is not None
    weighed = ready.weighed(first.unweighed.model)
    again = searched(weighed, axis, other)
    assert again.unweighed is None
    assert ('coulomb_friction', 'pulley_axis') in {
        (c.effect, c.place) for c in again.final.model.causes
    }
