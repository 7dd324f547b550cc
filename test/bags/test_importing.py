"""Foreign files become recordings; mistakes in them or in the mapping are one clear line."""

import numpy as np
import pytest
import scipy.io
import yaml

from tendon_ros.bags.export import export_csv
from tendon_ros.bags.importing import import_runs, run_keys
from tendon_ros.bags.mapping import load_mapping
from tendon_ros.bags.reader import read_recording
from tendon_ros.bags.tables import read_tables
from tendon_ros.bags.writer import write_recording
from tendon_ros.base.errors import RecordingError

N = 40
TIME = np.arange(N) * 1e-3
COUNTS = np.arange(N) * 10.0

MAPPING = {
    'format': 'npz',
    'runs': {'include': '[0-9]', 'header': 'hdr_{key}'},
    'time': {'column': 0, 'unit': 's'},
    'channels': {
        'actuator/pulley_motor/position': {
            'column': 1,
            'unit': 'turn / 4096',
            'scale': 2.0,
            'sign': -1,
            'offset': 0.5,
        },
        'load_cell/force': {'column': 2, 'unit': 'gram_force'},
    },
    'metadata': {'tool': 'T5'},
    'attribution': 'us',
    'licence': 'ODbL 1.0',
}


def changed(**fields):
    """Return the mapping with some fields replaced, or removed where None."""
    return {k: v for k, v in {**MAPPING, **fields}.items() if v is not None}


def mapping_file(tmp_path, data):
    path = tmp_path / 'map.yaml'
    path.write_text(data if isinstance(data, str) else yaml.safe_dump(data))
    return path


def imported(tmp_path, file, data, select=()):
    return list(import_runs(file, load_mapping(mapping_file(tmp_path, data)), select))


@pytest.fixture
def npz(tmp_path):
    path = tmp_path / 'runs.npz'
    table = np.stack([TIME, COUNTS, COUNTS], axis=1)
    np.savez(path, **{'1': table, '2': table[:20], 'hdr_1': 'first run', 'notes': 'no run'})
    return path


def expected():
    return -2.0 * COUNTS * 2 * np.pi / 4096 + 0.5


def test_runs_of_an_npz(npz, tmp_path):
    one, two = imported(tmp_path, npz, MAPPING)
    assert (one.name, two.name) == ('1', '2')
    position = one['actuator/pulley_motor/position']
    np.testing.assert_allclose(position.value, expected(), rtol=1e-14)
    np.testing.assert_array_equal(position.time, np.round(TIME, 9))
    np.testing.assert_allclose(one['load_cell/force'].value, COUNTS * 9.80665e-3, rtol=1e-14)
    assert two['load_cell/force'].value.size == 20
    assert one.metadata['source_header'] == 'first run'
    assert one.metadata['licence'] == 'ODbL 1.0'
    assert one.metadata['attribution'] == 'us'
    assert 'source_header' not in two.metadata
    assert one.epoch_ns == 10**9
    assert one.warnings == ()


def test_an_import_survives_the_bag_bit_for_bit(npz, tmp_path):
    (run,) = imported(tmp_path, npz, MAPPING, ['1'])
    back = read_recording(write_recording(run, tmp_path / 'bag'))
    for name, channel in run.channels.items():
        np.testing.assert_array_equal(back[name].time, channel.time)
        np.testing.assert_array_equal(back[name].value, channel.value)
    assert back.metadata['tool'] == 'T5'


def test_selected_runs(npz, tmp_path):
    mapping = load_mapping(mapping_file(tmp_path, MAPPING))
    assert run_keys(npz, mapping) == ['1', '2']
    assert [r.name for r in import_runs(npz, mapping, ['2'])] == ['2']
    with pytest.raises(RecordingError, match=r'no run 7; it has 1, 2'):
        list(import_runs(npz, mapping, ['7']))


BY_NAME = {
    'time': {'column': 't', 'unit': 'ms'},
    'runs': None,
    'channels': {
        'actuator/pulley_motor/position': {
            **MAPPING['channels']['actuator/pulley_motor/position'],
            'column': 'motor',
        }
    },
}


