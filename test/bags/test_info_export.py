"""The summary of a bag, and its CSV."""

import csv
import json

import numpy as np
import pytest

from tendon_ros.bags.bag_writer import BagWriter
from tendon_ros.bags.encoding import joint_layout
from tendon_ros.bags.export import export_csv
from tendon_ros.bags.info import summarise
from tendon_ros.bags.writer import write_recording
from tendon_ros.base.errors import OutputError
from tendon_ros.base.recording import Channel, Recording


def test_rates_gaps_jitter_and_backward_stamps(tmp_path):
    # what a driver sends, with its own stamps behind the length of the encapsulation
    stamps = [0, 2, 4, 6, 16, 18, 17, 20, 20, 22]
    with BagWriter(tmp_path / 'bag') as bag:
        bag.add_topic('/a', 'sensor_msgs/msg/JointState')
        bag.add_topic('/b', 'std_msgs/msg/String')
        for i, ms in enumerate(stamps):
            body = (ms * 10**6).to_bytes(4, 'little') + b'\x00' * 24
            bag.write_raw('/a', b'\x00\x01\x00\x00' + (7).to_bytes(4, 'little') + body, i)
            bag.write_raw('/b', b'\x00\x01\x00\x00\x01\x00\x00\x00\x00', i * 10**9)
    info = summarise(tmp_path / 'bag')
    a, b = info.topics
    assert (a.clock, a.count, a.start) == ('header', 10, 7.0)
    assert a.rate == pytest.approx(500)
    assert (a.gaps, a.backward, a.repeated) == (1, 1, 1)
    assert a.longest_gap == pytest.approx(0.010)
    assert a.duration == pytest.approx(0.022)
    assert a.jitter_p99 > 0.001
    assert (b.clock, b.rate, b.jitter_p99) == ('log', pytest.approx(1.0), 0.0)
    assert info.messages == 20
    assert json.loads(json.dumps(info.as_dict()))['topics'][0]['count'] == 10


def test_the_whole_duration_mixes_no_clocks(tmp_path):
    # a driver whose clock starts at zero: the log knows the time of day
    stamps = np.arange(11) * 100_000_000
    cdrs = joint_layout(['a'], ['position']).encode(stamps, np.zeros((11, 1)))
    with BagWriter(tmp_path / 'bag') as bag:
        bag.add_topic('/a', 'sensor_msgs/msg/JointState')
        bag.add_topic('/b', 'std_msgs/msg/String')
        for stamp, cdr in zip(stamps.tolist(), cdrs, strict=True):
            bag.write_raw('/a', cdr, 1_700_000_000 * 10**9 + stamp)
            bag.write_raw('/b', b'\x00\x01\x00\x00' + bytes(4), 1_700_000_000 * 10**9 + stamp)
    assert summarise(tmp_path / 'bag').duration == pytest.approx(1.0)


def test_metadata_and_storage_are_told(recording, tmp_path):
    for storage in ('mcap', 'sqlite3'):
        info = summarise(write_recording(recording, tmp_path / storage, storage=storage))
        assert info.storage == storage
        assert info.metadata['seed'] == '7'
        assert info.size > 1000


def rows(path):
    with path.open(newline='') as stream:
        return list(csv.reader(stream))


def test_one_wide_file_keeps_each_number_and_invents_none(recording, tmp_path):
    (path,) = export_csv(recording, tmp_path / 'x.csv')
    head, *body = rows(path)
    assert head[:2] == ['time [s]', 'stamp [ns]']
    assert 'actuator/pulley_M/effort [N m]' in head
    assert 'pulley/pulley_1/velocity [rad/s]' in head
    for name, channel in recording.channels.items():
        column = head.index(f'{name} [{channel.unit}]')
        cells = [(float(row[0]), float(row[column])) for row in body if row[column]]
        np.testing.assert_array_equal([c[1] for c in cells], channel.value)
        np.testing.assert_allclose([c[0] for c in cells], channel.time, atol=1e-9)
    assert [int(row[1]) for row in body] == sorted({int(row[1]) for row in body})
    assert int(body[0][1]) == recording.epoch_ns


def test_a_folder_has_one_full_file_a_group(recording, tmp_path):
    files = export_csv(recording, tmp_path / 'out')
    assert {p.name for p in files} >= {'actuator.csv', 'load_cell.csv', 'pulley.csv'}
    assert all(all(row) for path in files for row in rows(path))
    columns = sum(len(rows(path)[0]) - 2 for path in files)
    assert columns == len(recording.channels)


def test_channels_of_a_group_with_other_stamps_get_their_own_file(tmp_path):
    fast, slow = np.arange(4) / 10, np.arange(2) / 10
    channels = [
        Channel('actuator/a/position', fast, fast),
        Channel('actuator/b/effort', slow, slow),
    ]
    recording = Recording('r', {c.name: c for c in channels})
    names = {p.name for p in export_csv(recording, tmp_path / 'out')}
    assert names == {'actuator_a_position.csv', 'actuator_b_effort.csv'}


def test_existing_files_are_kept_unless_allowed(recording, tmp_path):
    export_csv(recording, tmp_path / 'x.csv')
    with pytest.raises(OutputError, match='exists'):
        export_csv(recording, tmp_path / 'x.csv')
    export_csv(recording, tmp_path / 'x.csv', overwrite=True)
