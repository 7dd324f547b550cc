"""CRTK's state topics, with messages that stand for those of crtk_msgs."""

import sys
from types import ModuleType, SimpleNamespace

import pytest

pytest.importorskip('rclpy')

from rclpy.qos import DurabilityPolicy

from tendon_ros.nodes.conversions import from_stamp
from tendon_ros.nodes.crtk import CrtkState
from tendon_ros.nodes.operating_state import OperatingState


class StateMessage(SimpleNamespace):
    """Has the fields of crtk_msgs/OperatingState."""

    def __init__(self, **fields):
        super().__init__(header=SimpleNamespace(stamp=None), **fields)


class FakeNode:
    """Notes what is created, published and logged."""

    def __init__(self):
        self.sent, self.heard, self.logged, self.qos = [], {}, [], {}

    def create_publisher(self, _, topic, qos):
        self.qos[topic] = qos
        return SimpleNamespace(publish=self.sent.append)

    def create_subscription(self, _, topic, callback, qos):
        self.heard[topic] = callback

    def get_logger(self):
        return SimpleNamespace(info=self.logged.append)


@pytest.fixture
def crtk_msgs(monkeypatch):
    package, messages = ModuleType('crtk_msgs'), ModuleType('crtk_msgs.msg')
    messages.OperatingState = StateMessage
    messages.StringStamped = SimpleNamespace
    monkeypatch.setitem(sys.modules, 'crtk_msgs', package)
    monkeypatch.setitem(sys.modules, 'crtk_msgs.msg', messages)


def test_without_the_messages_it_is_said_once_and_nothing_else_happens(monkeypatch):
    monkeypatch.setitem(sys.modules, 'crtk_msgs', None)
    node = FakeNode()
    state = CrtkState(node, OperatingState(lambda: False), lambda: False, print)
    state.publish(always=True)
    assert len(node.logged) == 1
    assert 'crtk_msgs is not installed' in node.logged[0]
    assert node.sent == []


@pytest.mark.usefixtures('crtk_msgs')
def test_busy_is_published_when_it_changes_with_stamps_that_increase():
    node, busy = FakeNode(), [False]
    state = CrtkState(node, OperatingState(lambda: False), lambda: busy[0], print)
    for now in (False, True, True, False):
        busy[0] = now
        state.publish()
    state.publish(always=True)
    assert [m.is_busy for m in node.sent] == [False, True, False, False]
    assert {(m.state, m.is_homed) for m in node.sent} == {('ENABLED', True)}
    stamps = [from_stamp(m.header.stamp) for m in node.sent]
    assert stamps == sorted(set(stamps))
    assert node.qos['operating_state'].durability == DurabilityPolicy.TRANSIENT_LOCAL


@pytest.mark.usefixtures('crtk_msgs')
def test_commands_arrive():
    node, commands = FakeNode(), []
    CrtkState(node, OperatingState(lambda: False), lambda: False, commands.append)
    node.heard['state_command'](SimpleNamespace(string='pause'))
    assert commands == ['pause']