@pytest.mark.parametrize('kind', ['npz', 'csv', 'mat'])
def test_columns_by_name(tmp_path, kind):
    columns = {'t': TIME * 1e3, 'motor': COUNTS, 'gain': np.array([3.0])}
    path = tmp_path / f'one.{kind}'
    if kind == 'npz':
        np.savez(path, **{name: column[:, None] for name, column in columns.items()})
    elif kind == 'mat':
        scipy.io.savemat(path, columns)
    else:
        rows = '\n'.join(
            f'{a!r},{b!r}'
            for a, b in zip(*(columns[k].tolist() for k in ('t', 'motor')), strict=True)
        )
        path.write_text(f'# a comment\nt, motor\n{rows}\n')
    (run,) = imported(tmp_path, path, changed(format=kind, **BY_NAME))
    np.testing.assert_allclose(run['actuator/pulley_motor/position'].value, expected(), rtol=1e-14)
    np.testing.assert_allclose(run['actuator/pulley_motor/position'].time, TIME, atol=1e-12)


def test_signals_that_are_shorter_than_something_else_are_told(tmp_path):
    np.savez(tmp_path / 'x.npz', t=TIME * 1e3, motor=COUNTS, table=np.arange(3.0 * N))
    with pytest.raises(RecordingError, match=rf't has {N} numbers, and the longest array {3 * N}'):
        imported(tmp_path, tmp_path / 'x.npz', changed(format='npz', **BY_NAME))


def test_runs_of_a_mat_file(tmp_path):
    scipy.io.savemat(tmp_path / 'x.mat', {'run1': np.stack([TIME, COUNTS, COUNTS], axis=1)})
    data = changed(format='mat', runs={'include': 'run*'})
    (run,) = imported(tmp_path, tmp_path / 'x.mat', data)
    np.testing.assert_allclose(run['actuator/pulley_motor/position'].value, expected(), rtol=1e-14)


def test_a_csv_without_names_and_a_rate(tmp_path):
    np.savetxt(tmp_path / 'x.csv', np.stack([COUNTS, COUNTS], axis=1), delimiter=',')
    channel = {**MAPPING['channels']['actuator/pulley_motor/position'], 'column': 1}
    data = changed(
        format='csv',
        runs=None,
        time={'rate': '1 kHz'},
        channels={'actuator/pulley_motor/position': channel},
        epoch='2020-01-01T00:00:00Z',
    )
    (run,) = imported(tmp_path, tmp_path / 'x.csv', data)
    np.testing.assert_allclose(run['actuator/pulley_motor/position'].time, TIME, atol=1e-12)
    assert run.epoch_ns == 1_577_836_800 * 10**9


@pytest.mark.parametrize(
    'text',
    [
        '0,1.5,\n0.1,2.5,3\n',
        ',1.5,2\n0.1,2.5,3\n',
        '0,000;1,5000;2,0000\n0,100;2,5000;3,0000\n',
        '0,000\t1,5000\t2,0000\n0,100\t2,5000\t3,0000\n',
        '0\t1.5\t2\n0.1\t2.5\t3\n',
        '0.0,1.5,2\n0.1,2.5,3\n',
    ],
)
def test_a_first_row_without_names_is_a_sample(tmp_path, text):
    (tmp_path / 'x.csv').write_text(text)
    table = read_tables(tmp_path / 'x.csv', 'csv', None)['x']()
    assert list(table.columns) == ['0', '1', '2']
    assert table.columns['1'].tolist() == [1.5, 2.5]


@pytest.mark.parametrize('text', ['t,p; q\n0,1\n1,2\n', '"t;";"p; q"\n0;1\n1;2\n', 't\n0\n1\n'])
def test_names_may_hold_what_stands_between_cells_elsewhere(tmp_path, text):
    (tmp_path / 'x.csv').write_text(text)
    table = read_tables(tmp_path / 'x.csv', 'csv', None)['x']()
    assert table.names[1:] in (('p; q',), ())
    assert table.columns[table.names[0]].tolist() == [0.0, 1.0]


