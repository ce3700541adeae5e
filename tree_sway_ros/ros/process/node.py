"""What the four nodes have in common: parameters, topics from the table, reports, failures."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rclpy.node import Node

from tree_sway_ros.ros.parameters.declaration import ParameterValues
from tree_sway_ros.ros.parameters.node_parameters import NODE_PARAMETERS
from tree_sway_ros.ros.process.topics import Topic, message_class, qos_profile
from tree_sway_ros.ros.reports.diagnostics import Reporter, Status


class TreeSwayNode(Node):  # type: ignore[misc]
    """
    A node with a table of parameters.

    Parameters
    ----------
    name
        Of the node; its table is found under this name, whatever the node is remapped to.
    options
        For `rclpy.node.Node`: context, namespace, parameter_overrides, ...

    """

    def __init__(self, name: str, **options: Any) -> None:
        super().__init__(name, automatically_declare_parameters_from_overrides=True, **options)
        self.failure: Exception | None = None
        self.is_done = False
        self._closers: list[Callable[[], None]] = []
        try:
            self.values = ParameterValues(self, NODE_PARAMETERS[name], self.on_change)
        except Exception:
            self.destroy_node()
            raise

    def publisher(self, topic: Topic, kind: Any = None) -> Any:
        """Publisher of a topic of the table; `kind` where a parameter chooses the type."""
        return self.create_publisher(kind or message_class(topic), topic.name, qos_profile(topic))

    def subscription(self, topic: Topic, callback: Callable[[Any], None], kind: Any = None) -> Any:
        """Subscription to a topic of the table; `kind` where a parameter chooses the type."""
        kind = kind or message_class(topic)
        return self.create_subscription(kind, topic.name, callback, qos_profile(topic))

    def report_with(self, hardware: str, collect: Callable[[], list[Status]]) -> None:
        """Publish what `collect` returns on `/diagnostics`."""
        self.reporter = Reporter(self, hardware, collect)

    def on_change(self, values: dict[str, Any]) -> None:
        """Take live changes of parameters; by default whoever needs a value reads it anew."""

    def on_close(self, closer: Callable[[], None]) -> None:
        """Have something called when the node closes, last come first served."""
        self._closers.append(closer)

    def fail(self, error: Exception) -> None:
        """Note what a thread of the node died of; whoever spins the node raises it."""
        self.failure = error

    def stop(self) -> None:
        """Stop the node's threads; may be called twice."""
        while self._closers:
            self._closers.pop()()

    def close(self) -> None:
        """Stop the node's threads and leave the graph."""
        self.stop()
        self.destroy_node()
