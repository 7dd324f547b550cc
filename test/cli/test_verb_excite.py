"""``tendon excite`` prints what would separate and writes a trajectory that can be used."""

import argparse
from dataclasses import replace

import pytest

from tendon_ros.base.errors import EffectError, OutputError, RecordingError, TrajectoryError
from tendon_ros.cli import verb_excite
from tendon_ros.diagnose.result import (
    Candidate,
    Cause,
    Diagnosis,
    FittedParameter,
    NextExperiment,
    Shrink,
    Unexplained,
)  # fmt: skip
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.session import simulate
from tendon_ros.model.trajectory_choice import chosen_trajectory


def run(*words):
    """Run the verb as the command line would."""
    parser = argparse.ArgumentParser()
    verb_excite.add_arguments(parser)
    verb_excite.run(parser.parse_args(['--instrument', 'bench_rig', *map(str, words)]))


def fitted(effect, place, name, unit, value, rivals=()):
    parameter = FittedParameter(value=value, unit=unit, ci95=(value, value))
    return Cause(
        effect=effect,
        place=place,
        probability=0.5,
        parameters={name: parameter},
        indistinguishable=rivals,
        shrink=Shrink(channel='x', unit='N', before=3.0, without_this=2.0, after=1.0),
    )


def test_writes_what_simulate_takes(tmp_path, capsys):
    out = tmp_path / 'x.csv'
    run('--separate', 'pretension@cable_m1', 'pretension@cable_12', '--out', out, '--seconds', 12)
    text = capsys.readouterr().out
    assert 'pulley/pulley_1/position' in text
    assert 'never' in text
    rig = load_instrument('bench_rig')
    trajectory = chosen_trajectory(str(out), rig.motor_names)
    assert trajectory.duration == 12.0
    recording = simulate(rig, trajectory)
    assert recording.end - recording.start == pytest.approx(12.0, abs=0.01)


def test_from_a_diagnosis(tmp_path, capsys):
    rival = Candidate(effect='pretension', place='cable_12')
    diagnosis = Diagnosis(
        verdict='explained',
        gap=(),
        where=(),
        causes=(
            fitted('pretension', 'cable_m1', 'scale', '1', 0.85, (rival,)),
            fitted('coulomb_friction', 'pulley_3', 'torque', 'N m', 0.05),
        ),
        candidates=(),
        unexplained=Unexplained(probability=0.1),
    )
    path = tmp_path / 'diagnosis.json'
    path.write_text(diagnosis.model_dump_json(by_alias=True), encoding='utf-8')
    run('--from', path, '--channels', 'motor, load_cell,', '--out', tmp_path / 'x.csv')
    out = capsys.readouterr().out
    assert 'an encoder on pulley 1' in out
    # the load cell was measured, so it is nothing to add
    assert 'load_cell/force' not in out


def test_from_a_diagnosis_that_names_nothing_and_asks(tmp_path, capsys):
    likely = (('pretension', 'cable_m1'), ('pretension', 'cable_12'))
    diagnosis = Diagnosis(
        verdict='unexplained',
        gap=(),
        where=(),
        causes=(),
        candidates=(),
        unexplained=Unexplained(probability=0.9),
        next_experiment=(NextExperiment(separates=likely, do='move'),),
    )
    path = tmp_path / 'diagnosis.json'
    path.write_text(diagnosis.model_dump_json(by_alias=True), encoding='utf-8')
    out = tmp_path / 'x.csv'
    run('--from', path, '--out', out)
    assert 'an encoder on pulley 1' in capsys.readouterr().out
    assert out.exists()
    silent = diagnosis.model_copy(update={'next_experiment': ()})
    path.write_text(silent.model_dump_json(by_alias=True), encoding='utf-8')
    with pytest.raises(EffectError, match='leaves nothing to tell apart'):
        run('--from', path, '--out', tmp_path / 'y.csv')


