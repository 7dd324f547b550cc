"""What a logger makes of a sound sensor is used, and no fault of it."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.diagnose.logged import is_logged, logged_words
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.diagnose.session import diagnose
from tendon_ros.identify.candidate import Candidate

INNER = 'pulley/pulley_2/position'
COUNT = 2.0 * np.pi / 16384
ZERO = Candidate('encoder_offset', 'encoder_2')


@pytest.mark.parametrize(('counts', 'loggers'), [(0.6, True), (-0.6, True), (3.0, False)])
def test_an_angle_that_is_off_within_a_count_is_no_fault(bench, measured_on, counts, loggers):
    problem = prepared([measured_on(bench)], bench).problem
    assert is_logged(problem, ZERO, {'angle': counts * COUNT}) is loggers
    model = problem.empty.joined(ZERO, {'angle': counts * COUNT})
    words = logged_words(model, [0])
    assert words.startswith(f'encoder_2 reads {1e3 * counts * COUNT:.2g} mrad off, within a count')


@pytest.mark.parametrize('counts', [-0.6, -6.0])
def test_a_counter_that_cuts_off_is_told_and_not_named(bench, measured_on, counts):
    run = measured_on(bench)
    off = replace(run[INNER], value=run[INNER].value + counts * COUNT)
    told = diagnose([run.with_channels([off])], bench, jobs=1, plan=False).diagnosis
    named = [(c.effect, c.place) for c in told.causes]
    assert named == ([] if counts > -1.0 else [(ZERO.effect, ZERO.place)])
    assert told.verdict == ('no_gap' if counts > -1.0 else 'explained')
