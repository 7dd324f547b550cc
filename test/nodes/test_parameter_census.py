"""Whoever takes the census hears what is set of each node, and again of one that is restarted."""

import os
import time

import pytest

pytest.importorskip('rclpy')

from rcl_interfaces.msg import ListParametersResult, ParameterType, ParameterValue
from rcl_interfaces.srv import GetParameters, GetParameterTypes, ListParameters
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
        #: full name and parameters of each node, as they were told
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

    @property
    def seen(self):
        """Full names of the nodes that are known."""
        known = self.asker.get_node_names_and_namespaces()
        return {f'{namespace}/{name}' for name, namespace in known}

    @property
    def gains(self):
        """What the census told of the drivers."""
        return [values['gain'] for _, values in self.heard]

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


def test_a_node_that_takes_a_parameter_back_while_it_is_asked_is_asked_again(stage):
    node = stage.add('driver', start_parameter_services=False)
    answers = [[], [ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=2.0)]]

    def names(_, response):
        response.result = ListParametersResult(names=['gain'])
        return response

    def types(_, response):
        response.types = [ParameterType.PARAMETER_DOUBLE]
        return response

    def values(_, response):
        response.values = answers.pop(0)
        return response

    for kind, service, answer in (
        (ListParameters, 'list_parameters', names),
        (GetParameterTypes, 'get_parameter_types', types),
        (GetParameters, 'get_parameters', values),
    ):
        node.create_service(kind, f'driver/{service}', answer)
    stage.look_until(lambda: stage.heard, 'not asked again')
    assert stage.heard == [('/census/driver', {'gain': 2.0})]


def test_a_node_that_left_and_comes_back_is_asked_again(stage):
    first = driver(stage, 1.0)
    stage.look_until(lambda: stage.heard, 'nothing heard')
    stage.remove(first)
    stage.look_until(lambda: '/census/driver' not in stage.seen, 'it does not leave')
    driver(stage, 2.0)
    stage.look_until(lambda: stage.gains[-1] == 2.0, 'not asked again')


def test_a_node_that_is_restarted_between_two_looks_is_asked_again(stage):
    first = driver(stage, 1.0)
    stage.look_until(lambda: stage.heard, 'nothing heard')
    stage.remove(first)
    driver(stage, 2.0)
    stage.look_until(lambda: stage.gains[-1] == 2.0, 'not asked again')


def test_nothing_is_left_of_who_was_asked_or_left(stage):
    driver(stage, 1.0)
    mute = stage.add('mute', start_parameter_services=False)
    stage.look_until(lambda: stage.heard, 'nothing heard')
    stage.look_until(lambda: '/census/mute' in stage.seen, 'it does not appear')
    assert {client.srv_name.split('/')[2] for client in stage.asker.clients} == {'mute'}
    stage.remove(mute)
    stage.look_until(lambda: not list(stage.asker.clients), 'clients are left')
    assert len(stage.heard) == 1


def test_an_answer_that_is_served_after_its_node_left_is_let_go(stage, monkeypatch):
    scheduled = []
    create_task = stage.executor.create_task
    monkeypatch.setattr(
        stage.executor, 'create_task', lambda *given: scheduled.append(create_task(*given))
    )
    first = driver(stage, 1.0)
    stage.look_until(lambda: scheduled, 'no answer')
    stage.remove(first)
    end = time.monotonic() + LONG
    while '/census/driver' in stage.seen:
        assert time.monotonic() < end, 'it does not leave'
        time.sleep(0.01)
    stage.census.look()
    stage.executor.spin_once(timeout_sec=0.05)
    assert scheduled
    assert stage.heard == []
