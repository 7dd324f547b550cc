"""What is left of a bag whose writer was killed, or that was cut off."""

from contextlib import closing, suppress
import signal
import sqlite3
import subprocess
import sys

from mcap.reader import make_reader
from mcap.records import Message
from mcap.writer import CompressionType, Writer
from mcap_ros2.decoder import DecoderFactory
import numpy as np
import pytest
from rosbags.rosbag2 import Reader

from tendon_ros.bags.bag_writer import BagWriter, SIDECAR
from tendon_ros.bags.info import summarise
from tendon_ros.bags.mcap_salvage import salvage
from tendon_ros.bags.messages import UNKNOWN_HASH
from tendon_ros.bags.qos import offered_qos
from tendon_ros.bags.reader import read_recording
from tendon_ros.bags.recover import recover
from tendon_ros.bags.storage import bag_metadata
from tendon_ros.bags.writer import write_recording
from tendon_ros.base.errors import OutputError, RecordingError, TendonError

WRITE_UNTIL_KILLED = """
import sys
from tendon_ros.bags.bag_writer import BagWriter
from tendon_ros.bags.messages import encode, typestore
import numpy as np
types = typestore().types
bag = BagWriter(sys.argv[1], storage=sys.argv[2], metadata={'seed': '3'})
bag.add_topic('/instrument/actuator/measured_js', 'sensor_msgs/msg/JointState')
for i in range(10**9):
    stamp = 10**9 + i * 2_000_000
    message = types['sensor_msgs/msg/JointState'](
        header=types['std_msgs/msg/Header'](
            stamp=types['builtin_interfaces/msg/Time'](sec=stamp // 10**9, nanosec=stamp % 10**9),
            frame_id=''),
        name=['pulley_M'], position=np.array([float(i)]), velocity=np.empty(0),
        effort=np.empty(0))
    cdr = encode(message, 'sensor_msgs/msg/JointState')
    bag.write_raw('/instrument/actuator/measured_js', cdr, stamp)
    if i % 500 == 0:
        print(i, flush=True)
"""


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_a_killed_writer_loses_at_most_a_second(tmp_path, storage):
    path = tmp_path / 'bag'
    with subprocess.Popen(
        [sys.executable, '-c', WRITE_UNTIL_KILLED, str(path), storage],
        stdout=subprocess.PIPE,
        text=True,
    ) as process:
        written = 0
        while written < 3000:
            written = int(process.stdout.readline())
        process.send_signal(signal.SIGKILL)
        rest = process.stdout.read().split()
    written = int(rest[-1]) if rest else written
    with pytest.raises(RecordingError, match=r'no metadata\.yaml.*tendon recover'):
        read_recording(path)
    before = {p.name: p.read_bytes() for p in path.iterdir()}

    summary = recover(path, tmp_path / 'new')

    assert summary.damaged
    # 500 messages are the second that may be lost; the pipe tells of every 500th
    assert summary.messages >= written - 500
    recording = read_recording(tmp_path / 'new')
    values = recording['actuator/pulley_M/position'].value
    np.testing.assert_array_equal(values, np.arange(summary.messages))
    assert recording.metadata['seed'] == '3'
    assert {p.name: p.read_bytes() for p in path.iterdir()} == before


def damage(recording, tmp_path, storage, share):
    path = write_recording(recording, tmp_path / 'bag', storage=storage)
    (file,) = [p for p in path.iterdir() if p.suffix in ('.mcap', '.db3')]
    data = file.read_bytes()
    file.write_bytes(data[: int(len(data) * share)])
    (path / 'metadata.yaml').unlink()
    return path


@pytest.mark.parametrize('compress', [True, False])
@pytest.mark.parametrize('share', [0.2, 0.5, 0.8, 0.95, 0.999])
def test_a_cut_mcap_gives_what_lies_before_the_cut(recording, tmp_path, share, compress):
    path = write_recording(recording, tmp_path / 'whole', compress=compress)
    data = (path / 'whole.mcap').read_bytes()
    (tmp_path / 'cut.mcap').write_bytes(data[: int(len(data) * share)])
    total = sum(isinstance(record, Message) for record in salvage(path / 'whole.mcap'))
    if compress and share < 0.5:
        # half a second fits in one compressed block, of which a fifth gives nothing
        return
    summary = recover(tmp_path / 'cut.mcap', tmp_path / 'new')
    assert summary.damaged
    if not compress:
        assert summary.messages >= 0.85 * share * total
    back = read_recording(tmp_path / 'new')
    for name, channel in back.channels.items():
        n = channel.value.size
        np.testing.assert_array_equal(channel.value, recording[name].value[:n])
    if share > 0.99:
        assert summary.messages == total


