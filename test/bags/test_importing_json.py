"""JSON files as recordings: samples as objects, columns as lists, registers without their sign."""

import json
import math

import numpy as np
import pytest

from tendon_ros.bags.importing import import_runs
from tendon_ros.bags.mapping import Mapping
from tendon_ros.base.errors import RecordingError

TIMES = [0.01 * n for n in range(50)]
ANGLES = [round(math.sin(t), 6) for t in TIMES]
LOADS = [round(100.0 * math.cos(9.0 * t)) for t in TIMES]


def mapped(**load):
    return Mapping.model_validate(
        {
            'format': 'json',
            'time': {'column': 't', 'unit': 's'},
            'channels': {
                'actuator/pulley_arm/position': {'column': 'angle', 'unit': 'rad'},
                'actuator/pulley_arm/effort': {'column': 'load', 'unit': '0.01 N m', **load},
            },
        }
    )


def written(folder, document):
    path = folder / 'run.json'
    path.write_text(json.dumps(document), encoding='utf-8')
    return path


def samples():
    return [
        {'t': t, 'angle': a, 'load': n, 'on': True, 'mode': 'swing'}
        for t, a, n in zip(TIMES, ANGLES, LOADS, strict=True)
    ]


@pytest.mark.parametrize(
    'document',
    [
        samples(),
        {'motor': 'any', 'gains': [1, 2, 3], 'entries': samples()},
        {'kp': 3, 't': TIMES, 'angle': ANGLES, 'load': LOADS, 'gains': [1, 2]},
    ],
    ids=['list', 'under a name', 'columns'],
)
def test_samples_and_columns(tmp_path, document):
    [run] = import_runs(written(tmp_path, document), mapped())
    assert run.name == 'run'
    assert run['actuator/pulley_arm/position'].value == pytest.approx(ANGLES)
    assert run['actuator/pulley_arm/effort'].value == pytest.approx(0.01 * np.array(LOADS))


def test_a_register_gets_its_sign_back(tmp_path):
    raw = [{**s, 'load': s['load'] % 65536} for s in samples()]
    [run] = import_runs(written(tmp_path, raw), mapped(bits=16))
    assert run['actuator/pulley_arm/effort'].value == pytest.approx(0.01 * np.array(LOADS))


def test_what_was_not_taken_is_left_out(tmp_path):
    raw = samples()
    del raw[3]['load']
    raw[4]['load'] = None
    [run] = import_runs(written(tmp_path, raw), mapped())
    assert len(run['actuator/pulley_arm/effort'].time) == len(TIMES) - 2
    assert len(run['actuator/pulley_arm/position'].time) == len(TIMES)


@pytest.mark.parametrize(
    ('document', 'says'),
    [
        ({'motor': 'any'}, 'no list of samples'),
        ([1.0, 2.0], 'no list of samples'),
        ([{'t': 0.0, 'angle': 1.0}], "no column 'load'"),
        ([{**s, 'load': 'high'} for s in samples()], "'high' is not a number"),
    ],
)
def test_what_is_no_recording(tmp_path, document, says):
    with pytest.raises(RecordingError) as caught:
        list(import_runs(written(tmp_path, document), mapped()))
    assert says in str(caught.value)


def test_a_cut_file_names_itself(tmp_path):
    path = written(tmp_path, samples())
    path.write_text(path.read_text(encoding='utf-8')[:-20], encoding='utf-8')
    with pytest.raises(RecordingError, match=r'run\.json: not readable as json'):
        list(import_runs(path, mapped()))


def test_one_file_is_one_run():
    with pytest.raises(ValueError, match='a JSON file is one run'):
        Mapping.model_validate({**mapped().model_dump(), 'runs': {'include': '*'}})


def test_a_number_beyond_all_bounds_matters_only_where_it_is_mapped(tmp_path):
    huge = [{**sample, 'id': 10**400} for sample in samples()]
    [run] = import_runs(written(tmp_path, huge), mapped())
    assert run['actuator/pulley_arm/position'].value == pytest.approx(ANGLES)
    huge[3]['load'] = 10**400
    with pytest.raises(RecordingError, match='sample 3, load: too large a number; mend it'):
        list(import_runs(written(tmp_path, huge), mapped()))