def test_other_causes_of_a_diagnosis_hold(tmp_path):
    rig = load_instrument('bench_rig')
    diagnosis = Diagnosis(
        verdict='explained',
        gap=(),
        where=(),
        causes=(
            fitted('pretension', 'cable_m1', 'scale', '1', 0.85),
            fitted('coulomb_friction', 'pulley_3', 'torque', 'N m', 0.05),
        ),
        candidates=(),
        unexplained=Unexplained(probability=0.1),
    )
    path = tmp_path / 'diagnosis.json'
    path.write_text(diagnosis.model_dump_json(by_alias=True), encoding='utf-8')
    changed, [((one, values), other)] = verb_excite._asked(rig, ['pretension@cable_m1'], path)
    assert [e.effect for e in changed.effects] == ['coulomb_friction']
    assert (one.effect, values, other) == ('pretension', {'scale': 0.85}, None)


def test_a_cause_stands_instead_of_what_the_file_has(tmp_path):
    plain = load_instrument('bench_rig')
    rubs, damped = ('coulomb_friction', 'pulley_3'), ('viscous_friction', 'pulley_1')
    diagnosis = Diagnosis(
        verdict='explained',
        gap=(),
        where=(),
        causes=(
            fitted(*rubs, 'torque', 'N m', 0.2),
            fitted(*damped, 'damping', 'N m s/rad', 0.1),
        ),
        candidates=(),
        unexplained=Unexplained(probability=0.1),
    )
    path = tmp_path / 'diagnosis.json'
    path.write_text(diagnosis.model_dump_json(by_alias=True), encoding='utf-8')
    file = replace(plain, effects=(EffectUse(*rubs, {'torque': 0.05}),))
    repaired = replace(
        plain, effects=(EffectUse(*rubs, {'torque': 0.2}), EffectUse(*damped, {'damping': 0.1}))
    )
    for rig in (file, repaired):
        changed, [((one, values), _)] = verb_excite._asked(rig, ['@'.join(damped)], path)
        assert changed.effects == (EffectUse(*rubs, {'torque': 0.2}),)
        assert ((one.effect, one.place), values['damping']) == (damped, 0.1)
    # of what the file has of itself, another size is meant
    _, [((one, values), _)] = verb_excite._asked(file, ['@'.join(rubs)], None)
    assert one.use(values).instead
    assert values['torque'] != 0.05


@pytest.mark.parametrize(
    ('words', 'error', 'match'),
    [
        ([], EffectError, 'nothing to tell apart'),
        (['--separate', 'pretension'], EffectError, 'write EFFECT@PLACE'),
        (['--separate', 'pretention@cable_m1'], EffectError, 'no effect'),
        (['--separate', 'pretension@pulley_1'], EffectError, 'cannot act at pulley_1'),
        (['--separate', 'pretension@cable_x'], EffectError, 'no place'),
        (['--separate', 'pretension@cable_12', '--channels', 'x'], RecordingError, "no 'x'"),
        (['--separate', 'pretension@cable_12', '--channels', ''], RecordingError, "no ''"),
        (['--separate', 'pretension@cable_12', '--seconds', '0'], TrajectoryError, '--seconds'),
        (['--separate', 'pretension@cable_12', '--jobs', '-3'], RecordingError, '--jobs -3'),
        (['--from', 'nowhere.json'], RecordingError, 'nowhere.json'),
    ],
)
def test_mistakes(tmp_path, words, error, match):
    with pytest.raises(error, match=match):
        run(*words, '--out', tmp_path / 'x.csv')
    assert not (tmp_path / 'x.csv').exists()


def test_a_file_is_not_replaced(tmp_path):
    out = tmp_path / 'x.csv'
    out.write_text('mine')
    with pytest.raises(OutputError, match='exists'):
        run('--separate', 'pretension@cable_m1', '--out', out)
    assert out.read_text() == 'mine'


def test_where_nothing_can_be_written_nothing_is_computed(tmp_path, monkeypatch):
    (tmp_path / 'file').write_text('')
    monkeypatch.setattr('tendon_ros.identify.excitation.separating', pytest.fail)
    with pytest.raises(OutputError, match='is a file, not a folder'):
        run('--separate', 'pretension@cable_m1', '--out', tmp_path / 'file' / 'x.csv')