@pytest.mark.parametrize('share', [0.9, 0.97])
def test_a_cut_database_gives_what_lies_before_the_cut(recording, tmp_path, share):
    path = damage(recording, tmp_path, 'sqlite3', share)
    summary = recover(path, tmp_path / 'new')
    assert summary.damaged
    assert summary.messages > 100
    for name, channel in read_recording(tmp_path / 'new').channels.items():
        n = channel.value.size
        np.testing.assert_array_equal(channel.value, recording[name].value[:n])


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_a_whole_bag_is_copied_whole(recording, tmp_path, storage):
    path = write_recording(recording, tmp_path / 'bag', storage=storage)
    summary = recover(path, tmp_path / 'new')
    assert not summary.damaged
    back = read_recording(tmp_path / 'new')
    assert back.epoch_ns == recording.epoch_ns
    assert back.metadata['note'] == 'θ'
    for name, channel in recording.channels.items():
        np.testing.assert_array_equal(back[name].value, channel.value)


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_topics_types_qos_and_foreign_definitions_are_kept(tmp_path, storage):
    qos = offered_qos(reliable=False, latched=True)
    bag = BagWriter(tmp_path / 'bag', storage=storage)
    bag.add_topic('/state', 'my_msgs/msg/State', qos, definition='float64 value\n')
    bag.write_raw('/state', b'\x00\x01\x00\x00' + b'\x00' * 8, 5)
    bag.write_raw('/state', b'\x00\x01\x00\x00' + b'\x00' * 8, 2 * 10**9)  # the second is over
    recover(tmp_path / 'bag', tmp_path / 'new')
    bag.close()
    with Reader(tmp_path / 'bag') as first, Reader(tmp_path / 'new') as second:
        (one,), (other,) = first.connections, second.connections
        assert one[1:7] == other[1:7]
        assert other.ext.offered_qos_profiles == [qos]


STRING = b'\x00\x01\x00\x00' + (4093).to_bytes(4, 'little') + b'x' * 4092 + b'\x00'


def write_until_refused(bag):
    for i in range(1000):
        bag.write_raw('/a', STRING, i * 10**8)


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_a_full_disk_leaves_what_can_be_recovered(tmp_path, refused_beyond, storage):
    path = tmp_path / 'bag'
    bag = BagWriter(path, storage=storage, compress=False, metadata={'seed': '3'})
    bag.add_topic('/a', 'std_msgs/msg/String')
    said = rf'{path}: cannot be written \(.+\); make room, then `tendon recover` it'
    with pytest.raises(OutputError, match=said), refused_beyond(500_000), bag:
        write_until_refused(bag)
    with refused_beyond(0), pytest.raises(OutputError, match=said):
        bag.set_metadata('dropped', '5')
    summary = recover(path, tmp_path / 'new')
    assert summary.damaged
    assert 0.8 * 500_000 < summary.messages * len(STRING) < 500_000
    with Reader(tmp_path / 'new') as reader:
        assert [stamp for _, stamp, _ in reader.messages()] == [
            i * 10**8 for i in range(summary.messages)
        ]
    assert bag_metadata(tmp_path / 'new')['seed'] == '3'


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_a_bag_that_cannot_be_finished_can_be_recovered(tmp_path, refused_beyond, storage):
    bag = BagWriter(tmp_path / 'bag', storage=storage, compress=False)
    bag.add_topic('/a', 'std_msgs/msg/String')
    for i in range(12):
        bag.write_raw('/a', STRING, i * 10**8)
    with (
        pytest.raises(OutputError, match=r'cannot be finished .* then `tendon recover` it'),
        refused_beyond(4096),
    ):
        bag.close()
    bag.close()
    assert recover(tmp_path / 'bag', tmp_path / 'new').messages == 11


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_a_bag_that_cannot_be_created_leaves_its_path_free(tmp_path, refused_beyond, storage):
    path = tmp_path / 'bag'
    with pytest.raises(OutputError, match=f'{path}: cannot be created'), refused_beyond(0):
        BagWriter(path, storage=storage)
    BagWriter(path, storage=storage).close()


