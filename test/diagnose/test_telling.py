"""Which recording tells a cause: the one in which it shows, with an interval that holds it."""

import pytest

from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.telling import told
from tendon_ros.identify.candidate import Candidate
from tendon_ros.model.instrument_file import load_instrument

DAMPED = ('viscous_friction', 'pulley_body', {'damping': 0.02})
MOTIONS = {'fast': '40 deg', 'slow': '0.6 deg'}


@pytest.fixture(scope='module')
def rows(measured_on):
    """Return what a fast and a slow recording of a damped body say of its damping."""
    body = load_instrument('single_body')
    runs = [
        measured_on(body, DAMPED, settings=(('duration', '6 s'), ('amplitude', by)), name=name)
        for name, by in MOTIONS.items()
    ]
    problem = prepared(runs, body).problem
    damping = Candidate('viscous_friction', 'pulley_body')
    fit = problem.fitted(problem.empty.joined(damping, {'damping': 0.01}))
    return {t.recording: t for t in told(problem, fit)}


def test_the_fast_one_tells_it(rows):
    assert list(rows) == ['fast', 'slow']
    fast = rows['fast']
    assert fast.why == ''
    assert fast.ci95[0] < 0.02 < fast.ci95[1]
    assert fast.value == pytest.approx(0.02, rel=0.05)


def test_the_slow_one_does_not_and_says_why(rows):
    slow = rows['slow']
    assert slow.why in {'no trace', 'others do the same'}
    assert slow.ci95[1] - slow.ci95[0] > rows['fast'].ci95[1] - rows['fast'].ci95[0]
