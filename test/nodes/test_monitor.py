"""The monitor as a process beside a simulator whose effects change while it runs."""

import math
import signal

import pytest

pytest.importorskip('rclpy')

from diagnostic_msgs.msg import DiagnosticArray
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

OK, WARN, ERROR = b'\x00', b'\x01', b'\x02'


def last(heard, name):
    """Return the last status of a name."""
    found = [s for message in list(heard) for s in message.status if s.name == name]
    return found[-1] if found else None


def value(status, key):
    return {one.key: one.value for one in status.values}.get(key, '')


def test_an_effect_that_comes_live_is_a_warning_at_its_place(client, start):
    heard = client.hear('/diagnostics', DiagnosticArray)
    ns = ('--ros-args', '-r', '__ns:=/watched')
    simulator = start('simulator', '--instrument', 'bench_rig', '--seed', 1, *ns)
    monitor = start('monitor', '--instrument', 'bench_rig', '--learn', '6.0', *ns)
    simulator.wait_for('ready after')
    monitor.wait_for('ready after')
    start(
        'trajectory', '--instrument', 'bench_rig', '--trajectory', 'multisine', '--repeats', 0, *ns
    )

    def whole():
        return last(heard, 'watched/monitor')

    def state():
        status = whole()
        return value(status, 'state') if status else ''

    client.wait(lambda: state() == 'watching', 'nothing is watched')
    assert whole().level == OK, whole().message
    assert last(heard, 'watched/monitor: load_cell/force').level == OK
    name = 'effects.pulley_3.tension_friction.coefficient'
    kind = ParameterType.PARAMETER_DOUBLE
    change = Parameter(name=name, value=ParameterValue(type=kind, double_value=0.15))
    request = SetParameters.Request(parameters=[change])
    client.call('/watched/simulator/set_parameters', SetParameters, request)
    client.wait(lambda: 'pulley_3' in value(whole(), 'where'), 'no place', seconds=90.0)
    assert whole().level == WARN
    # the first search sees the onset and may call it an event; the next one sees what lasts
    client.wait(lambda: 'friction at pulley_3' in value(whole(), 'cause 1'), 'no cause', 40.0)
    grown = last(heard, 'watched/monitor: load_cell/force')
    assert float(value(grown, 'gap [N]')) > 0.0
    monitor.wait_for('the gap has grown')
    assert client.call('/watched/monitor/reset', Trigger, Trigger.Request()).success
    client.wait(lambda: state() == 'learning', 'a reset does not begin anew')
    assert 'the gap is again' not in monitor.said  # nothing was compared
    assert simulator.stop() == 0
    client.wait(lambda: whole().level == ERROR, 'silence is no error')
    assert 'nothing for' in whole().message
    assert monitor.stop(signal.SIGINT) == 0, monitor.said
    assert 'Traceback' not in monitor.said


def test_what_cannot_be_used_is_said(client, start):
    heard = client.hear('/diagnostics', DiagnosticArray)
    monitor = start('monitor', '--ros-args', '-r', '__ns:=/unwatched')
    monitor.wait_for('ready after')
    measured = client.publisher('/unwatched/actuator/measured_js', JointState)

    def whole():
        return last(heard, 'unwatched/monitor')

    def send(stamp, position, names=('pulley_M', 'pulley_L'), effort=()):
        message = JointState(name=list(names), position=position, effort=effort)
        message.header.stamp.sec = stamp
        measured.publish(message)

    client.wait(whole, 'no diagnostics')
    assert whole().level == ERROR
    assert 'no measurement of actuator/pulley_M/position, actuator/pulley_L' in whole().message
    send(1000, [0.0, 0.0], names=('a', 'b'))
    monitor.wait_for('rename them, or give the file of this instrument')
    send(1000, [math.nan, 0.0])
    client.wait(lambda: value(whole(), 'measurements left out') == '2', 'NaN was not refused')
    send(1001, [0.0, 0.0])
    send(999, [0.0, 0.0])
    client.wait(lambda: value(whole(), 'stamps that step back') == '1', 'stepping back was not')
    monitor.wait_for('reset to begin anew')
    for second in range(1002, 1005):
        so_far = len(heard)
        client.wait(lambda n=so_far: len(heard) > n + 1, 'no diagnostics any more')
        send(second, [0.0, 0.0], effort=[math.nan, math.nan])
        reached = str(second - 999)
        client.wait(lambda n=reached: value(whole(), 'measurements left out') == n, 'no complaint')
        assert whole().level == WARN, whole().message
    assert 'effort is nan; it is left out' in whole().message
    assert client.call('/unwatched/monitor/reset', Trigger, Trigger.Request()).success


@pytest.mark.parametrize(
    ('arguments', 'words'),
    [
        (['--warm-up', '5.0'], 'warm_up: 5 s leave nothing of a window of 6 s; give at most 4.2'),
        (['--diagnosis', 'absent.json'], 'absent.json: cannot be read'),
        (['--warn-ratio', '0.5'], 'out of bounds'),
    ],
)
def test_a_mistake_is_one_line_and_status_2(start, arguments, words, tmp_path):
    one = start('monitor', *arguments, cwd=tmp_path)
    assert one.result() == 2
    assert words in one.lines[-1]
    assert len(one.lines) == 1, one.said
