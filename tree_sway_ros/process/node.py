# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Base of all nodes: parameters, topics from the table, reports, failures."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from rclpy.clock import Clock, ClockType
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.lifecycle import LifecycleNodeMixin, TransitionCallbackReturn
from rclpy.node import Node
from rclpy.qos import ReliabilityPolicy
from rclpy.qos_overriding_options import QoSOverridingOptions

from tree_sway.core.wind import LONGEST_TRANSPORT
from tree_sway.errors import TreeSwayError
from tree_sway.worker import Worker
from tree_sway_ros.parameters.declaration import ParameterValues
from tree_sway_ros.parameters.node_parameters import NODE_PARAMETERS
from tree_sway_ros.process.guard import CallbackGuard
from tree_sway_ros.process.topics import DIAGNOSTICS, message_class, qos_profile, Topic
from tree_sway_ros.reports.diagnostics import OK, Status, status_array, WARN
from tree_sway_ros.timing.clock_rate import ClockRate
from tree_sway_ros.timing.pacer import Pacer, Tick

_REPORT_PERIOD = 1.0
"""Interval of reports [s] of wall time."""

_REPLAY_LIMITS = {'lead': LONGEST_TRANSPORT, 'lag': 5 * LONGEST_TRANSPORT}
"""
Further lead and lag [ns] of stamps in simulated time, at its real rate: samples and ticks of the
clock come by different ways, and wait for a busy process.

"""

_NOT_FOUND = '_NODE_NAME_UNKNOWN_'
"""What rmw calls the node of a publisher that it found first."""

_NAMELESS = 'a node not found yet'

_ENTITIES = {
    'publishers': 'destroy_publisher',
    'subscriptions': 'destroy_subscription',
    'services': 'destroy_service',
    'clients': 'destroy_client',
    'timers': 'destroy_timer',
}
"""Objects of a node, and the functions that destroy them."""


