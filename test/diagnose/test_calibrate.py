"""Calibration: what was found on one machine, fitted to another of its kind."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.base.errors import RecordingError
from tendon_ros.base.recording import Channel
from tendon_ros.diagnose.calibrate import calibrate
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument, save_instrument
from tendon_ros.report.calibration_text import calibration_text

SAME = ('coulomb_friction', 'pulley_3', {'torque': 0.1})
WAS = ('encoder_gain', 'encoder_1', {'gain': 1.03})
IS = ('encoder_gain', 'encoder_1', {'gain': 0.98})


@pytest.fixture(scope='module')
def found(bench, measured_on):
    """Return the calibration of a second machine to what the first one's file says."""
    file = replace(bench, effects=(EffectUse(*SAME), EffectUse(*WAS)))
    return calibrate([measured_on(bench, SAME, IS)], file)


def test_what_is_the_same_carries_over_and_what_differs_is_found(found):
    rows = {(p.effect, p.parameter): p for p in found.parameters}
    friction, scale = rows['coulomb_friction', 'torque'], rows['encoder_gain', 'gain']
    assert friction.holds
    assert not scale.holds
    assert scale.before == 1.03
    assert scale.low <= 0.98 <= scale.high
    assert scale.after == pytest.approx(0.98, abs=2e-3)


def test_the_calibrated_file_closes_the_gap(found, tmp_path):
    before, after = found.misfit
    assert before > 3.0
    assert after < 1.3
    save_instrument(found.instrument, tmp_path / 'other.yaml')
    written = load_instrument(tmp_path / 'other.yaml')
    gains = [e.parameters['gain'] for e in written.effects if e.effect == 'encoder_gain']
    assert gains == [pytest.approx(0.98, abs=2e-3)]


def test_the_seconds_that_it_takes_are_found(found):
    assert [b.seconds for b in found.beginnings] == [1.0, 2.0, 4.0]
    assert found.needed in (1.0, 2.0, 4.0)
    late = found.beginnings[-1].misfit
    assert late <= 1.1 * found.misfit[1]


def test_the_text_says_all_of_it(found):
    text = calibration_text(found)
    assert 'carried over    Coulomb friction on pulley 3: torque' in text
    assert 'differs here    Encoder 1 gain: gain 0.9' in text
    assert 'the file: 1.03' in text
    assert 'are as good as all of it' in text


def test_a_log_that_was_rounded_is_no_misfit(bench, measured_on):
    run = measured_on(bench)
    own = run['actuator/pulley_M/position']
    coarse = Channel(own.name, own.time, np.round(own.value / 2e-3) * 2e-3)
    rounded = replace(run, channels={**run.channels, own.name: coarse})
    calibrated = calibrate([rounded], bench)
    assert any('come in steps of 0.002 rad' in said for said in calibrated.left_out)
    assert calibrated.misfit[1] < 1.3
    # the encoder is what the file says: the log was rounded
    assert [s.resolution for s in calibrated.instrument.sensors] == [
        s.resolution for s in bench.sensors
    ]


def test_a_file_with_nothing_to_fit_is_refused(bench, measured_on):
    known = {
        f'{kind}_{x.name}.{quantity}': 0.0
        for kind, group, quantities in (
            ('pulley', bench.pulleys, ('inertia', 'damping')),
            ('cable', bench.loops, ('pretension', 'stiffness')),
        )
        for x in group
        for quantity in quantities
    }
    known['contact.stiffness'] = 0.0
    with pytest.raises(RecordingError, match='nothing to calibrate'):
        calibrate([measured_on(bench)], replace(bench, tolerances=known))