def test_our_own_export_imports(npz, tmp_path):
    (run,) = imported(tmp_path, npz, MAPPING, ['1'])
    export_csv(run, tmp_path / 'x.csv')
    channels = {
        c.name: {'column': f'{c.name} [{c.unit}]', 'unit': c.unit} for c in run.channels.values()
    }
    data = changed(format='csv', runs=None, time={'column': 'time [s]'}, channels=channels)
    (back,) = imported(tmp_path, tmp_path / 'x.csv', data)
    for name, channel in run.channels.items():
        np.testing.assert_array_equal(back[name].time, channel.time)
        np.testing.assert_array_equal(back[name].value, channel.value)


def test_bad_time_and_nan_are_left_out_and_told(tmp_path):
    table = np.stack([TIME, COUNTS, COUNTS], axis=1)
    table[5, 0] = table[4, 0]
    table[8, 0] = table[2, 0]
    table[11, 0] = np.nan
    table[20, 1] = np.nan
    table[30:, 0] += 0.5
    np.savez(tmp_path / 'x.npz', **{'1': table})
    (run,) = imported(tmp_path, tmp_path / 'x.npz', MAPPING)
    assert run['load_cell/force'].value.size == N - 3
    assert run['actuator/pulley_motor/position'].value.size == N - 4
    time, jitter, value = run.warnings
    assert '3 of 40 rows left out' in time
    assert 'first row 6 of the data' in time
    assert '4 of 36 intervals' in jitter
    assert 'actuator/pulley_motor/position' in value
    assert 'first row 21 of the data' in value


def test_one_wild_stamp_costs_one_row(tmp_path):
    table = np.stack([TIME, COUNTS, COUNTS], axis=1)
    table[10, 0] = 1e6
    np.savez(tmp_path / 'x.npz', **{'1': table})
    (run,) = imported(tmp_path, tmp_path / 'x.npz', MAPPING)
    assert np.array_equal(run['load_cell/force'].time, np.delete(np.round(TIME, 9), 10))
    assert '1 of 40 rows left out' in run.warnings[0]
    assert 'first row 11 of the data' in run.warnings[0]


def test_stamps_that_no_clock_gives_name_the_unit(tmp_path):
    table = np.stack([1.7e18 + 1e6 * np.arange(N), COUNTS, COUNTS], axis=1)
    np.savez(tmp_path / 'x.npz', **{'1': table})
    with pytest.raises(RecordingError, match=r'reaches 1\.7e\+18 s, .* years; say the unit'):
        imported(tmp_path, tmp_path / 'x.npz', MAPPING)


LABVIEW = 3.8e9 + 0.25 * np.arange(N)  # seconds since 1904, in 2024


def labview_file(tmp_path, time=LABVIEW):
    np.savez(tmp_path / 'x.npz', **{'1': np.stack([time, COUNTS, COUNTS], axis=1)})
    return tmp_path / 'x.npz'


def test_stamps_that_ros_has_no_room_for_name_the_epoch(tmp_path):
    with pytest.raises(RecordingError, match=r'reaches the year 2090, .* epoch.* 1904-01-01'):
        imported(tmp_path, labview_file(tmp_path), MAPPING)
    early = changed(epoch='1904-01-01')
    with pytest.raises(RecordingError, match=r'run 1: its time reaches the year 1904, .* epoch'):
        imported(tmp_path, labview_file(tmp_path, TIME), early)


def test_stamps_since_1904_are_those_of_today(tmp_path):
    (run,) = imported(tmp_path, labview_file(tmp_path), changed(epoch='1904-01-01'))
    back = read_recording(write_recording(run, tmp_path / 'bag'))
    for one in (run, back):
        np.testing.assert_allclose(one['load_cell/force'].time, LABVIEW, rtol=0.0, atol=1e-6)
        assert one.epoch_ns == -2_082_844_800 * 10**9


def test_a_wild_stamp_beyond_2038_costs_one_row(tmp_path):
    time = TIME.copy()
    time[10] = 3e9
    (run,) = imported(tmp_path, labview_file(tmp_path, time), MAPPING)
    assert run['load_cell/force'].value.size == N - 1


