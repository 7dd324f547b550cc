"""What a recorder hears that is sent on other terms, and what it says of what it does not hear."""

import pytest

pytest.importorskip('rclpy')

from diagnostic_msgs.msg import DiagnosticArray
from rclpy.qos import DurabilityPolicy, QoSProfile
from rosbags.highlevel import AnyReader
from rosbags.interfaces import QosDurability
from std_msgs.msg import String

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
BEFORE, LATER, SILENT = '/said_before', '/said_later', '/never_said'


@pytest.fixture
def told(client):
    """Return a function that tells how many messages of a topic the recorder has written."""
    said = client.hear('/diagnostics', DiagnosticArray)

    def count(topic):
        found = [
            value.value
            for message in said[:]
            for status in message.status
            if status.name == 'terms/recorder'
            for value in status.values
            if value.key == topic
        ]
        return int(found[-1]) if found else 0

    return count


def test_what_was_said_before_is_recorded_once_and_silence_is_named(start, client, told, tmp_path):
    before = client.node.create_publisher(String, BEFORE, LATCHED)
    before.publish(String(data='before'))
    client.hear(LATER, String)  # so that the topic is there before its publisher
    topics = ','.join((BEFORE, LATER, SILENT))
    options = ('--out', 'bag', '--topics', topics, '--ros-args', '-r', '__ns:=/terms')
    recorder = start('recorder', *options, cwd=tmp_path)
    client.wait(lambda: told(BEFORE) == 1, 'what was said before is not heard')
    client.wait(lambda: client.node.count_subscribers(LATER) == 2, 'nobody listens')
    publisher = client.node.create_publisher(String, LATER, LATCHED)
    publisher.publish(String(data='later'))
    client.wait(lambda: told(LATER) == 1, 'what was said later is not heard')
    # who asks for what was said before hears nothing of a publisher that keeps none
    client.publisher(BEFORE, String).publish(String(data='live'))
    client.wait(lambda: told(BEFORE) == 2, 'a publisher that keeps nothing is not heard')
    assert recorder.stop() == 0, recorder.said
    assert f'nothing came on {SILENT};' in recorder.said
    with AnyReader([tmp_path / 'bag']) as reader:
        found = {
            connection.topic: [
                reader.deserialize(cdr, connection.msgtype).data
                for _, _, cdr in reader.messages([connection])
            ]
            for connection in reader.connections
            if connection.topic in {BEFORE, LATER}
        }
        [profile] = next(
            connection.ext.offered_qos_profiles
            for connection in reader.connections
            if connection.topic == BEFORE
        )
    assert found == {BEFORE: ['before', 'live'], LATER: ['later']}
    assert profile.durability == QosDurability.TRANSIENT_LOCAL
