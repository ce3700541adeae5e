"""What the four nodes have in common: parameters, topics from the table, reports, failures."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

from rclpy.node import Node
from rclpy.qos_overriding_options import QoSOverridingOptions

from tree_sway_ros.core.wind.gate import LARGEST_LEAD
from tree_sway_ros.ros.parameters.declaration import ParameterValues
from tree_sway_ros.ros.parameters.node_parameters import NODE_PARAMETERS
from tree_sway_ros.ros.parameters.origin import own_names
from tree_sway_ros.ros.process.guard import CallbackGuard
from tree_sway_ros.ros.process.topics import Topic, message_class, qos_profile
from tree_sway_ros.ros.reports.diagnostics import WARN, Reporter, Status


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
        # Made first: rclpy's own subscriptions and services are guarded as well.
        self.guard = CallbackGuard(lambda text: self.get_logger().error(text))
        told = {each.name for each in options.get("parameter_overrides") or ()}
        if options.get("use_global_arguments", True):
            told |= own_names([*sys.argv, *(options.get("cli_args") or ())], name)
        super().__init__(name, automatically_declare_parameters_from_overrides=True, **options)
        self.failure: Exception | None = None
        self.is_done = False
        self._alone: dict[str, set[str]] = {}
        self._closers: list[Callable[[], None]] = []
        try:
            self.values = ParameterValues(
                self,
                NODE_PARAMETERS[name],
                self.on_change,
                self.check_values,
                lambda parameter: parameter in told,
            )
        except Exception:
            self.destroy_node()
            raise

    def create_subscription(
        self, kind: Any, topic: str, callback: Any, *more: Any, **named: Any
    ) -> Any:
        """Subscribe, with the guard around the callback."""
        return super().create_subscription(
            kind, topic, self.guard.wrapped(callback), *more, **named
        )

    def create_service(self, kind: Any, name: str, callback: Any, **named: Any) -> Any:
        """Offer a service, with the guard around the callback."""
        return super().create_service(kind, name, self.guard.wrapped(callback), **named)

    def create_timer(self, period: float, callback: Any, *more: Any, **named: Any) -> Any:
        """Start a timer, with the guard around the callback."""
        return super().create_timer(period, self.guard.wrapped(callback), *more, **named)

    def publisher(self, topic: Topic, kind: Any = None, *, alone: bool = False) -> Any:
        """
        Publisher of a topic of the table.

        Parameters
        ----------
        topic
            Of the table.
        kind
            Class of the messages, where a parameter chooses it.
        alone
            Whether a second publisher on the topic is a fault, to be told of.

        """
        made = self.create_publisher(
            kind or message_class(topic),
            topic.name,
            qos_profile(topic),
            qos_overriding_options=QoSOverridingOptions.with_default_policies(),
        )
        if alone:
            self._alone[made.topic_name] = set()
        return made

    def subscription(self, topic: Topic, callback: Callable[[Any], None], kind: Any = None) -> Any:
        """Subscription to a topic of the table; `kind` where a parameter chooses the type."""
        kind = kind or message_class(topic)
        return self.create_subscription(
            kind,
            topic.name,
            callback,
            qos_profile(topic),
            qos_overriding_options=QoSOverridingOptions.with_default_policies(),
        )

    @property
    def clock_lead(self) -> int:
        """How far stamps may be ahead of the clock in [ns]: simulated time stands between ticks."""
        return LARGEST_LEAD if self.get_clock().ros_time_is_active else 0

    def report_with(self, hardware: str, collect: Callable[[], list[Status]]) -> None:
        """Publish what `collect` returns on `/diagnostics`."""
        self.reporter = Reporter(self, hardware, lambda: [*collect(), *self._own_statuses()])

    def _own_statuses(self) -> list[Status]:
        """Failures of callbacks, and other publishers where there should be none."""
        statuses = []
        if self.guard.count:
            values = {"failed": self.guard.count, "last": self.guard.latest}
            statuses.append(Status("callbacks", WARN, f"{self.guard.count} failed", values))
        for topic, told in self._alone.items():
            here = [
                f"{each.node_namespace.rstrip('/')}/{each.node_name}"
                for each in self.get_publishers_info_by_topic(topic)
            ]
            if len(here) < 2:
                continue
            names = " and ".join(sorted(here))
            text = f"{len(here)} nodes publish {topic}: {names}; what they send mixes"
            statuses.append(Status("topics", WARN, text))
            if names not in told:
                told.add(names)
                self.get_logger().warning(f"{text}; end one, or give it another namespace")
        return statuses

    def check_values(self, values: dict[str, Any]) -> None:
        """Raise `ParameterError` where values that are each in range do not go together."""

    def on_change(self, values: dict[str, Any]) -> None:
        """Take live changes of parameters; by default whoever needs a value reads it anew."""

    def on_close(self, closer: Callable[[], None]) -> None:
        """Have something called when the node closes, last come first served."""
        self._closers.append(closer)

    def fail(self, error: Exception) -> None:
        """Note what a thread of the node died of; whoever spins the node raises it."""
        self.failure = error

    def slip(self, error: Exception) -> None:
        """Note what one tick of a thread failed of; it goes on with the next."""
        if self.context.ok():  # otherwise the graph is gone, and the thread about to end
            self.guard.note(error)

    def stop(self) -> None:
        """Stop the node's threads; may be called twice."""
        while self._closers:
            self._closers.pop()()

    def close(self) -> None:
        """Stop the node's threads and leave the graph."""
        self.stop()
        self.destroy_node()