@pytest.mark.parametrize(
    ('storage', 'said'),
    [
        ('mcap', r'new: cannot be written .* nothing of it is left; make room'),
        ('sqlite3', r'bag\.db3: cannot be copied to .*; make room there, or set TMPDIR'),
    ],
)
def test_what_there_is_no_room_to_recover_leaves_nothing(
    recording, tmp_path, refused_beyond, storage, said
):
    path = write_recording(recording, tmp_path / 'bag', storage=storage)
    with pytest.raises(TendonError, match=said), refused_beyond(60_000):
        recover(path, tmp_path / 'new')
    assert not (tmp_path / 'new').exists()


def test_an_independent_reader_opens_what_was_recovered(recording, tmp_path):
    path = damage(recording, tmp_path, 'mcap', 0.98)
    summary = recover(path, tmp_path / 'new')
    with (tmp_path / 'new' / 'new.mcap').open('rb') as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        assert sum(1 for _ in reader.iter_decoded_messages()) == summary.messages


#: tables as they were before ROS 2 Iron: without definitions of the types, and without metadata
BEFORE_IRON = """
    CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,
        serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);
    CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL,
        timestamp INTEGER NOT NULL, data BLOB NOT NULL);
    CREATE INDEX timestamp_idx ON messages (timestamp ASC);
    INSERT INTO topics VALUES (1, '/state', 'my_msgs/msg/State', 'cdr', '');
    INSERT INTO topics VALUES (2, '/a', 'std_msgs/msg/String', 'cdr', '');
    INSERT INTO topics VALUES (3, '/a', 'std_msgs/msg/Bool', 'cdr', '');
"""


@pytest.fixture
def old_bag(tmp_path):
    """Return the folder of a bag of an older ROS, without its metadata.yaml."""
    path = tmp_path / 'old'
    path.mkdir()
    with closing(sqlite3.connect(path / 'old_0.db3')) as database:
        database.executescript(BEFORE_IRON)
        rows = [(topic, i, b'\x00\x01\x00\x00' + bytes(8)) for i in range(5) for topic in (1, 2)]
        database.executemany('INSERT INTO messages VALUES (NULL, ?, ?, ?)', rows)
        database.commit()
    return path


def test_a_type_of_which_nothing_is_known_costs_no_message(old_bag, tmp_path):
    summary = recover(old_bag, tmp_path / 'new')
    assert summary.counts == {'/state': 5, '/a': 5}
    with Reader(tmp_path / 'new') as reader:
        known = {c.topic: (c.msgtype, c.msgdef.data != '', c.digest) for c in reader.connections}
        assert known['/state'] == ('my_msgs/msg/State', False, UNKNOWN_HASH)
        assert known['/a'][:2] == ('std_msgs/msg/String', True)
        data = [bytes(cdr) for c, _, cdr in reader.messages() if c.topic == '/state']
    assert data == [b'\x00\x01\x00\x00' + bytes(8)] * 5
    assert summarise(tmp_path / 'new').messages == 10


def test_an_mcap_without_definitions_is_recovered(tmp_path):
    with (tmp_path / 'x.mcap').open('wb') as stream:
        writer = Writer(stream)
        writer.start('ros2')
        schema = writer.register_schema('my_msgs/msg/State', 'ros2msg', b'')
        channel = writer.register_channel('/state', 'cdr', schema)
        writer.add_message(channel, 5, b'\x00\x01\x00\x00' + bytes(8), 5)
        writer.finish()
    assert recover(tmp_path / 'x.mcap', tmp_path / 'new').counts == {'/state': 1}
    assert summarise(tmp_path / 'new').messages == 1


def test_a_bag_of_an_older_ros_is_complete_where_its_metadata_are_there(old_bag, tmp_path):
    assert recover(old_bag, tmp_path / 'one').damaged is None
    (old_bag / 'metadata.yaml').write_text('rosbag2_bagfile_information: {version: 4}')
    assert recover(old_bag, tmp_path / 'two').damaged is False
    file = old_bag / 'old_0.db3'
    file.write_bytes(file.read_bytes()[:-4096])
    assert recover(old_bag, tmp_path / 'three').damaged is True


