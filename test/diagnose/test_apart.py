"""Recordings that disagree: which effect was another one in each."""

from dataclasses import replace

import pytest

from tendon_ros.diagnose.apart import apart_words, disagreement
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.identify.candidate import everyone
from tendon_ros.model.instrument_file import load_instrument

WARM = {'first': 1.0, 'second': 0.9, 'third': 0.8}
DAMPED = ('viscous_friction', 'pulley_body', {'damping': 0.02})


@pytest.fixture(scope='module')
def body():
    """Return a driven body."""
    return load_instrument('single_body')


def far(n):
    """Return the settings of one of several motions."""
    return (('duration', '6 s'), ('amplitude', f'{60 + 10 * n} deg'))


def differs(runs, body, cause=None, values=None):
    """Return what is another one in each recording, beside a cause or none."""
    ready = prepared(runs, body)
    asked = everyone(body, sorted(runs[0].channels))
    model = ready.problem.empty
    if cause is not None:
        [own] = [c for c in asked if (c.effect, c.place) == cause]
        model = model.joined(own, values)
    return disagreement(ready, ready.problem.fitted(model), asked, 1.0)


@pytest.fixture(scope='module')
def warm(body, measured_on):
    """Return recordings of a motor that gives less torque from one to the next."""
    return [
        measured_on(
            body, ('torque_gain', 'motor_body', {'gain': gain}), settings=far(n), name=name, seed=n
        )
        for n, (name, gain) in enumerate(WARM.items())
    ]


@pytest.mark.parametrize('cause', [None, ('torque_gain', 'motor_body')])
def test_what_differs_is_told_with_its_size_in_each(warm, body, cause):
    found = differs(warm, body, cause, {'gain': 0.9})
    # of one body, nothing tells half of the torque from twice the angle
    named = {(c.effect, c.place) for c in (found.candidate, *found.alike)}
    assert named == {('torque_gain', 'motor_body'), ('encoder_gain', 'encoder_body')}
    # a common factor is left to the inertia, which the file knows to two per cent
    first = found.values['first']['gain']
    sizes = {name: values['gain'] / first for name, values in found.values.items()}
    assert sizes == pytest.approx(WARM, rel=0.03)
    assert found.goes > 0.9
    words = apart_words(found)
    assert 'torque gain at motor_body' in words
    assert 'encoder gain at encoder_body' in words
    assert ' in third; or ' in words


def test_where_nothing_differs_nothing_is_told(body, measured_on):
    runs = [
        measured_on(body, DAMPED, settings=far(n), name=name, seed=n)
        for n, name in enumerate(WARM)
    ]
    # what is in all of them alike is a cause, and no difference
    assert differs(runs, body) is None
    told = ('viscous_friction', 'pulley_body'), {'damping': 0.02}
    assert differs(runs, body, *told) is None
    assert differs(runs[:1], body) is None


def test_a_zero_that_was_lost_in_between_is_told(bench, measured_on, spoilt):
    runs = [measured_on(bench, name=name, seed=n) for n, name in enumerate(WARM)]
    [runs[1]] = spoilt([runs[1]], 'pulley/pulley_2/position', lambda t, x: (t, x + 0.008))
    found = differs(runs, bench)
    assert (found.candidate.effect, found.candidate.place) == ('encoder_offset', 'encoder_2')
    angles = {name: values['angle'] for name, values in found.values.items()}
    assert angles['second'] - angles['first'] == pytest.approx(0.008, abs=5e-4)
    assert angles['third'] - angles['first'] == pytest.approx(0.0, abs=5e-4)
    assert 'rad in second' in apart_words(replace(found, goes=1.0))
