"""Whoever takes the census hears what is set of each node."""

import os
import time

import pytest

pytest.importorskip('rclpy')

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter

from tendon_ros.nodes.parameter_census import ParameterCensus

#: how long anything may take on a busy machine [s]
LONG = 180.0


class Stage:
    """Nodes that are served in turn, and a census that looks among them."""

    def __init__(self):
        self.context = rclpy.Context()
        self.context.init(domain_id=int(os.environ['ROS_DOMAIN_ID']))
        self.executor = SingleThreadedExecutor(context=self.context)
        self.asker = self.add('recorder')
        self.heard = []
        self.census = ParameterCensus(self.asker, lambda *told: self.heard.append(told))

    def add(self, name, **options):
        """Return a new node."""
        made = rclpy.create_node(name, namespace='/census', context=self.context, **options)
        self.executor.add_node(made)
        return made

    def remove(self, node):
        """End a node."""
        self.executor.remove_node(node)
        node.destroy_node()

    def look_until(self, condition, why):
        """Look and serve until something is true."""
        end = time.monotonic() + LONG
        while not condition():
            assert time.monotonic() < end, why
            self.census.look()
            self.executor.spin_once(timeout_sec=0.05)

    def close(self):
        """End all nodes."""
        self.executor.shutdown()
        self.context.shutdown()


@pytest.fixture
def stage(domain):
    made = Stage()
    yield made
    made.close()


def driver(stage, gain):
    """Return a node with one parameter."""
    node = stage.add('driver')
    node.declare_parameter('gain', gain)
    return node


def test_what_is_declared_and_not_set_is_left_out(stage):
    driver(stage, 2.0).declare_parameter('offset', Parameter.Type.DOUBLE)
    stage.look_until(lambda: stage.heard, 'nothing heard')
    [(name, values)] = stage.heard
    assert name == '/census/driver'
    assert values['gain'] == 2.0
    assert 'offset' not in values
