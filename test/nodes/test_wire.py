"""The bytes that nodes publish are the messages that ROS would have made."""

import pytest

pytest.importorskip('rclpy')

from geometry_msgs.msg import WrenchStamped
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState

from tendon_ros.base.resources import config_path
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.simulation import Simulation
from tendon_ros.nodes.conversions import from_stamp, values_of
from tendon_ros.nodes.live_simulation import LiveSimulation
from tendon_ros.nodes.wire import wires_for

STAMP = 1_700_000_000_123_456_789


def test_joint_states_come_back():
    values = {
        f'actuator/pulley_{name}/{field}': k + 0.25
        for k, (name, field) in enumerate(
            (n, f) for f in ('effort', 'position') for n in ('M', 'L', 'third_of_many')
        )
    }
    [wire] = wires_for(values)
    message = deserialize_message(wire.encode(STAMP, values), JointState)
    assert from_stamp(message.header.stamp) == STAMP
    assert len(message.velocity) == 0
    assert values_of(wire.topic, message, ()) == values


def test_messages_do_not_share_their_bytes():
    [wire] = wires_for(['pulley/pulley_1/position'])
    first = wire.encode(1, {'pulley/pulley_1/position': 1.0})
    wire.encode(2, {'pulley/pulley_1/position': 2.0})
    assert deserialize_message(first, JointState).position[0] == 1.0


@pytest.mark.parametrize('names', [['force'], ['torque'], ['force', 'torque']])
def test_wrenches_come_back_in_the_frame_of_the_tip(names):
    values = {f'load_cell/{name}': 2.5 + k for k, name in enumerate(names)}
    [wire] = wires_for(values)
    message = deserialize_message(wire.encode(STAMP, values), WrenchStamped)
    absent = dict.fromkeys(['load_cell/force', 'load_cell/torque'], 0.0)
    assert message.header.frame_id == 'tip'
    assert values_of(wire.topic, message, ()) == absent | values
    assert message.wrench.force.x == message.wrench.torque.y == 0.0


def test_joints_with_other_fields_travel_apart():
    wires = wires_for(
        ['pulley/pulley_1/position', 'pulley/pulley_2/position', 'pulley/pulley_2/effort']
    )
    assert [wire.channels for wire in wires] == [
        ('pulley/pulley_1/position',),
        ('pulley/pulley_2/position', 'pulley/pulley_2/effort'),
    ]


@pytest.mark.parametrize(
    'path', sorted(config_path('instruments').glob('*.yaml')), ids=lambda p: p.stem
)
def test_every_instrument_has_topics_for_what_it_measures(path):
    instrument = load_instrument(path)
    live = LiveSimulation(Simulation(instrument, engine='plain'), every=1, move_speed=0.5)
    live.reset(0, 0.0)
    samples = live.advance(0.0)
    carried = {name for wire in wires_for(samples.values) for name in wire.channels}
    assert samples.values.keys() <= carried
