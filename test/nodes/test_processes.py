"""Nodes as processes that exchange real messages."""

import json
import math
import re
import signal
import time

import numpy as np
import pytest

pytest.importorskip('rclpy')

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import WrenchStamped
from mcap_ros2.reader import read_ros2_messages
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import DescribeParameters, SetParameters
from sensor_msgs.msg import JointState
from std_srvs.srv import SetBool, Trigger

from tendon_ros.bags.reader import read_recording
from tendon_ros.bags.topics import TOPIC_TYPES
from tendon_ros.base.recording import Channel
from tendon_ros.base.resources import config_path
from tendon_ros.estimate import build_observer, estimate_recording
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.nodes.conversions import from_stamp

NS = '/instrument'


def stamps_of(messages):
    return [from_stamp(message.header.stamp) for message in messages]


def set_parameter(client, name, value):
    """Set a number of the simulator and return the result."""
    kind = ParameterType.PARAMETER_DOUBLE
    parameter = Parameter(name=name, value=ParameterValue(type=kind, double_value=value))
    request = SetParameters.Request(parameters=[parameter])
    [result] = client.call(f'{NS}/simulator/set_parameters', SetParameters, request).results
    return result


def reset(client):
    assert client.call(f'{NS}/reset', Trigger, Trigger.Request()).success


@pytest.fixture(scope='module')
def bag(launched, client, simulator, tmp_path_factory):
    """Return the bag of a step, recorded by processes, its recorder and the estimator's resets."""
    folder = tmp_path_factory.mktemp('recorded')
    estimator = launched('estimator')
    recorder = launched('recorder', '--out', 'bag', cwd=folder)
    estimator.wait_for('ready after')
    recorder.wait_for('recording')
    # the recorder asks the nodes for their parameters; and it must hear all topics before the
    # estimator begins anew, which on a busy machine takes the discovery some seconds
    time.sleep(4.0)
    # after each of several, for a busy machine may lose messages soon after any one of them; and
    # on such a machine the discovery of the commands may take longer than a whole trajectory
    begun_after = []
    while f'first message of {NS}/actuator/servo_jp' not in recorder.said:
        trajectory = launched(
            *('trajectory', '--trajectory', 'step', '--step.amplitude', '0.05'),
            *('--step.duration', '2', '--approach', '0'),
        )
        while trajectory.process.poll() is None:
            answer = client.call(f'{NS}/estimator/reset', Trigger, Trigger.Request())
            begun_after.append(int(answer.message.split()[-2]))
            time.sleep(1.0)
        assert trajectory.result() == 0, trajectory.said
        assert len(begun_after) < 100, recorder.said
    assert recorder.stop(signal.SIGTERM) == 0, recorder.said
    assert estimator.stop(signal.SIGINT) == 0, estimator.said
    reset(client)
    return folder / 'bag', recorder.said, begun_after


def test_every_topic_of_the_contract_is_recorded(bag):
    path, said, _ = bag
    recording = read_recording(path)
    wanted = {f'actuator/pulley_{n}/{f}' for n in 'ML' for f in ('position', 'effort')}
    wanted |= {f'setpoint/pulley_{n}/position' for n in 'ML'}
    wanted |= {f'pulley/pulley_{n}/{f}' for n in '123' for f in ('position', 'velocity')}
    wanted |= {f'estimate/pulley_{n}/position' for n in '123'}
    wanted |= {'load_cell/force', 'estimate/force'}
    assert wanted <= recording.channels.keys()
    assert recording.warnings == ()
    time_ = recording['actuator/pulley_M/position'].time
    assert time_[-1] > 2.0
    assert np.median(np.diff(time_)) == pytest.approx(0.002, abs=1e-9)
    assert recording['setpoint/pulley_M/position'].value[-1] == pytest.approx(0.05)
    assert 'messages on' in said


def test_an_independent_reader_reads_the_same(bag):
    path, *_ = bag
    recording = read_recording(path)
    [file] = path.glob('*.mcap')
    efforts, topics = [], set()
    for message in read_ros2_messages(str(file)):
        topics.add(message.channel.topic)
        if message.channel.topic == f'{NS}/actuator/measured_js':
            efforts.append(message.ros_msg.effort[message.ros_msg.name.index('pulley_M')])
    assert np.array_equal(efforts, recording['actuator/pulley_M/effort'].value)
    assert {f'{NS}/{topic}' for topic in TOPIC_TYPES} <= topics | {f'{NS}/body/measured_cf_std'}
    assert f'{NS}/actuator/servo_jp' in topics


