"""Events happen in one recording; what lasts is there in all of them."""

from dataclasses import replace

import pytest

from tendon_ros.model.instrument_file import load_instrument

PUSH = ('disturbance', 'pulley_body', {'torque': 0.3, 'start': 3.0, 'duration': 0.5})
MOTION = (('duration', '8 s'), ('amplitude', '30 deg'))


@pytest.fixture(scope='module')
def outcome(measured_on, quick):
    """Return what is said of two runs of which somebody pushed in one."""
    body = load_instrument('single_body')
    pushed = measured_on(body, PUSH, settings=MOTION, name='pushed')
    left_alone = measured_on(body, settings=MOTION, name='left_alone', seed=2)
    # nobody wrote into the bag that somebody pushed
    return quick([left_alone, replace(pushed, metadata=left_alone.metadata)], body)


def test_the_recording_and_the_time_are_told(outcome):
    [cause] = outcome.diagnosis.causes
    assert (cause.effect, cause.place, cause.recording) == (
        'disturbance', 'pulley_body', 'pushed',
    )  # fmt: skip
    assert cause.parameters['start'].value == pytest.approx(3.0, abs=0.05)
    assert cause.parameters['torque'].value == pytest.approx(0.3, rel=0.1)
    assert outcome.diagnosis.verdict == 'explained'


def test_the_instrument_does_not_keep_what_happened_once(outcome):
    assert not any(use.effect == 'disturbance' for use in outcome.instrument.effects)


def test_the_page_tells_it_too(outcome):
    from tendon_ros.report.diagnosis_page import diagnosis_page
    from tendon_ros.report.diagnosis_text import summary

    assert 'in pushed alone' in ' '.join(summary(outcome.diagnosis).split())
    assert 'in pushed alone' in diagnosis_page(outcome.diagnosis, outcome.evidence)
