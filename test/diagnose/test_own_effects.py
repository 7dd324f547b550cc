"""Effects that a file has already: what it guesses moves, what it states may be wrong."""

from dataclasses import replace
import math

import pytest

from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument, save_instrument

PLACE = 'pulley_body'
RUBS = 'coulomb_friction'
WIDE = (('duration', '8 s'), ('amplitude', '40 deg'))


def friction(torque):
    """Return Coulomb friction of the body."""
    return (RUBS, PLACE, {'torque': torque})


def having(body, *effects, **tolerances):
    """Return the body's file with effects, and what it says of how well it knows them."""
    stated = {f'{PLACE}.{name.replace("__", ".")}': t for name, t in tolerances.items()}
    uses = tuple(EffectUse(*effect) for effect in effects)
    return replace(body, effects=uses, tolerances={**body.tolerances, **stated})


def size_of(instrument, effect=RUBS):
    """Return the torque of the one effect of this name."""
    [use] = [u for u in instrument.effects if u.effect == effect]
    return use.parameters['torque']


@pytest.fixture(scope='module')
def body():
    """Return one body on a motor."""
    return load_instrument('single_body')


@pytest.fixture(scope='module')
def rubbing(body, measured_on):
    """Return a recording with friction of 0.2 N m, which builds up as in any bearing."""
    bent = ('presliding_friction', PLACE, {'torque': 0.0, 'angle': 1e-3})
    return measured_on(body, friction(0.2), bent, settings=WIDE)


@pytest.fixture(scope='module')
def guessed(body, rubbing, quick):
    """Return what is said where the file guesses a quarter of it."""
    file = having(body, friction(0.05), coulomb_friction__torque=math.inf)
    return quick([rubbing], file)


def test_what_is_guessed_is_found_and_no_cause(guessed):
    assert guessed.diagnosis.verdict == 'no_gap'
    assert size_of(guessed.instrument) == pytest.approx(0.2, rel=0.03)
    [moved] = [m for m in guessed.evidence.moved if m.quantity == 'coulomb_friction.torque']
    assert moved.ci95[0] < 0.2 < moved.ci95[1]


def test_a_repaired_file_can_be_diagnosed_again_and_again(guessed, rubbing, quick, tmp_path):
    path = tmp_path / 'instrument.yaml'
    save_instrument(guessed.instrument, path)
    again = quick([rubbing], load_instrument(path))
    assert again.diagnosis.verdict == 'no_gap'
    save_instrument(again.instrument, path)
    assert size_of(load_instrument(path)) == pytest.approx(0.2, rel=0.03)


@pytest.mark.parametrize('stated', [0.05, 0.5])
def test_an_effect_that_is_stated_wrongly_is_a_cause(body, rubbing, quick, stated, tmp_path):
    outcome = quick([rubbing], having(body, friction(stated)))
    [cause] = outcome.diagnosis.causes
    assert (cause.effect, cause.place) == (RUBS, PLACE)
    low, high = cause.parameters['torque'].ci95
    assert low < 0.2 < high  # all of it, not what the file lacks
    path = tmp_path / 'instrument.yaml'
    save_instrument(outcome.instrument, path)
    assert size_of(load_instrument(path)) == pytest.approx(0.2, rel=0.03)


def test_an_amplitude_is_told_from_what_the_file_says_of_it(body, measured_on, quick):
    true = ('gravity', PLACE, {'torque': 0.3, 'phase': 0.4})
    said = ('gravity', PLACE, {'torque': 0.2, 'phase': -0.2})
    run = measured_on(body, true, settings=WIDE)
    [cause] = quick([run], having(body, said)).diagnosis.causes
    assert (cause.effect, cause.place) == ('gravity', PLACE)
    assert cause.parameters['torque'].value == pytest.approx(0.3, rel=0.1)
    assert cause.parameters['phase'].value == pytest.approx(0.4, abs=0.1)


def test_a_torque_constant_that_an_effect_of_the_file_has_is_moved_there(
    body, measured_on, quick, tmp_path
):
    place = 'motor_' + body.motors[0].name
    run = measured_on(body, ('torque_gain', place, {'gain': 1.3}), settings=WIDE)
    file = replace(body, tolerances={**body.tolerances, f'{place}.torque_gain': math.inf})
    path = tmp_path / 'instrument.yaml'
    for _ in range(2):
        file = quick([run], file).instrument
        save_instrument(file, path)
        file = load_instrument(path)
    [use] = [u for u in file.effects if u.effect == 'torque_gain']
    assert use.parameters['gain'] == pytest.approx(1.3, rel=0.05)