def test_a_bag_tells_how_it_was_made(bag):
    path, *_ = bag
    metadata = read_recording(path).metadata
    parameters = json.loads(metadata['parameters'])
    assert parameters[f'{NS}/simulator']['rate'] == 500.0
    assert parameters[f'{NS}/simulator']['effects.cable_L3.pretension.scale'] == 1.0
    assert parameters[f'{NS}/estimator']['method'] == 'contact_angle'
    assert json.loads(metadata['versions']).keys() == {'tendon_ros', 'python', 'rmw'}
    # how many are lost is up to the machine, but not one without being counted: stamps are even
    dropped = json.loads(metadata['dropped']).get(f'{NS}/actuator/measured_js', 0)
    recorded = read_recording(path)['actuator/pulley_M/position'].time
    assert round((recorded[-1] - recorded[0]) / 0.002) + 1 == recorded.size + dropped
    assert 'positive' in metadata['sign_convention']


def test_offline_gives_exactly_the_numbers_of_the_live_node(bag):
    path, _, begun_after = bag
    recording = read_recording(path)
    # On a busy machine recorder and estimator may each lose messages: what the filter made of
    # those is not known, so measurements have to be there without a gap, and each be answered.
    # Offline has to begin with the measurement that was the first after a reset of the live
    # node; the stamp of one that heard nothing since the reset before is 0 and tells nothing.
    resets = [(stamp - recording.epoch_ns) * 1e-9 + 1e-6 for stamp in begun_after]
    measured = recording['actuator/pulley_M/position'].time
    answers = np.append(recording['estimate/force'].time, np.inf)
    answered = np.abs(answers[np.searchsorted(answers, measured - 1e-6)] - measured) < 1e-6
    broken = np.append(np.diff(measured) > 0.003, True) | ~np.append(answered[1:], False)
    stretches = [
        (measured[first], measured[last])
        for begin, after in zip(resets, [*resets[1:], np.inf], strict=True)
        for first in [np.searchsorted(measured, begin)]
        if first < measured.size and answered[first] and measured[first] - begin < 0.003
        for last in [first + np.argmax(broken[first:])]
        for last in [min(last, np.searchsorted(measured, after) - 1)]
    ]
    begin, end = max(stretches, key=lambda stretch: stretch[1] - stretch[0], default=(0.0, 0.0))
    if end - begin < 0.5:
        pytest.skip(
            f'the machine is too busy to record more than {end - begin:.3f} s without a loss'
        )
    recording = recording.with_channels(
        Channel(c.name, c.time[kept], c.value[kept])
        for c in recording.channels.values()
        for kept in [(c.time >= begin) & (c.time <= end)]
    )
    offline = estimate_recording(
        recording, build_observer(load_instrument('paper_rig'), 'contact_angle')
    )
    for name in ('estimate/force', 'estimate/pulley_1/position', 'estimate/pulley_3/position'):
        live, again = recording[name], offline[name]
        stamps = np.rint(live.time * 1e9).astype(int)
        after = np.rint(again.time * 1e9).astype(int)
        common, mine, theirs = np.intersect1d(stamps, after, return_indices=True)
        assert common.size > 200, name
        different = np.flatnonzero(live.value[mine] != again.value[theirs])
        assert not different.size, f'{name}: sample {different[0]} of {common.size}'


def test_rate_and_stamps(client, simulator):
    heard = client.hear(f'{NS}/actuator/measured_js', JointState)
    client.wait(lambda: len(heard) > 5, 'nothing is measured')
    heard.clear()
    begin = time.monotonic()
    time.sleep(1.0)
    stamps = np.array(stamps_of(heard[:]))
    passed = time.monotonic() - begin
    assert len(stamps) > 400 * passed
    assert np.all(np.diff(stamps) > 0)
    assert np.median(np.diff(stamps)) == 2_000_000
    # the wall's clock, however late a busy machine delivers
    assert abs(stamps[-1] - time.time_ns()) < 60 * 10**9


def test_bad_commands_are_warned_of_and_the_last_is_held(client, simulator):
    reset(client)
    commands = client.publisher(f'{NS}/actuator/servo_jp', JointState)
    wished = client.hear(f'{NS}/actuator/setpoint_js', JointState)
    commands.publish(JointState(position=[0.01, 0.0]))  # as CRTK clients do: no names
    client.wait(lambda: wished and wished[-1].position[0] == 0.01, 'not taken')
    refused = simulator.said.count('actuator/servo_jp:')
    for bad in (
        JointState(name=['pulley_M', 'pulley_L'], position=[0.02]),
        JointState(name=['pulley_M'], position=[math.nan]),
        JointState(name=['elbow'], position=[0.02]),
        JointState(position=[9.0, 0.0]),
        JointState(),
    ):
        commands.publish(bad)
    simulator.wait_for('actuator/servo_jp:', refused + 1)
    time.sleep(0.2)
    assert wished[-1].position[0] == 0.01
    commands.publish(JointState(name=['1', '0'], position=[0.0, 0.03]))  # as cisst does
    client.wait(lambda: wished[-1].position[0] == 0.03, 'a good command after bad ones')
    assert wished[-1].position[1] == 0.0