def test_a_column_of_nan_is_unmeasured(tmp_path):
    table = np.stack([TIME, COUNTS, COUNTS * np.nan], axis=1)
    np.savez(tmp_path / 'x.npz', **{'1': table})
    (run,) = imported(tmp_path, tmp_path / 'x.npz', MAPPING)
    assert set(run.channels) == {'actuator/pulley_motor/position'}
    assert 'unmeasured' in run.warnings[0]


POSITION = MAPPING['channels']['actuator/pulley_motor/position']


def with_position(**fields):
    return changed(channels={'actuator/pulley_motor/position': {**POSITION, **fields}})


def with_effort(**fields):
    return changed(channels={'actuator/pulley_motor/effort': {'column': 1, **fields}})


@pytest.mark.parametrize(
    ('data', 'words'),
    [
        ('', 'needs format'),
        ('a: [', 'not YAML'),
        (changed(format='hdf5'), 'format'),
        (changed(format=None), 'format: missing'),
        (changed(colour='red'), 'colour: unknown field; use attribution, channels'),
        (changed(time={'column': 0, 'units': 's'}), 'time.units: unknown field; use column, rate'),
        (changed(time={'column': 0, 'unit': 'N'}), 'time.unit'),
        (changed(time={}), 'either a column or a rate'),
        (changed(time={'column': 0, 'rate': '1 Hz'}), 'either a column or a rate'),
        (changed(time={'rate': '-5 Hz'}), 'negative'),
        (changed(time={'rate': '5 m'}), 'is not in Hz'),
        (changed(time={'rate': 1000}), "write a rate such as '1 kHz'"),
        (changed(time={'rate': '6000 rpm'}), 'its angle has no place there'),
        (changed(channels={}), 'channels'),
        (changed(channels={'motor/position': POSITION}), 'no topic carries it'),
        (changed(channels={'load_cell/force': {'column': 1, 'unit': 'N'}}), 'of the motors'),
        (with_position(unit='count'), 'names no angle'),
        (with_position(unit='N m'), 'is not in rad'),
        (
            with_position(unit='nonsense'),
            "does not exist, 'nonsense'; write what one of the number is, such as 'turn",
        ),
        (with_position(unit='mm'), "let 1 rad stand for 1 m): write 'mm * rad/m'"),
        (with_effort(unit='N m/deg'), 'its angle has no place there'),
        ('format: csv\ntime: {rate: 1 Hz}\nformat: npz\n', 'line 3: format: is given twice'),
        ('time: {rate: 1 Hz, rate: 2 Hz}\n', 'line 1: rate: is given twice'),
        ('[a]: b\n', 'line 1: a key is not plain text'),
        (with_position(sign=2), 'sign'),
        (with_position(scale=0), 'must not be 0'),
        (with_position(scale='fast'), 'scale'),
        (with_position(offset=float('nan')), 'offset'),
        (with_position(offset='-180 N'), "actuator/pulley_motor/position.offset: '-180 N' is not"),
        (with_position(column=-1), 'column'),
        (with_position(column=None), 'column'),
        (with_position(factor=3), 'factor: unknown field; use bits, column, offset'),
        (with_position(time={'colum': 1}), 'time.colum: unknown field; use column, rate, unit'),
        (changed(runs={'header': 'hdr'}), 'must hold {key}'),
        (changed(format='csv'), 'a CSV file is one run'),
        (changed(epoch='yesterday'), 'epoch'),
        (changed(epoch='1601-01-01'), 'epoch: must lie in the years 1700 to 2037'),
        (changed(epoch='2038-01-01'), 'epoch: must lie in the years 1700 to 2037'),
        (changed(metadata={'seed': 3}), 'metadata.seed'),
    ],
)
def test_a_mistake_in_the_mapping_is_one_line(tmp_path, data, words):
    path = mapping_file(tmp_path, data)
    with pytest.raises(RecordingError) as caught:
        load_mapping(path)
    message = str(caught.value)
    assert message.startswith(f'{path}: ')
    assert words in message
    assert '\n' not in message


