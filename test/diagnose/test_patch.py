"""The instrument file that a diagnosis writes: whatever was found, it can be written and read."""

from dataclasses import replace
import math

import numpy as np
import pytest

from tendon_ros.diagnose.patch import patched
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.identify.candidate import everyone
from tendon_ros.identify.tolerance import tolerances
from tendon_ros.model.instrument_file import load_instrument, save_instrument


@pytest.fixture(scope='module')
def problem(bench, measured_on):
    """Return a problem on the bench."""
    return prepared([measured_on(bench, seed=4)], bench).problem


def found_at(instrument):
    """Return every candidate of an instrument with all sensors, of each effect and kind one."""
    every = everyone(instrument, [s.channel for s in instrument.sensors], ())
    return {(c.effect, c.place.partition('_')[0]): c for c in every}


@pytest.mark.parametrize('rig', ['bench_rig', 'davinci_grasper'])
def test_every_effect_can_be_written(problem, rig, tmp_path):
    instrument = load_instrument(rig)
    candidates = found_at(instrument)
    assert any(c.place.startswith('coupling_') for c in candidates.values()) == (
        rig == 'davinci_grasper'
    )
    for candidate in candidates.values():
        size = {p.name: p.typical for p in candidate.parameters}
        model = problem.empty.joined(candidate, size)
        found = patched(problem, model, instrument, next(iter(candidate.instants), ''))
        save_instrument(found, tmp_path / 'found.yaml')
        assert load_instrument(tmp_path / 'found.yaml') == found


def test_the_damping_of_a_wall_is_found_where_the_file_says_nothing(bench, measured_on, tmp_path):
    [contact] = bench.contacts
    soft = replace(contact, stiffness=4e3, damping=0.0)
    damped = replace(soft, damping=2e-3 * soft.stiffness)
    far = (('duration', '6 s'), ('amplitude', '15 deg'))
    recording = measured_on(replace(bench, contacts=(damped,)), touching=True, settings=far)
    silent = replace(bench, contacts=(soft,))
    problem = prepared([recording], silent).problem
    found = patched(problem, problem.fitted(problem.empty).model, silent)
    assert found.contacts[0].damping == pytest.approx(damped.damping, rel=0.2)
    # a file that calls it a guess is written as one that does
    guess = replace(found, tolerances={'contact.damping': math.inf})
    save_instrument(guess, tmp_path / 'guess.yaml')
    assert 'guessed' in (tmp_path / 'guess.yaml').read_text()
    assert load_instrument(tmp_path / 'guess.yaml') == guess


def test_a_tolerance_of_what_became_nothing_is_left_out(problem, bench, tmp_path):
    known = replace(bench, tolerances={'pulley_1.damping': 0.5, 'pulley_2.damping': math.inf})
    wide = problem.toleranced(tolerances(known))
    damping = known.pulleys[known.index('1')].damping
    [at] = [
        n
        for n, t in enumerate(wide.tolerances)
        if (t.place, t.quantity) == ('pulley_1', 'damping')
    ]
    moved = np.zeros(len(wide.tolerances))
    moved[at] = -damping / wide.tolerances[at].axis.scale
    model = replace(wide.empty, moved=moved)
    found = patched(wide, model, known)
    assert found.pulleys[found.index('1')].damping == 0.0
    assert found.tolerances == {'pulley_2.damping': math.inf}
    save_instrument(found, tmp_path / 'found.yaml')
    assert load_instrument(tmp_path / 'found.yaml') == found