def test_a_planned_motion_is_busy_then_there(client, simulator):
    reset(client)
    moves = client.publisher(f'{NS}/actuator/move_jp', JointState)
    told = client.hear('/diagnostics', DiagnosticArray)
    wished = client.hear(f'{NS}/actuator/setpoint_js', JointState)

    def busy():
        return [
            value.value
            for message in told[:]
            for status in message.status
            if status.name == 'instrument/simulator'
            for value in status.values
            if value.key == 'busy'
        ]

    moves.publish(JointState(name=['pulley_L'], position=[-0.4]))
    client.wait(lambda: 'True' in busy(), 'never busy')
    client.wait(lambda: wished[-1].position[1] == -0.4, 'never there')
    client.wait(lambda: busy()[-1] == 'False', 'busy for ever')
    assert all(
        isinstance(status.level, bytes) and len(status.level) == 1
        for message in told
        for status in message.status
    )
    path = [m.position[1] for m in wished[:]]
    assert len({round(p, 6) for p in path}) > 100


def test_an_effect_changes_what_is_measured_while_it_runs(client, simulator):
    reset(client)
    name = 'effects.load_cell.load_cell_bias.force'
    force = client.hear(f'{NS}/load_cell/body/measured_cf', WrenchStamped)
    assert set_parameter(client, name, 2.5).successful
    client.wait(lambda: force and force[-1].wrench.force.y == 2.5, 'no bias')
    assert force[-1].header.frame_id == 'tip'
    assert not set_parameter(client, name, 1e9).successful
    assert not set_parameter(client, 'rate', 100.0).successful
    assert set_parameter(client, name, 0.0).successful
    client.wait(lambda: force[-1].wrench.force.y == 0.0, 'the bias stays')


def test_parameters_are_described_with_their_range(client, simulator):
    request = DescribeParameters.Request(names=['effects.cable_L3.pretension.scale', 'rate'])
    answer = client.call(f'{NS}/simulator/describe_parameters', DescribeParameters, request)
    scale, rate = answer.descriptors
    assert 'cable_L3' in scale.description
    assert not scale.read_only
    assert scale.floating_point_range[0].from_value < 1.0 < scale.floating_point_range[0].to_value
    assert rate.read_only
    assert '[Hz]' in rate.description


def test_contact_can_be_taken_away(client, simulator):
    reset(client)
    commands = client.publisher(f'{NS}/actuator/servo_jp', JointState)
    force = client.hear(f'{NS}/load_cell/body/measured_cf', WrenchStamped)
    commands.publish(JointState(name=['pulley_M'], position=[0.08]))
    client.wait(lambda: force and force[-1].wrench.force.y > 0.5, 'no force')
    assert client.call(f'{NS}/contact', SetBool, SetBool.Request(data=False)).success
    client.wait(lambda: force[-1].wrench.force.y == 0.0, 'the contact is still there')
    assert client.call(f'{NS}/contact', SetBool, SetBool.Request(data=True)).success


def test_the_estimator_leaves_out_what_it_cannot_use(client, start):
    estimator = start('estimator', '--ros-args', '-r', '__ns:=/alone')
    estimator.wait_for('ready after')
    measured = client.publisher('/alone/actuator/measured_js', JointState)
    force = client.hear('/alone/body/measured_cf', WrenchStamped)

    def send(stamp_ms, position, names=('pulley_M', 'pulley_L')):
        message = JointState(name=list(names), position=position, effort=[0.1] * len(position))
        message.header.stamp.sec = 1000
        message.header.stamp.nanosec = stamp_ms * 10**6
        measured.publish(message)

    for number in range(1, 10):  # until the two have found each other
        send(number, [0.05, 0.0])
        time.sleep(0.3)
        if force:
            break
    force.clear()
    send(10, [0.05, 0.0])
    send(11, [math.nan, 0.0])
    send(12, [0.05])
    send(5, [0.05, 0.0])
    send(10, [0.05, 0.0])
    send(20, [0.06, 0.0])
    second = 1000 * 10**9
    client.wait(lambda: force and stamps_of(force[-1:])[0] == second + 20 * 10**6, 'no recovery')
    assert stamps_of(force) == [second + 10 * 10**6, second + 20 * 10**6]
    assert all(math.isfinite(message.wrench.force.y) for message in force)
    for text in ('is nan; left out', 'values of position', 'before the last one'):
        estimator.wait_for(text)
    assert client.call('/alone/estimator/reset', Trigger, Trigger.Request()).success
    send(1, [0.05, 0.0])
    client.wait(lambda: stamps_of(force[-1:])[0] == second + 10**6, 'not begun anew')


