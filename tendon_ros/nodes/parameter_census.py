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
            client.get_parameters(names, lambda values: on_values(names, values))

        def on_values(names: list[str], answer: Any) -> None:
            values = map(parameter_value_to_python, answer.result().values)
            self._hear(full, dict(zip(names, values, strict=True)))

        client.list_parameters(callback=on_names)
