"""Bags as foreign drivers fill them, and bags that are broken."""

from pathlib import Path
import shutil
import time

import numpy as np
import pytest
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer

from tendon_ros.bags.bag_writer import BagWriter
from tendon_ros.bags.messages import definition_of, encode, typestore
from tendon_ros.bags.reader import read_recording
from tendon_ros.bags.writer import write_recording
from tendon_ros.base.errors import RecordingError
from tendon_ros.base.recording import Channel, Recording

TOPIC = '/instrument/actuator/measured_js'
NAMES = ('pulley_M', 'pulley_L')
EPOCH = 1_700_000_000_123_456_789
MS = 1_000_000


def joint_state(stamp_ns, names, position=(), velocity=(), effort=()):
    """Return a serialised JointState."""
    types = typestore().types
    return encode(
        types['sensor_msgs/msg/JointState'](
            header=types['std_msgs/msg/Header'](
                stamp=types['builtin_interfaces/msg/Time'](
                    sec=stamp_ns // 10**9, nanosec=stamp_ns % 10**9
                ),
                frame_id='',
            ),
            name=list(names),
            position=np.array(position, dtype=float),
            velocity=np.array(velocity, dtype=float),
            effort=np.array(effort, dtype=float),
        ),
        'sensor_msgs/msg/JointState',
    )


def stamps(n):
    return [EPOCH + i * 2 * MS for i in range(n)]


def test_header_stamps_count_not_the_log(bag_of):
    path = bag_of([joint_state(s, NAMES, (i, -i)) for i, s in enumerate(stamps(5))])
    channel = read_recording(path)['actuator/pulley_L/position']
    np.testing.assert_array_equal(channel.time, np.arange(5) * 2 * MS / 1e9)
    np.testing.assert_array_equal(channel.value, -np.arange(5.0))


def test_an_empty_field_is_unmeasured(bag_of):
    recording = read_recording(bag_of([joint_state(s, NAMES, (1, 2)) for s in stamps(3)]))
    assert set(recording.channels) == {f'actuator/{n}/position' for n in NAMES}


def test_a_field_that_is_nan_throughout_is_unmeasured(bag_of):
    nan = (np.nan, np.nan)
    recording = read_recording(
        bag_of([joint_state(s, NAMES, (1, 2), effort=nan) for s in stamps(3)])
    )
    assert 'actuator/pulley_M/effort' not in recording
    assert recording.warnings == ()


@pytest.mark.parametrize('names', [(), ('0', '1')])
def test_names_that_say_nothing_are_filled_in_by_the_caller(bag_of, names):
    path = bag_of([joint_state(s, names, (1, 2)) for s in stamps(3)])
    named = read_recording(path, joints={'actuator': NAMES})
    assert named['actuator/pulley_L/position'].value.tolist() == [2, 2, 2]
    assert set(read_recording(path).channels) == {'actuator/0/position', 'actuator/1/position'}


def test_permuted_names_are_put_in_order(bag_of):
    pairs = [(NAMES, (1, 2)), (NAMES[::-1], (2, 1)), (('1', '0'), (2, 1)), (NAMES, (1, 2))]
    path = bag_of([joint_state(s, n, p) for s, (n, p) in zip(stamps(4), pairs, strict=True)])
    recording = read_recording(path, joints={'actuator': NAMES})
    assert recording['actuator/pulley_M/position'].value.tolist() == [1, 1, 1, 1]
    assert recording['actuator/pulley_L/position'].value.tolist() == [2, 2, 2, 2]


def faulty(kind):
    s = stamps(10)
    good = [joint_state(t, NAMES, (i, i)) for i, t in enumerate(s)]
    good[4] = {
        'differ in number': joint_state(s[4], NAMES, (1, 2, 3)),
        'cannot be matched': joint_state(s[4], ('a', 'a'), (1, 2)),
        'not a finite number': joint_state(s[4], NAMES, (np.nan, np.inf)),
        'not after the one before': joint_state(s[2], NAMES, (4, 4)),
        'cannot be decoded': b'\x00\x01\x00\x00\x07',
    }[kind]
    return good


@pytest.mark.parametrize(
    'kind',
    [
        'differ in number',
        'cannot be matched',
        'not a finite number',
        'not after the one before',
        'cannot be decoded',
    ],
)
def test_a_bad_message_is_left_out_and_told(bag_of, kind):
    recording = read_recording(bag_of(faulty(kind)))
    for name in NAMES:
        assert recording[f'actuator/{name}/position'].value.tolist() == [0, 1, 2, 3, 5, 6, 7, 8, 9]
    assert recording.warnings
    for warning in recording.warnings:
        assert warning.startswith(f'{TOPIC}: 1 of 10 messages left out')
        assert kind in warning
        assert 'first message 5 at' in warning
        assert '\n' not in warning


def test_a_repeated_stamp_is_dropped(bag_of):
    s = stamps(3)
    path = bag_of([joint_state(t, NAMES, (i, i)) for i, t in enumerate([s[0], s[0], s[1]])])
    assert read_recording(path)['actuator/pulley_M/position'].value.tolist() == [0, 2]


def test_only_useless_messages_are_an_error(bag_of):
    path = bag_of([joint_state(t, NAMES, (1,)) for t in stamps(3)])
    with pytest.raises(RecordingError, match=r'nothing usable.*3 of 3 messages'):
        read_recording(path)


def test_a_bag_without_motors_names_its_topics(bag_of):
    path = bag_of([joint_state(EPOCH, NAMES, (1, 2))], topic='/instrument/pulley/measured_js')
    with pytest.raises(RecordingError, match=r'no topic actuator/measured_js.*pulley/measured_js'):
        read_recording(path)


