"""What is written reads back, by us and by an independent reader."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
import re

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
import numpy as np
import pytest
import yaml

from tendon_ros.bags.bag_writer import BagWriter
from tendon_ros.bags.info import summarise
from tendon_ros.bags.reader import read_recording
from tendon_ros.bags.writer import write_recording
from tendon_ros.base.errors import OutputError, RecordingError
from tendon_ros.base.recording import Channel, Recording


def assert_same(one, other):
    assert set(one.channels) == set(other.channels)
    assert one.epoch_ns == other.epoch_ns
    for name, channel in one.channels.items():
        np.testing.assert_array_equal(other[name].time, channel.time, err_msg=name)
        np.testing.assert_array_equal(other[name].value, channel.value, err_msg=name)
        assert other[name].unit == channel.unit


@pytest.mark.parametrize('out', ['bag', 'one.mcap', 'one.db3'])
@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
@pytest.mark.parametrize('compress', [True, False])
def test_a_recording_survives_bit_for_bit(recording, tmp_path, out, storage, compress):
    path = write_recording(recording, tmp_path / out, storage=storage, compress=compress)
    back = read_recording(path)
    assert_same(recording, back)
    assert back.warnings == ()
    assert back.metadata['note'] == 'θ'
    assert 'SI' in back.metadata['units']
    assert 'positive' in back.metadata['sign_convention']
    assert [entry.name for entry in tmp_path.iterdir()] == [out]


def test_the_namespace_is_kept(recording, tmp_path):
    path = write_recording(recording, tmp_path / 'bag', namespace='or/left')
    assert read_recording(path).metadata['namespace'] == '/or/left'
    assert read_recording(path, '/or/left/').channels.keys() == recording.channels.keys()


def test_the_independent_reader_sees_the_contract(recording, tmp_path):
    path = write_recording(recording, tmp_path / 'bag')
    seen = {}
    with (path / 'bag.mcap').open('rb') as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        for schema, channel, message, decoded in reader.iter_decoded_messages():
            stamp = decoded.header.stamp.sec * 10**9 + decoded.header.stamp.nanosec
            assert message.log_time == stamp
            assert 'reliable' in channel.metadata['offered_qos_profiles']
            seen.setdefault((channel.topic, schema.name), []).append((stamp, decoded))
    cell = seen['/instrument/load_cell/body/measured_cf', 'geometry_msgs/msg/WrenchStamped']
    assert {m.header.frame_id for _, m in cell} == {'tip'}
    force = [m.wrench.force.y for _, m in cell]
    np.testing.assert_array_equal(force, recording['load_cell/force'].value)
    assert not any(m.wrench.force.x or m.wrench.force.z or m.wrench.torque.x for _, m in cell)
    motors = seen['/instrument/actuator/measured_js', 'sensor_msgs/msg/JointState']
    m_only = [m for _, m in motors if list(m.name) == ['pulley_M']]
    effort = [m.effort[0] for m in m_only]
    np.testing.assert_array_equal(effort, recording['actuator/pulley_M/effort'].value)
    assert all(len(m.velocity) == 0 for _, m in motors)
    # a joint without effort travels apart: nobody reads an invented zero
    l_only = [m for _, m in motors if list(m.name) == ['pulley_L']]
    assert len(l_only) == 250
    assert all(len(m.effort) == 0 for m in l_only)
    stamps = [stamp for stamp, _ in motors]
    assert stamps == sorted(stamps)


def test_joints_with_equal_fields_share_a_message(recording, tmp_path):
    both = Recording(
        'both',
        {n: recording[n] for n in ('actuator/pulley_M/position', 'actuator/pulley_L/position')},
    )
    path = write_recording(both, tmp_path / 'bag')
    info = yaml.safe_load((path / 'metadata.yaml').read_text())['rosbag2_bagfile_information']
    assert info['version'] == 9
    assert info['message_count'] == 250
    (topic,) = info['topics_with_message_count']
    (qos,) = topic['topic_metadata']['offered_qos_profiles']
    assert (qos['reliability'], qos['depth'], qos['durability']) == ('reliable', 10, 'volatile')


def test_an_existing_bag_is_kept_unless_allowed(recording, tmp_path):
    path = write_recording(recording, tmp_path / 'bag')
    with pytest.raises(OutputError, match='exists'):
        write_recording(recording, path)
    write_recording(recording, path, overwrite=True)
    assert_same(recording, read_recording(path))


@pytest.mark.parametrize('out', ['bag', 'one.mcap', 'one.db3', 'empty'])
def test_a_bag_is_replaced_where_that_is_allowed(recording, tmp_path, out):
    if out == 'empty':
        (tmp_path / out).mkdir()
    else:
        write_recording(recording, tmp_path / out, namespace='before')
    path = write_recording(recording, tmp_path / out, overwrite=True)
    assert read_recording(path).metadata['namespace'] == '/instrument'


def test_a_bag_of_an_older_version_is_replaced(recording, tmp_path):
    path = write_recording(recording, tmp_path / 'bag', storage='sqlite3')
    metadata = path / 'metadata.yaml'
    # they named their files from the folder above
    metadata.write_text(metadata.read_text().replace('bag.db3', 'bag/bag.db3'))
    (path / 'bag.db3-wal').touch()
    write_recording(recording, path, overwrite=True)
    assert {p.name for p in path.iterdir()} == {'metadata.yaml', 'bag.mcap'}


@pytest.mark.parametrize(
    ('out', 'made', 'beside'),
    [
        ('work', '', 'work/thesis.tex'),
        ('text.txt', '', 'text.txt'),
        ('helm', '', 'helm/metadata.yaml'),
        ('noted', 'noted', 'noted/notes.txt'),
        ('nested', 'nested', 'nested/more/x'),
    ],
)
def test_only_a_bag_is_replaced(recording, tmp_path, out, made, beside):
    if made:
        write_recording(recording, tmp_path / made)
    beside = tmp_path / beside
    beside.parent.mkdir(exist_ok=True)
    beside.write_text('{years: of work}')
    with pytest.raises(OutputError, match='is no bag that could be replaced'):
        write_recording(recording, tmp_path / out, overwrite=True)
    assert beside.read_text() == '{years: of work}'


def test_a_folder_of_single_files_is_no_bag(recording, tmp_path):
    one = write_recording(recording, tmp_path / 'recordings' / 'one.mcap')
    with pytest.raises(OutputError, match=r'is no bag .*one\.mcap'):
        write_recording(recording, one.parent, overwrite=True)
    assert one.exists()


def test_a_link_is_not_replaced(recording, tmp_path):
    real = write_recording(recording, tmp_path / 'real')
    (tmp_path / 'link').symlink_to(real)
    (tmp_path / 'dangling').symlink_to(tmp_path / 'nowhere')
    for link in ('link', 'dangling'):
        with pytest.raises(OutputError, match='is a link'):
            write_recording(recording, tmp_path / link, overwrite=True)
    assert_same(recording, read_recording(real))


def test_a_bag_needs_folders_above_it(recording, tmp_path):
    (tmp_path / 'file').write_text('')
    with pytest.raises(OutputError, match='is a file, not a folder'):
        write_recording(recording, tmp_path / 'file' / 'deep' / 'bag')


@pytest.mark.parametrize('name', ['kept', 'kept.mcap', 'kept.db3'])
@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
@pytest.mark.parametrize('size', [0, 60_000])
def test_no_half_bag_is_left_behind(
    recording, tmp_path, refused_beyond, name, storage, size, capfd
):
    kept = write_recording(recording, tmp_path / name)
    with (
        pytest.raises(OutputError) as caught,
        refused_beyond(size),
    ):
        write_recording(recording, kept, storage=storage, overwrite=True)
    assert re.fullmatch(
        rf'{kept}: cannot be written \(.+\), nothing of it is left; make room, .*',
        str(caught.value),
    )
    assert [entry.name for entry in tmp_path.iterdir()] == [name]
    assert_same(recording, read_recording(kept))
    assert capfd.readouterr().err == ''  # nor does Python complain of a file that it cannot close


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_another_thread_may_write_than_opened_the_bag(tmp_path, storage):
    # as the callbacks of the recorder do
    with BagWriter(tmp_path / 'bag', storage=storage) as bag, ThreadPoolExecutor() as pool:
        pool.submit(bag.add_topic, '/a', 'std_msgs/msg/String').result()
        for i in range(3):
            pool.submit(bag.write_raw, '/a', b'\x00\x01\x00\x00' + bytes(4), i * 10**9).result()
    assert summarise(tmp_path / 'bag').messages == 3


def test_force_and_torque_at_different_stamps_are_refused(recording, tmp_path):
    late = recording['load_cell/force']
    moved = recording.with_channels([Channel('load_cell/torque', late.time + 0.001, late.value)])
    with pytest.raises(RecordingError, match='different stamps'):
        write_recording(moved, tmp_path / 'bag')
    assert not list(tmp_path.iterdir())


def test_stamps_before_1970_are_refused(tmp_path):
    early = Channel('actuator/m/position', np.array([-1.0, 0.0]), np.zeros(2))
    with pytest.raises(RecordingError, match='before 1970'):
        write_recording(Recording('early', {early.name: early}), tmp_path / 'bag')


def test_stamps_that_ros_has_no_room_for_are_refused(tmp_path):
    late = Channel('actuator/m/position', np.array([0.0, 1.0]), np.zeros(2))
    last = Recording('late', {late.name: late}, epoch_ns=(2**31 - 1) * 10**9)
    with pytest.raises(RecordingError, match=r'actuator/measured_js has a stamp .* after .*2038'):
        write_recording(last, tmp_path / 'bag')
    back = write_recording(replace(last, epoch_ns=last.epoch_ns - 1), tmp_path / 'bag')
    np.testing.assert_array_equal(read_recording(back)[late.name].time, late.time)


@pytest.mark.parametrize('name', ['run#1.db3', 'run?1.db3', 'run%1.db3', 'folder#1/bag'])
def test_where_sqlite_opens_nothing_is_told_and_left_clean(recording, tmp_path, name):
    out = tmp_path / name
    out.parent.mkdir(exist_ok=True)
    with pytest.raises(OutputError, match=r'SQLite cannot open a path with [#?%]; give another'):
        write_recording(recording, out, storage='sqlite3')
    assert list(out.parent.iterdir()) == []
    good = write_recording(recording, tmp_path / 'good.db3')
    with pytest.raises(RecordingError, match=r'SQLite cannot open a path with [#?%]; rename it'):
        read_recording(good.rename(out.with_suffix('.db3')))
