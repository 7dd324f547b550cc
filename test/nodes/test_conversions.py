"""Messages to numbers: as clients really send them, and what is refused."""

import math

import pytest

pytest.importorskip('rclpy')

from geometry_msgs.msg import WrenchStamped
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import JointState

from tendon_ros.nodes.conversions import (
    from_stamp,
    joint_values,
    MessageError,
    to_stamp,
    values_of,
    wanted_positions,
)
from tendon_ros.nodes.diagnostics import diagnostic_array, Level

JOINTS = ('pulley_M', 'pulley_L')
TOPIC = 'actuator/measured_js'


def sent(message):
    """Return a message as it arrives."""
    return deserialize_message(serialize_message(message), type(message))


@pytest.mark.parametrize('ns', [0, 1, 999_999_999, 10**9, 1_700_000_000_123_456_789])
def test_stamps_survive(ns):
    assert from_stamp(to_stamp(ns)) == ns


@pytest.mark.parametrize(
    ('names', 'position', 'wanted'),
    [
        (['pulley_M', 'pulley_L'], [1.0, 2.0], {'pulley_M': 1.0, 'pulley_L': 2.0}),
        (['pulley_L', 'pulley_M'], [1.0, 2.0], {'pulley_L': 1.0, 'pulley_M': 2.0}),
        ([], [1.0, 2.0], {'pulley_M': 1.0, 'pulley_L': 2.0}),
        (['1', '0'], [1.0, 2.0], {'pulley_L': 1.0, 'pulley_M': 2.0}),
        (['pulley_L'], [2.0], {'pulley_L': 2.0}),
    ],
)
def test_commands_are_taken_as_clients_send_them(names, position, wanted):
    assert wanted_positions(sent(JointState(name=names, position=position)), JOINTS) == wanted


@pytest.mark.parametrize(
    ('names', 'position'),
    [
        ([], []),
        ([], [1.0]),
        ([], [1.0, 2.0, 3.0]),
        (['pulley_M'], [1.0, 2.0]),
        (['pulley_M', 'pulley_L'], [1.0]),
        (['pulley_M', 'pulley_M'], [1.0, 2.0]),
        (['pulley_M', 'elbow'], [1.0, 2.0]),
        (['0', '2'], [1.0, 2.0]),
        (['pulley_M', 'pulley_L'], [1.0, math.nan]),
        ([], [math.inf, 0.0]),
    ],
)
def test_commands_that_make_no_sense_are_refused(names, position):
    with pytest.raises(MessageError):
        wanted_positions(sent(JointState(name=names, position=position)), JOINTS)


def test_measured_joints_become_channels_and_empty_fields_stay_absent():
    message = sent(JointState(name=list(JOINTS), position=[1.0, 2.0], effort=[3.0, 4.0]))
    assert joint_values(TOPIC, message, JOINTS) == {
        'actuator/pulley_M/position': 1.0,
        'actuator/pulley_L/position': 2.0,
        'actuator/pulley_M/effort': 3.0,
        'actuator/pulley_L/effort': 4.0,
    }


@pytest.mark.parametrize(
    'fields',
    [
        {'name': ['pulley_M'], 'position': [1.0, 2.0]},
        {'name': list(JOINTS), 'position': [1.0, 2.0], 'effort': [1.0]},
        {'name': [], 'position': [1.0]},
    ],
)
def test_measured_joints_of_wrong_length_are_refused(fields):
    with pytest.raises(MessageError, match=TOPIC):
        joint_values(TOPIC, sent(JointState(**fields)), JOINTS)


def test_a_wrench_is_force_y_and_torque_z():
    message = WrenchStamped()
    message.wrench.force.y = 1.5
    message.wrench.torque.z = -2.5
    values = values_of('load_cell/body/measured_cf', sent(message), ())
    assert values == {'load_cell/force': 1.5, 'load_cell/torque': -2.5}


@pytest.mark.parametrize('level', list(Level))
def test_levels_of_diagnostics_are_the_bytes_of_the_message(level):
    message = diagnostic_array(7, 'instrument/simulator', level, 'text', {'rate': 500, 'x': 0.1})
    [status] = sent(message).status
    assert status.level == level.value
    assert {v.key: v.value for v in status.values} == {'rate': '500', 'x': '0.1'}
    assert status.hardware_id == 'instrument'