def test_a_topic_of_another_type_is_named(tmp_path):
    with BagWriter(tmp_path / 'bag') as bag:
        bag.add_topic(TOPIC, 'geometry_msgs/msg/WrenchStamped')
    with pytest.raises(
        RecordingError, match='is geometry_msgs/msg/WrenchStamped, not sensor_msgs'
    ):
        read_recording(tmp_path / 'bag')


@pytest.mark.parametrize('only', ['force', 'torque'])
def test_a_wrench_without_note_is_what_is_not_zero(tmp_path, only):
    times = np.arange(5) / 100
    channels = [Channel('actuator/m/position', times, times)]
    channels.append(Channel(f'load_cell/{only}', times, times + 1))
    path = write_recording(Recording('r', {c.name: c for c in channels}), tmp_path / 'bag')
    yaml = path / 'metadata.yaml'
    yaml.write_text(yaml.read_text().replace('channels:', 'other:'))
    assert [n for n in read_recording(path).channels if 'load' in n] == [f'load_cell/{only}']


def test_a_wrench_that_never_touches_is_a_measured_zero(tmp_path):
    times = np.arange(5) / 100
    channels = [Channel('actuator/m/position', times, times)]
    channels.append(Channel('load_cell/force', times, 0 * times))
    path = write_recording(Recording('r', {c.name: c for c in channels}), tmp_path / 'bag')
    yaml = path / 'metadata.yaml'
    yaml.write_text(yaml.read_text().replace('channels:', 'other:'))
    assert read_recording(path)['load_cell/force'].value.tolist() == [0] * 5


@pytest.mark.parametrize('mode', [CompressionMode.FILE, CompressionMode.MESSAGE])
@pytest.mark.parametrize('plugin', [StoragePlugin.MCAP, StoragePlugin.SQLITE3])
def test_bags_compressed_by_others_are_read(tmp_path, mode, plugin):
    text, digest = definition_of('sensor_msgs/msg/JointState', None, None)
    writer = Writer(tmp_path / 'bag', version=8, storage_plugin=plugin)
    writer.set_compression(mode, CompressionFormat.ZSTD)
    with writer:
        connection = writer.add_connection(
            TOPIC, 'sensor_msgs/msg/JointState', msgdef=text, rihs01=digest
        )
        for stamp in stamps(4):
            writer.write(connection, stamp, joint_state(stamp, NAMES, (1, 2)))
    assert read_recording(tmp_path / 'bag')['actuator/pulley_L/position'].value.size == 4


@pytest.mark.parametrize('share', [0.0, 0.001, 0.3, 0.7, 0.97, 0.9999])
@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
@pytest.mark.parametrize('single', [True, False])
def test_a_truncated_bag_is_one_line_that_names_the_mend(
    recording, tmp_path, share, storage, single
):
    path = write_recording(recording, tmp_path / 'bag', storage=storage)
    (file,) = [p for p in path.iterdir() if p.suffix in ('.mcap', '.db3')]
    data = file.read_bytes()
    # SQLite files end in unused space: cut at a page that is in use
    cut = int(len(data) * share) if storage == 'mcap' else int(len(data) * share) // 4096 * 4096
    file.write_bytes(data[:cut])
    with pytest.raises(RecordingError, match=r'truncated or damaged.*tendon recover') as caught:
        read_recording(file if single else path)
    assert '\n' not in str(caught.value)
    assert str(file if single else path) in str(caught.value)


def test_an_unfinished_bag_names_the_mend(recording, tmp_path):
    path = write_recording(recording, tmp_path / 'bag')
    (path / 'metadata.yaml').unlink()
    with pytest.raises(RecordingError, match=r'no metadata\.yaml.*tendon recover'):
        read_recording(path)


@pytest.mark.parametrize(
    ('name', 'text', 'fault'),
    [
        ('none', None, 'does not exist'),
        ('notes.txt', 'hello', 'not a bag'),
        ('x.mcap', 'hello', 'truncated or damaged'),
        ('x.db3', 'hello', 'truncated or damaged'),
    ],
)
def test_what_is_no_bag(tmp_path, name, text, fault):
    if text is not None:
        (tmp_path / name).write_text(text)
    with pytest.raises(RecordingError, match=fault):
        read_recording(tmp_path / name)
    with pytest.raises(RecordingError, match='not a bag'):
        read_recording(_empty(tmp_path))


def _empty(tmp_path: Path) -> Path:
    (tmp_path / 'empty').mkdir(exist_ok=True)
    return tmp_path / 'empty'


def test_metadata_that_is_no_metadata(recording, tmp_path):
    path = write_recording(recording, tmp_path / 'bag')
    for text in ('', '[1, 2]', 'rosbag2_bagfile_information: {}', '\t:', 'a: "'):
        (path / 'metadata.yaml').write_text(text)
        with pytest.raises(RecordingError, match='truncated or damaged'):
            read_recording(path)


def test_a_practice_bag(practice, tmp_path):
    start = time.perf_counter()
    recording = read_recording(practice / 'case_00' / 'contact')
    elapsed = time.perf_counter() - start
    assert recording.warnings == ()
    assert len(recording.channels) == 10
    assert all(channel.time.size == 9000 for channel in recording.channels.values())
    assert recording.epoch_ns == 1_700_000_000_000_000_000
    assert recording['load_cell/force'].value.max() > 5.0
    assert 'load_cell/torque' not in recording
    # 36,000 messages; half a second on a quiet machine
    assert elapsed < 10.0
    shutil.copy(practice / 'case_00/contact/contact.mcap', tmp_path / 'alone.mcap')
    alone = read_recording(tmp_path / 'alone.mcap')
    assert alone.channels.keys() == recording.channels.keys()
