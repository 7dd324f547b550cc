"""Ask every node of an instrument for its parameters, as they appear."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

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
        self._asked: dict[str, AsyncParameterClient] = {}

    def look(self) -> None:
        """Ask the nodes that have appeared since the last call."""
        own = self._node.get_namespace()
        for name, namespace in self._node.get_node_names_and_namespaces():
            full = f'{namespace.rstrip("/")}/{name}'
            if namespace != own or name == self._node.get_name() or name.startswith('_'):
                continue
            if full not in self._asked:
                self._asked[full] = AsyncParameterClient(self._node, full)
            elif self._asked[full] is not None and self._asked[full].services_are_ready():
                self._ask(full)

    def _ask(self, full: str) -> None:
        client, self._asked[full] = self._asked[full], None

        def on_names(answer: Any) -> None:
            names = list(answer.result().result.names)
            client.get_parameters(names, lambda values: on_values(names, values))

        def on_values(names: list[str], answer: Any) -> None:
            values = map(parameter_value_to_python, answer.result().values)
            self._hear(full, dict(zip(names, values, strict=True)))

        client.list_parameters(callback=on_names)