@pytest.mark.parametrize(
    ('data', 'words'),
    [
        (with_position(column=9), 'no column 9 in run 1; it has 0 to 2'),
        (with_position(column='x'), "no column 'x' in run 1; it has 0, 1, 2"),
        (changed(runs={'include': 'q*'}), "no run matches runs.include 'q*'"),
        (changed(runs={'include': 'notes'}), 'not numbers'),
        (changed(runs=None), 'name the tables under runs'),
        (changed(format='mat'), 'not readable as mat'),
    ],
)
def test_a_file_that_does_not_fit_the_mapping_is_one_line(npz, tmp_path, data, words):
    with pytest.raises(RecordingError) as caught:
        imported(tmp_path, npz, data)
    assert words in str(caught.value)
    assert str(npz) in str(caught.value)
    assert '\n' not in str(caught.value)


@pytest.mark.parametrize(
    ('text', 'words'),
    [
        ('', 'empty'),
        ('t,motor\n1,2\n3\n', 'row 3 has 1 cells for 2 columns'),
        ('t,motor\n1,x\n', "column motor: 'x' is not a number"),
        ('t,t\n1,2\n', "columns 1 and 2 are both called 't' in its first line"),
        (
            'PuTTY log 17\nt,motor\n1,2\n',
            r'its first line names 1 columns \(PuTTY log 17\), the next has 2 cells; delete what',
        ),
    ],
)
def test_a_bad_csv_is_one_line(tmp_path, text, words):
    (tmp_path / 'x.csv').write_text(text)
    with pytest.raises(RecordingError, match=words):
        imported(tmp_path, tmp_path / 'x.csv', changed(format='csv', **BY_NAME))


def test_the_last_row_of_a_logger_that_was_stopped_is_left_out_and_told(tmp_path):
    rows = '\n'.join(f'{t}, {c}' for t, c in zip(TIME * 1e3, COUNTS, strict=True))
    # names and cells after a blank, as some write them
    (tmp_path / 'x.csv').write_text(f'"t", "motor"\n{rows}\n40.')
    (run,) = imported(tmp_path, tmp_path / 'x.csv', changed(format='csv', **BY_NAME))
    np.testing.assert_allclose(run['actuator/pulley_motor/position'].value, expected(), rtol=1e-14)
    [told] = run.warnings
    assert told.endswith('the last row, 42, is cut off after 1 of 2 cells; left out')


def test_python_objects_beside_the_signals_are_left_aside(tmp_path):
    objects = np.array([{'gain': 3.0}, None], dtype=object)
    np.savez(tmp_path / 'x.npz', t=TIME * 1e3, motor=COUNTS, settings=objects)
    (run,) = imported(tmp_path, tmp_path / 'x.npz', changed(**BY_NAME))
    np.testing.assert_allclose(run['actuator/pulley_motor/position'].value, expected(), rtol=1e-14)
    table = np.stack([TIME, COUNTS, COUNTS], axis=1)
    np.savez(tmp_path / 'runs.npz', **{'1': table, '2': objects, 'hdr_1': objects})
    (one,) = imported(tmp_path, tmp_path / 'runs.npz', MAPPING, ['1'])
    assert 'source_header' not in one.metadata
    with pytest.raises(RecordingError, match='2 holds object, not numbers; map another'):
        imported(tmp_path, tmp_path / 'runs.npz', MAPPING)


def damaged_npz(path):
    np.savez(path, t=TIME * 1e3, motor=COUNTS)
    data = bytearray(path.read_bytes())
    data[200] ^= 0xFF  # among the numbers: seen only when they are read
    path.write_bytes(data)


def damaged_mat(path):
    scipy.io.savemat(path, {'t': np.arange(5000.0), 'motor': COUNTS}, do_compression=True)
    data = bytearray(path.read_bytes())
    data[400:500] = b'x' * 100
    path.write_bytes(data)


