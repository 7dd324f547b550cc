"""A simulation that diverges is a fault until the reset, whenever that is served."""

import os

import pytest

pytest.importorskip('rclpy')

import rclpy
from rclpy.signals import SignalHandlerOptions
from std_srvs.srv import Trigger

from tendon_ros.base.errors import SimulationError
from tendon_ros.model.simulation import Simulation
from tendon_ros.nodes.diagnostics import Level
from tendon_ros.nodes.live_simulation import LiveSimulation
from tendon_ros.nodes.simulator_node import SimulatorNode

#: how long anything may take on a busy machine [s]
LONG = 180.0


@pytest.fixture
def node(domain):
    rclpy.init(
        domain_id=int(os.environ['ROS_DOMAIN_ID']), signal_handler_options=SignalHandlerOptions.NO
    )
    made = SimulatorNode({'instrument': 'single_body', 'engine': 'plain'})
    yield made
    made.close()
    made.destroy_node()
    rclpy.shutdown()


def reset(node):
    """Do what the executor does when the service is called."""
    assert node._on_reset(Trigger.Request(), Trigger.Response()).success


def run_until_it_diverges(node, monkeypatch, then):
    """Run the node's thread of physics, and ``then`` before the thread knows what happened."""
    run, advance, calls = Simulation.run, LiveSimulation.advance, []

    def diverging(self, *given):
        calls.append(given)
        if len(calls) == 2:  # the first one belongs to the preparations
            raise SimulationError('body: the simulation diverged')
        return run(self, *given)

    def interrupted(self, now):
        try:
            return advance(self, now)
        except SimulationError:
            then(node)
            node.stopping.set()
            raise

    monkeypatch.setattr(Simulation, 'run', diverging)
    monkeypatch.setattr(LiveSimulation, 'advance', interrupted)
    node.begin()
    assert node.stopping.wait(LONG), 'it does not diverge'
    node.close()


def test_a_divergence_is_a_fault_until_the_reset(node, monkeypatch):
    run_until_it_diverges(node, monkeypatch, lambda _: None)
    level, text, details = node.health()
    assert (level, details['state']) == (Level.ERROR, 'FAULT')
    assert 'diverged; nothing is published until the service reset is called' in text
    reset(node)
    level, _, details = node.health()
    assert (level, details['state']) == (Level.OK, 'ENABLED')


def test_a_reset_that_is_served_before_the_divergence_is_told_holds(node, monkeypatch):
    run_until_it_diverges(node, monkeypatch, reset)
    level, _, details = node.health()
    assert (level, details['state']) == (Level.OK, 'ENABLED')
