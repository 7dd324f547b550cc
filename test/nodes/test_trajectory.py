"""The trajectory node beside motors that the test stands for: its command never jumps."""

from dataclasses import replace
import time

import numpy as np
import pytest

pytest.importorskip('rclpy')

from sensor_msgs.msg import JointState

from tendon_ros.model.instrument_file import load_instrument, save_instrument

JOINTS = ['pulley_M', 'pulley_L']


class Motors:
    """Say all the time where they are, and keep what they are commanded once they listen."""

    def __init__(self, client, namespace):
        self._client, self._topic = client, f'{namespace}/actuator/servo_jp'
        self.position = [0.0, 0.0]
        self._said = 0
        measured = client.publisher(f'{namespace}/actuator/measured_js', JointState)

        def say():
            measured.publish(JointState(name=JOINTS, position=self.position))
            self._said += 1

        self._timer = client.node.create_timer(0.01, say)

    def stand_at(self, first):
        """Be somewhere else, for long enough to have been heard there."""
        self.position = [first, 0.0]
        since = self._said
        self._client.wait(lambda: self._said > since + 20, 'the timer rests')

    def listen(self):
        """Return a list that fills with commands."""
        return self._client.hear(self._topic, JointState)

    def rest(self):
        """Say nothing any more."""
        self._client.node.destroy_timer(self._timer)


@pytest.fixture
def motors(client):
    """Return a function that makes motors in a namespace."""
    made = []

    def make(namespace):
        made.append(Motors(client, namespace))
        return made[-1]

    yield make
    for one in made:
        one.rest()


def way(heard):
    """Return time since the first command [s] and the first motor's position [rad]."""
    stamps = [message.header.stamp for message in heard]
    time = np.array([stamp.sec + 1e-9 * stamp.nanosec for stamp in stamps])
    return time - time[0], np.array([message.position[0] for message in heard])


def test_it_waits_until_its_commands_reach_somebody(start, client, motors):
    one = start('trajectory', '--repeats', 0, '--ros-args', '-r', '__ns:=/patient')
    robot = motors('/patient')
    one.wait_for('nobody takes commands')
    heard = robot.listen()
    client.wait(lambda: heard, f'nothing was commanded:\n{one.said}')
    assert one.stop() == 0, one.said


def test_the_way_begins_where_the_motors_are_when_it_begins(start, motors):
    step = ('--trajectory', 'step', '--step.duration', '0.1', '--approach', '0.5')
    one = start('trajectory', *step, '--ros-args', '-r', '__ns:=/moved')
    robot = motors('/moved')
    robot.stand_at(0.0)
    robot.stand_at(0.4)
    heard = robot.listen()
    assert one.result() == 0, one.said
    _, position = way(heard)
    assert position[0] > 0.3
    assert position.min() == 0.0


@pytest.mark.parametrize('last', ['/silent', '/nan'])
def test_nothing_is_commanded_where_nobody_knows_where_the_motors_are(start, motors, last):
    one = start('trajectory', '--patience', '5', '--ros-args', '-r', f'__ns:={last}')
    robot = motors(last)
    robot.stand_at(0.0)
    if last == '/nan':
        robot.position = [float('nan'), 0.0]
        one.wait_for('no finite position of pulley_M')
    else:
        robot.rest()
    time.sleep(1.5)
    heard = robot.listen()
    assert one.result() == 2, one.said
    assert f'{last}/actuator/measured_js: nothing measured after 5 s' in one.said
    assert heard == []


def test_a_run_is_approached_from_where_the_last_one_ended(start, motors):
    step = ('--trajectory', 'step', '--step.amplitude', '0.3', '--step.duration', '0.8')
    again = ('--repeats', '5', '--approach', '0.4')
    one = start('trajectory', *step, *again, '--ros-args', '-r', '__ns:=/again')
    heard = motors('/again').listen()
    assert one.result() == 0, one.said
    assert 'done after 5 runs' in one.said
    _, position = way(heard)
    falling = np.flatnonzero(np.diff(position) < 0.0)
    between = position[falling[position[falling] < 0.29]]
    # down four times, of which a busy machine hears the first ones perhaps too late
    assert 1 <= np.sum(np.diff(between) > 0.0) <= 3
    assert between.size > 20  # in many steps


def test_the_way_is_no_faster_than_the_motors_may_turn(start, motors, tmp_path):
    rig = load_instrument('paper_rig')
    slow = replace(rig, motors=tuple(replace(m, speed_limit=0.4) for m in rig.motors))
    save_instrument(slow, tmp_path / 'slow.yaml')
    ramp = ('--trajectory', 'ramp', '--ramp.amplitude', '0.001', '--ramp.duration', '0.6')
    options = ('--instrument', tmp_path / 'slow.yaml', *ramp, '--approach', '0.2')
    one = start('trajectory', *options, '--ros-args', '-r', '__ns:=/slow')
    robot = motors('/slow')
    robot.stand_at(0.4)
    heard = robot.listen()
    assert one.result() == 0, one.said
    time, position = way(heard)
    arrived = time[np.argmin(position > 0.0)]
    # a law of minimum jerk reaches 1.875 times its mean speed; the first commands may be lost
    assert 1.6 < arrived < 60.0