@pytest.mark.parametrize(
    ('kind', 'make'),
    [
        ('npz', damaged_npz),
        ('mat', lambda path: path.write_bytes(b'')),
        ('mat', damaged_mat),
        ('csv', lambda path: path.write_text('t,motor\n0,"' + '1,2\n' * 50_000)),
        ('json', lambda path: path.write_text('[' * 100_000)),
    ],
    ids=['npz', 'empty mat', 'mat', 'open quote', 'nested'],
)
def test_a_damaged_file_is_one_line(tmp_path, kind, make):
    path = tmp_path / f'x.{kind}'
    make(path)
    with pytest.raises(RecordingError) as caught:
        imported(tmp_path, path, changed(format=kind, **BY_NAME))
    message = str(caught.value)
    assert message.startswith(f'{path}: not readable as {kind} (')
    assert 'check that the file is whole' in message
    assert '\n' not in message


def test_a_missing_file_and_a_missing_mapping(tmp_path):
    with pytest.raises(RecordingError, match='no such file'):
        imported(tmp_path, tmp_path / 'x.npz', MAPPING)
    with pytest.raises(RecordingError, match='cannot be read'):
        load_mapping(tmp_path / 'none.yaml')


SERVO = {
    'format': 'csv',
    'time': {'column': 'ms', 'unit': 'ms'},
    'channels': {
        'actuator/pulley_arm/position': {'column': 'deg', 'unit': 'deg'},
        'actuator/pulley_arm/effort': {'column': 'load', 'unit': 'percent * 2.5 N m', 'sign': -1},
        'pulley/pulley_belt/velocity': {
            'column': 'rpm',
            'unit': 'rpm',
            'time': {'column': 'us', 'unit': 'us'},
        },
    },
}


def test_units_of_servos_and_stamps_of_its_own(tmp_path):
    text = (
        'ms,deg,load,state,us,rpm\n'
        '0,90,10,run,,\n'
        '20,91,-20,run,13000,60\n'
        '40,,30,run,13000,60\n'
        '60,93,,halt,33500,60\n'
    )
    (tmp_path / 'x.csv').write_text(text)
    (run,) = imported(tmp_path, tmp_path / 'x.csv', SERVO)
    position, effort = run['actuator/pulley_arm/position'], run['actuator/pulley_arm/effort']
    np.testing.assert_allclose(position.value, np.deg2rad([90, 91, 93]))
    np.testing.assert_allclose(position.time, [0.0, 0.02, 0.06])
    np.testing.assert_allclose(effort.value, [-0.25, 0.5, -0.75])
    speed = run['pulley/pulley_belt/velocity']
    np.testing.assert_allclose(speed.value, [2 * np.pi, 2 * np.pi])
    np.testing.assert_array_equal(speed.time, [0.013, 0.0335])
    back = read_recording(write_recording(run, tmp_path / 'bag'))
    for name, channel in run.channels.items():
        np.testing.assert_array_equal(back[name].value, channel.value)
        np.testing.assert_allclose(back[name].time, channel.time, atol=2e-9)


def test_text_matters_only_where_it_is_mapped(tmp_path):
    (tmp_path / 'x.csv').write_text('ms,deg,load,us,rpm\n0,90,stall,0,1\n20,91,1,1,1\n')
    with pytest.raises(RecordingError, match=r"row 2, column load: 'stall' is not a number; mend"):
        imported(tmp_path, tmp_path / 'x.csv', SERVO)


@pytest.mark.parametrize('delimiter', [';', '\t', ','])
def test_other_delimiters(tmp_path, delimiter):
    rows = [['t', 'motor'], ['0', '0.5'], ['1.5', '1']]
    text = '\n'.join(delimiter.join(row) for row in rows)
    (tmp_path / 'x.csv').write_text(text.replace('.', ',') if delimiter == ';' else text)
    (run,) = imported(tmp_path, tmp_path / 'x.csv', changed(format='csv', **BY_NAME))
    np.testing.assert_allclose(run['actuator/pulley_motor/position'].time, [0.0, 0.0015])