@pytest.mark.parametrize(
    ('node', 'arguments', 'said'),
    [
        ('trajectory', ['--instrument', 'nothing'], 'nothing: no such file'),
        (
            'trajectory',
            ['--ros-args', '-p', 'rte:=500.0'],
            "no parameter 'rte'; did you mean rate",
        ),
        ('trajectory', ['--ros-args', '-p', 'rate:=500'], 'write 500.0'),
        (
            'simulator',
            ['--ros-args', '-p', 'effects.cable_L3.pretention.scale:=0.9'],
            'did you mean effects.cable_L3.pretension.scale?',
        ),
        ('estimator', ['--method', 'magic'], 'there are contact_angle'),
        (
            'estimator',
            ['--method', 'static_balance', '--channels', 'actuator/pulley_M/effort, none'],
            "no sensor gives 'none'",
        ),
        (
            'estimator',
            ['--method', 'dynamic', '--channels', 'actuator/pulley_M/effort'],
            'choose channels with static_balance',
        ),
        ('trajectory', ['--trajectory', 'nothing'], "no trajectory 'nothing'"),
        ('trajectory', ['--step.amplitude', '3', '--trajectory', 'step'], 'position_limit'),
        (
            'trajectory',
            ['--patience', '0.3', '--ros-args', '-r', '__ns:=/no'],
            '/no/actuator/meas',
        ),
        ('in_one', ['--rte', '5'], 'unrecognized arguments: --rte 5; see `in_one --help`'),
        ('recorder', ['--out', '.'], '.: cannot be created'),
        ('recorder', ['--duration', '-1'], 'out of bounds'),
        ('recorder', ['--topics', 'good, bad topic!'], "cannot use the name 'bad topic!'"),
    ],
)
def test_a_mistake_is_one_line_and_status_2(start, node, arguments, said, tmp_path):
    one = start(node, *arguments, cwd=tmp_path)
    assert one.result() == 2
    lines = [line for line in one.lines if not line.startswith('[INFO]')]
    assert said in lines[-1]
    assert len(lines) == 1, one.said
    # a corrected command finds the place of its output free
    assert not list(tmp_path.iterdir())


def test_a_signal_ends_a_first_start_that_still_compiles(start, tmp_path, monkeypatch):
    monkeypatch.setenv('XDG_CACHE_HOME', str(tmp_path))
    one = start('simulator')
    one.wait_for('preparing')
    time.sleep(1.0)
    begin = time.monotonic()
    assert one.stop(signal.SIGINT) == 0, one.said
    assert time.monotonic() - begin < 8.0
    assert 'Traceback' not in one.said
    assert 'ready after' not in one.said


def test_an_unknown_key_of_a_parameter_file_is_an_error(start, tmp_path):
    text = config_path('nodes/rig.yaml').read_text()
    wrong = tmp_path / 'wrong.yaml'
    wrong.write_text(text.replace('method:', 'methods:'))
    one = start('estimator', '--ros-args', '--params-file', wrong)
    assert one.result() == 2
    assert "no parameter 'methods'; did you mean method?" in one.said


def test_a_recorder_stops_by_itself_after_its_duration(start, client, simulator, tmp_path):
    params = ['--ros-args', '--params-file', config_path('nodes/rig.yaml')]
    one = start('recorder', '--out', 'b', '--duration', '0.5', *params, cwd=tmp_path)
    assert one.result() == 0
    # By the stamps of its log: how much of a stream it gets in that time is up to the machine.
    began, ended = (
        float(stamp)
        for stamp in re.findall(r'\[(\d+\.\d+)\] .*(?:: recording|messages on)', one.said)
    )
    assert 0.5 <= ended - began < 60.0
    assert read_recording(tmp_path / 'b')['actuator/pulley_M/position'].time.size > 0


def test_three_nodes_in_one_process(start, client):
    force = client.hear('/together/body/measured_cf', WrenchStamped)
    params = ['--ros-args', '--params-file', config_path('nodes/rig.yaml')]
    one = start(
        *('in_one', '--trajectory', 'step', '--step.duration', '5', '--approach', '0'),
        *(*params, '-r', '__ns:=/together'),
    )
    assert one.result() == 0, one.said
    assert 'step: done after 1 runs' in one.said
    assert len(force) > 50  # of 2500; on a busy machine the discovery alone takes seconds
    assert np.all(np.diff(stamps_of(force)) > 0)
