"""Ask every node of an instrument for its parameters, whenever it is started."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from rcl_interfaces.msg import ParameterType
from rcl_interfaces.srv import GetParameters, GetParameterTypes, ListParameters
from rclpy.client import Client
from rclpy.node import Node
from rclpy.parameter import parameter_value_to_python

#: tells the parameters of a node: full name, values by parameter
Hearer = Callable[[str, Mapping[str, object]], None]

#: what tells a node from one that was started again under its name
Life = frozenset[tuple[int, ...]]


class ParameterCensus:
    """
    Finds the nodes of a namespace and asks each once, one that was started again too.

    :param node: who asks.
    :param hear: what answers are given to.
    """

    def __init__(self, node: Node, hear: Hearer) -> None:
        self._node = node
        self._hear = hear
        self._asked: dict[str, tuple[Life, _Interview]] = {}

    def look(self) -> None:
        """Ask the nodes that have appeared since the last call, and forget those that left."""
        living = self._living()
        for full, (life, interview) in list(self._asked.items()):
            if living.get(full) != life:
                interview.end()
                del self._asked[full]
        for full, life in living.items():
            if full not in self._asked:
                self._asked[full] = life, _Interview(self._node, full, self._hear)
            self._asked[full][1].begin()

    def _living(self) -> Mapping[str, Life]:
        """Return the other nodes of the namespace, by full name."""
        own = self._node.get_namespace()
        living: dict[str, set[tuple[int, ...]]] = {
            _full(namespace, name): set()
            for name, namespace in self._node.get_node_names_and_namespaces()
            if namespace == own and name != self._node.get_name() and not name.startswith('_')
        }
        # A restart may fall between two looks, and a killed node stays in the graph for a while:
        # names alone do not tell. Nearly every node publishes these events, each life its own.
        for end in self._node.get_publishers_info_by_topic('/parameter_events'):
            full = _full(end.node_namespace, end.node_name)
            if full in living:
                living[full].add(tuple(end.endpoint_gid))
        return {full: frozenset(ends) for full, ends in living.items()}


class _Interview:
    """Asks one node which parameters it has, which of them are set, and to what."""

    def __init__(self, node: Node, full: str, hear: Hearer) -> None:
        self._node = node
        self._full = full
        self._hear = hear
        self._begun = self._ended = False
        self._names = node.create_client(ListParameters, f'{full}/list_parameters')
        self._types = node.create_client(GetParameterTypes, f'{full}/get_parameter_types')
        self._values = node.create_client(GetParameters, f'{full}/get_parameters')

    def begin(self) -> None:
        """Ask, unless that was done or the node is not ready to answer."""
        clients = (self._names, self._types, self._values)
        if not (self._begun or self._ended) and all(c.service_is_ready() for c in clients):
            self._begun = True
            self._ask(self._names, ListParameters.Request(), self._on_names)

    def end(self) -> None:
        """Ask and hear nothing any more."""
        self._ended = True
        for client in (self._names, self._types, self._values):
            self._node.destroy_client(client)

    def _ask(self, client: Client, request: Any, then: Callable[[Any], None]) -> None:

        def on_answer(answer: Any) -> None:
            # it may have waited for its turn while the node left
            if not self._ended:
                then(answer.result())

        client.call_async(request).add_done_callback(on_answer)

    def _on_names(self, answer: Any) -> None:
        names = list(answer.result.names)
        self._ask(
            self._types,
            GetParameterTypes.Request(names=names),
            lambda types: self._on_types(names, types),
        )

    def _on_types(self, names: list[str], answer: Any) -> None:
        # asked for one that is declared and not set, a node answers with no value of any
        kinds = zip(names, answer.types, strict=False)
        known = [name for name, kind in kinds if kind != ParameterType.PARAMETER_NOT_SET]
        self._ask(
            self._values,
            GetParameters.Request(names=known),
            lambda values: self._on_values(known, values),
        )

    def _on_values(self, names: list[str], answer: Any) -> None:
        values = list(map(parameter_value_to_python, answer.values))
        if len(values) != len(names):  # one was taken back between two questions
            self._begun = False
            return
        self.end()
        self._hear(self._full, dict(zip(names, values, strict=True)))


def _full(namespace: str, name: str) -> str:
    return f'{namespace.rstrip("/")}/{name}'
