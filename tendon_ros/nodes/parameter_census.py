"""Ask every node of an instrument for its parameters, as they appear."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from rcl_interfaces.msg import ParameterType
from rclpy.node import Node
from rclpy.parameter import parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient

#: tells the parameters of a node: full name, values by parameter
Hearer = Callable[[str, Mapping[str, object]], None]


class ParameterCensus:
    """
    Finds the nodes of a namespace and asks each once.

    :param node: who asks.
    :param hear: what answers are given to.
    """

    def __init__(self, node: Node, hear: Hearer) -> None:
        self._node = node
        self._hear = hear
        self._waiting: dict[str, AsyncParameterClient | None] = {}

    def look(self) -> None:
        """Ask the nodes that have appeared since the last call."""
        own = self._node.get_namespace()
        for name, namespace in self._node.get_node_names_and_namespaces():
            full = f'{namespace.rstrip("/")}/{name}'
            if namespace != own or name == self._node.get_name() or name.startswith('_'):
                continue
            if full not in self._waiting:
                self._waiting[full] = AsyncParameterClient(self._node, full)
            client = self._waiting[full]
            if client is not None and client.services_are_ready():
                self._waiting[full] = None
                self._ask(full, client)

    def _ask(self, full: str, client: AsyncParameterClient) -> None:

        def on_names(answer: Any) -> None:
            names = list(answer.result().result.names)
            client.get_parameter_types(names, lambda types: on_types(names, types))

        def on_types(names: list[str], answer: Any) -> None:
            # asked for one that is declared and not set, a node answers with no value of any
            kinds = zip(names, answer.result().types, strict=False)
            known = [name for name, kind in kinds if kind != ParameterType.PARAMETER_NOT_SET]
            client.get_parameters(known, lambda values: on_values(known, values))

        def on_values(names: list[str], answer: Any) -> None:
            values = list(map(parameter_value_to_python, answer.result().values))
            if len(values) == len(names):
                self._hear(full, dict(zip(names, values, strict=True)))
            else:  # one was taken back between two questions
                self._waiting[full] = client

        client.list_parameters(callback=on_names)