class TreeSwayNode(LifecycleNodeMixin, Node):  # type: ignore[misc]
    """
    A node with a table of parameters, found under the name of its class: `WindNode` is ``wind``.

    It is a managed node of ROS, which configures and activates itself unless the parameter
    `autostart` is false, for a manager. Options are those of `rclpy.node.Node`.
    """

    def __init__(self, **options: Any) -> None:
        name = type(self).__name__.removesuffix('Node').lower()
        # Made first: rclpy's own subscriptions and services are guarded as well.
        self.guard = CallbackGuard(lambda text: self.get_logger().error(text))
        Node.__init__(self, name, automatically_declare_parameters_from_overrides=True, **options)
        self.failure: Exception | None = None
        self.is_done = self.is_active = False
        self._refusal: Exception | None = None
        self._closers: list[Callable[[], None]] = []
        self.clock_rate = ClockRate()
        self.clock_rate.follow(self.get_clock())
        try:
            table = NODE_PARAMETERS[name]
            self.values = ParameterValues(self, table, self.on_change, self.check_values)
            self._be_managed()
            if self.values['autostart']:
                self._start_by_itself()
        except BaseException:
            self.close()
            raise

    def configure(self) -> None:
        """Open files, compile, create publishers and subscriptions; without starting them."""

    def activate(self) -> None:
        """Start threads and timers; `on_close` registers functions that stop them."""

    def on_configure(self, _state: Any) -> TransitionCallbackReturn:
        """Configure; after a failure the reason is logged, and the node stays unconfigured."""
        self._kept = {each for kind in _ENTITIES for each in getattr(self, kind)}
        if self._succeeds(self.configure):
            return TransitionCallbackReturn.SUCCESS
        self.on_cleanup(_state)
        return TransitionCallbackReturn.FAILURE

    def on_activate(self, _state: Any) -> TransitionCallbackReturn:
        """Start; after a failure the reason is logged, and the node stays inactive."""
        self.is_active = True
        if self._succeeds(self.activate):
            return TransitionCallbackReturn.SUCCESS
        self.stop()
        return TransitionCallbackReturn.FAILURE

    def on_deactivate(self, _state: Any) -> TransitionCallbackReturn:
        """Stop; topics and files stay open."""
        self.stop()
        return TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, _state: Any) -> TransitionCallbackReturn:
        """Destroy all objects of `configure`."""
        self.stop()
        for kind, destroy in _ENTITIES.items():
            for each in [each for each in getattr(self, kind) if each not in self._kept]:
                getattr(self, destroy)(each)
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, _state: Any) -> TransitionCallbackReturn:
        """Stop for good; the process ends."""
        self.stop()
        self.is_done = True
        return TransitionCallbackReturn.SUCCESS

    def _succeeds(self, stage: Callable[[], None]) -> bool:
        """Whether a stage of the start succeeds; an exception is stored and logged."""
        self._refusal = None
        try:
            stage()
        except Exception as error:
            self._refusal = error
            if self.values['autostart']:  # it is raised by the maker of the node
                return False
            if isinstance(error, TreeSwayError):
                self.get_logger().error(str(error))
            else:
                self.guard.note(error)
        return self._refusal is None

    def _start_by_itself(self) -> None:
        for stage in (self.trigger_configure, self.trigger_activate):
            stage()
            if self._refusal is not None:
                raise self._refusal

    def _be_managed(self) -> None:
        n_services = len(self._services)
        LifecycleNodeMixin.__init__(self)
        change = self._service_change_state
        change.callback = self._if_possible(change.callback)
        for service in self._services[n_services:]:
            service.callback = self.guard.wrapped(service.callback)

    def _if_possible(self, change: Callable[[Any, Any], Any]) -> Callable[[Any, Any], Any]:
        """Return ``change_state`` that refuses by a line what the state does not allow."""

        def change_or_refuse(request: Any, response: Any) -> Any:
            wanted, machine = request.transition, self._state_machine
            possible = {number: label for number, label, *_ in machine.available_transitions}
            if wanted.label in possible.values() or (not wanted.label and wanted.id in possible):
                return change(request, response)
            self.get_logger().warning(
                f'transition {wanted.label or wanted.id} is not possible in the state '
                f'{machine.current_state[1]}; possible are '
                + ', '.join(f'{label} ({number})' for number, label in possible.items())
            )
            response.success = False
            return response

        return change_or_refuse

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

    def create_steady_timer(self, period: float, callback: Any) -> None:
        """Start a timer of a period [s] of wall time, also while simulated time is paused."""
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.create_timer(period, callback, clock=steady)

    def publisher(self, topic: Topic, kind: Any = None, *, is_replay: bool | None = None) -> Any:
        """
        Make a publisher of a topic of the table, of a kind where a parameter chooses it.

        It is that of a replay in simulated time, unless that is given.
        """
        is_replay = self.is_simulated if is_replay is None else is_replay
        return self.create_publisher(
            kind or message_class(topic),
            topic.name,
            qos_profile(topic, is_replay=is_replay),
            qos_overriding_options=QoSOverridingOptions.with_default_policies(),
        )

    def subscription(self, topic: Topic, callback: Callable[..., None], kind: Any = None) -> Any:
        """
        Subscribe to a topic of the table, of a kind where a parameter chooses it.

        A reliable subscription to wind, which hears no publisher of best effort, is made again
        with best effort as soon as there is such a publisher.
        """
        message = kind or message_class(topic)

        def fall_back(_event: Any) -> None:
            if first not in self.subscriptions:
                return
            self.get_logger().warning(
                f"a publisher of '{topic.name}' is best effort: it is heard, but samples may be "
                'lost'
            )
            quality = first.qos_profile
            quality.reliability = ReliabilityPolicy.BEST_EFFORT
            self.destroy_subscription(first)
            self.create_subscription(message, topic.name, callback, quality)

        events = SubscriptionEventCallbacks(incompatible_qos=self.guard.wrapped(fall_back))
        first = self.create_subscription(
            message,
            topic.name,
            callback,
            qos_profile(topic, is_input=True, is_replay=self.is_simulated),
            event_callbacks=events if topic.replay_depth else None,
            qos_overriding_options=QoSOverridingOptions.with_default_policies(),
        )
        return first

    @property
    def is_simulated(self) -> bool:
        """Whether the clock of the node is simulated time."""
        return bool(self.get_clock().ros_time_is_active)

    @property
    def stamp_limits(self) -> dict[str, int]:
        """
        Further lead and lag of stamps in [ns], as keywords of `WindGate.offer`.

        Simulated time stops between ticks, and passes faster than messages in a fast replay.
        """
        if not self.is_simulated:
            return {'lead': 0, 'lag': 0}
        factor = self.clock_rate.factor
        return {name: round(limit * factor) for name, limit in _REPLAY_LIMITS.items()}

    def publishers_of(self, topic: str, type_name: str) -> list[str]:
        """
        Return the full names of the nodes that publish a type ``package/Name`` on a topic.

        A publisher may be found before its node is; until then its name says that.
        """
        return [
            _NAMELESS
            if each.node_name == _NOT_FOUND
            else f'{each.node_namespace.rstrip("/")}/{each.node_name}'
            for each in self.get_publishers_info_by_topic(topic)
            if each.topic_type.replace('/msg/', '/') == type_name
        ]

    def report_with(self, hardware: str, collect: Callable[[], list[Status]]) -> None:
        """
        Publish what `collect` returns on `/diagnostics` from now on.

        ``hardware`` is the subject of the report, for example the tree's name.
        """
        self._hardware = hardware
        self._collect = collect
        profile = qos_profile(DIAGNOSTICS)
        self._diagnostics = self.create_publisher(DiagnosticArray, DIAGNOSTICS.name, profile)
        self.create_steady_timer(_REPORT_PERIOD, self.report)

    def report(self) -> None:
        """Publish one report, with the failures of callbacks."""
        statuses = self._collect()
        failed = self.guard.count
        values = {'failed': failed, 'last': self.guard.latest}
        level, text = (WARN, f'{failed} failed') if failed else (OK, 'none failed')
        statuses.append(Status('callbacks', level, text, values))
        self._diagnostics.publish(
            status_array(
                statuses,
                prefix=self.get_fully_qualified_name().lstrip('/'),
                hardware=self._hardware,
                stamp=self.get_clock().now().to_msg(),
            )
        )

    def check_values(self, values: dict[str, Any]) -> None:
        """Raise `ParameterError` for values that are each in range, but inconsistent."""

    def on_change(self, values: dict[str, Any]) -> None:
        """Apply live changes of parameters; by default values are read again when needed."""

    def pacer_of(self, work: Callable[[Tick], None]) -> Pacer:
        """Make the pacer that calls `work` at the parameter `rate`, by the clock of the node."""
        return Pacer(
            self.get_clock(),
            self.values['rate'],
            work,
            self.fail,
            self.note_failure,
            self.clock_rate,
        )

    def run_worker(self, worker: Worker) -> None:
        """Start a worker thread; it stops with the node."""
        self.on_close(worker.stop)
        worker.start()

    def on_close(self, closer: Callable[[], None]) -> None:
        """Register a function for the end of the node, called in reverse order."""
        self._closers.append(closer)

    def fail(self, error: Exception) -> None:
        """Store the error that ended a thread of the node; it is raised by `spin`."""
        self.failure = error

    def note_failure(self, error: Exception) -> None:
        """Record the failure of one tick of a thread, which continues with the next."""
        if self.context.ok():  # otherwise the graph is closed, and the thread will end
            self.guard.note(error)

    def stop(self) -> None:
        """Stop the node's threads; may be called twice."""
        self.is_active = False
        while self._closers:
            self._closers.pop()()

    def destroy_node(self) -> None:
        """Leave the graph at once, and not when rclpy's state machine is collected."""
        self.clock_rate.close()
        super().destroy_node()
        if (machine := getattr(self, '_state_machine', None)) is not None:
            machine.destroy_when_not_in_use()

    def close(self) -> None:
        """Stop the node's threads and leave the graph."""
        self.stop()
        self.destroy_node()
