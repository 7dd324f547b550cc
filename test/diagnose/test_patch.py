"""The instrument file that a diagnosis writes: whatever was found, it can be written and read."""

import pytest

from tendon_ros.diagnose.patch import patched
from tendon_ros.diagnose.prepare import prepared
from tendon_ros.identify.candidate import everyone
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