def test_a_sample_of_a_slow_channel_that_comes_late_is_told(tmp_path):
    text = 'ms,deg,load,us,rpm\n0,90,1,500,1\n20,91,1,400,2\n40,92,1,700,3\n'
    (tmp_path / 'x.csv').write_text(text)
    (run,) = imported(tmp_path, tmp_path / 'x.csv', SERVO)
    assert run['pulley/pulley_belt/velocity'].value.size == 2
    assert run['actuator/pulley_arm/position'].value.size == 3
    assert any('pulley/pulley_belt/velocity: 1 of 3 rows left out' in w for w in run.warnings)


def test_rows_of_a_slow_channel_are_those_of_the_file(tmp_path):
    rows = [[20 * i, 90, 1, 100_000 * (i // 5), i // 5] for i in range(40)]
    rows[30][4] = 'nan'  # the seventh of its own samples; the row below repeats its stamp
    text = '\n'.join(','.join(map(str, row)) for row in rows)
    (tmp_path / 'x.csv').write_text(f'ms,deg,load,us,rpm\n{text}\n')
    (run,) = imported(tmp_path, tmp_path / 'x.csv', SERVO)
    stamps, values = (
        w for w in run.warnings if 'pulley/pulley_belt/velocity' in w and 'left out' in w
    )
    assert 'first row 32 of the data' in stamps
    assert 'first row 31 of the data' in values


@pytest.mark.parametrize('rate', [50, 10_000])
def test_slow_and_fast_recordings(tmp_path, rate):
    time = np.arange(3 * rate) / rate
    np.savetxt(
        tmp_path / 'x.csv',
        np.stack([1e3 * time, np.degrees(np.sin(time)), time, 1e6 * time, time], axis=1),
        delimiter=',',
        header='ms,deg,load,us,rpm',
        comments='',
        fmt='%.17g',
    )
    (run,) = imported(tmp_path, tmp_path / 'x.csv', SERVO)
    assert run.warnings == ()
    np.testing.assert_allclose(run['actuator/pulley_arm/position'].value, np.sin(time), atol=1e-12)
    np.testing.assert_allclose(run['pulley/pulley_belt/velocity'].time, time, atol=1e-9)


def test_an_offset_may_have_a_unit(tmp_path, npz):
    [run] = imported(tmp_path, npz, with_position(offset='-180 deg'), ['1'])
    assert run['actuator/pulley_motor/position'].value[0] == pytest.approx(-np.pi)


@pytest.mark.parametrize(('bits', 'told'), [(None, True), (16, False)])
def test_a_register_that_lost_its_sign_is_told(tmp_path, bits, told):
    raw = np.where(np.sin(0.3 * np.arange(N)) < 0.0, 65400.0, 120.0)
    path = tmp_path / 'runs.npz'
    np.savez(path, **{'1': np.stack([TIME, raw, COUNTS], axis=1)})
    [run] = imported(tmp_path, path, with_position(bits=bits))
    assert any('if it is one, write `bits: 16`' in w for w in run.warnings) == told
    # counts that pass zero do not leap
    np.savez(path, **{'1': np.stack([TIME, np.linspace(0.0, 65000.0, N).round(), COUNTS], axis=1)})
    [run] = imported(tmp_path, path, with_position(bits=None))
    assert not run.warnings


def test_a_joint_that_is_no_pulley_is_told(tmp_path, npz):
    channels = {**MAPPING['channels'], 'pulley/link/position': {'column': 1, 'unit': 'deg'}}
    [run] = imported(tmp_path, npz, changed(channels=channels), ['1'])
    [told] = run.warnings
    assert told.endswith('so that pulley link has pulley/pulley_link/position')


def test_names_behind_a_hash_are_told(tmp_path):
    (tmp_path / 'x.csv').write_text('# t, motor\n' + ''.join(f'{n}e-3,{n}\n' for n in range(40)))
    fields = {'time': {'column': 0, 'unit': 's'}}
    channels = {'actuator/pulley_motor/position': {'column': 1, 'unit': 'rad'}}
    text = changed(format='csv', runs=None, channels=channels, **fields)
    [run] = imported(tmp_path, tmp_path / 'x.csv', text)
    [warning] = run.warnings
    assert "they go by number from 0; '# t, motor' was taken for a comment" in warning