def test_an_lz4_bag_of_another_writer_is_recovered(tmp_path):
    with (tmp_path / 'x.mcap').open('wb') as stream:
        writer = Writer(stream, compression=CompressionType.LZ4)
        writer.start('ros2')
        schema = writer.register_schema('std_msgs/msg/String', 'ros2msg', b'string data')
        channel = writer.register_channel('/a', 'cdr', schema)
        for i in range(10):
            writer.add_message(channel, i, b'\x00\x01\x00\x00\x01\x00\x00\x00\x00', i)
        writer.flush()
    summary = recover(tmp_path / 'x.mcap', tmp_path / 'new')
    assert (summary.damaged, summary.counts) == (True, {'/a': 10})


@pytest.mark.parametrize('content', [b'', b'\x89MCAP0\r\n', b'garbage' * 100])
def test_nothing_left_is_one_line_and_no_bag(tmp_path, content):
    (tmp_path / 'x.mcap').write_bytes(content)
    with pytest.raises(RecordingError, match='no message can be read'):
        recover(tmp_path / 'x.mcap', tmp_path / 'new')
    assert not (tmp_path / 'new').exists()


def test_flipped_bytes_never_crash(recording, tmp_path):
    path = write_recording(recording, tmp_path / 'bag') / 'bag.mcap'
    data = bytearray(path.read_bytes())
    rng = np.random.default_rng(0)
    for i in range(20):
        broken = bytearray(data)
        for at in rng.integers(0, len(data), 30):
            broken[at] ^= 0xFF
        (tmp_path / 'broken.mcap').write_bytes(broken)
        # most of the time something is left; where nothing is, it is said
        with suppress(RecordingError):
            recover(tmp_path / 'broken.mcap', tmp_path / f'new{i}')
            summarise(tmp_path / f'new{i}')


def test_an_existing_target_is_kept(recording, tmp_path):
    path = write_recording(recording, tmp_path / 'bag')
    with pytest.raises(RecordingError, match='exists'):
        recover(path, path)
    assert read_recording(path).warnings == ()


def test_closing_removes_the_sidecar_and_counts(tmp_path):
    with BagWriter(tmp_path / 'bag') as bag:
        bag.add_topic('/a', 'std_msgs/msg/String')
        assert (bag.path / SIDECAR).exists()
        bag.write_raw('/a', b'\x00\x01\x00\x00\x01\x00\x00\x00\x00', 5)
        assert bag.counts == {'/a': 1}
        with pytest.raises(RecordingError, match='/b was not added'):
            bag.write_raw('/b', b'', 6)
        with pytest.raises(RecordingError, match='cannot become'):
            bag.add_topic('/a', 'std_msgs/msg/Bool')
        with pytest.raises(RecordingError, match='give its definition'):
            bag.add_topic('/c', 'my_msgs/msg/Unknown')
    bag.close()
    assert sorted(p.name for p in bag.path.iterdir()) == ['bag.mcap', 'metadata.yaml']


def test_a_bag_is_closed_when_its_context_fails(tmp_path):
    with pytest.raises(ZeroDivisionError), BagWriter(tmp_path / 'bag') as bag:  # noqa: PT012
        bag.add_topic('/a', 'std_msgs/msg/String')
        bag.write_raw('/a', b'\x00\x01\x00\x00\x01\x00\x00\x00\x00', 5)
        raise ZeroDivisionError
    with Reader(tmp_path / 'bag') as reader:
        assert reader.message_count == 1


def test_a_bag_without_messages_is_finished(tmp_path):
    with BagWriter(tmp_path / 'bag') as bag:
        bag.add_topic('/a', 'std_msgs/msg/String')
    with Reader(tmp_path / 'bag') as reader:
        assert reader.message_count == 0


def test_a_database_may_have_brackets_in_its_name(recording, tmp_path):
    path = write_recording(recording, tmp_path / 'run[1].db3')
    recover(path, tmp_path / 'whole')
    assert read_recording(tmp_path / 'whole').channels.keys() == recording.channels.keys()
