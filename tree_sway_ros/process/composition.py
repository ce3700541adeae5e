# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Several nodes in one process, over real DDS: for the demo, tests and other programs.

    with Composition({"anemometer": {}, "wind": {}, "solver": {"tree": "goldcrest"}}) as nodes:
        ...
        nodes.check()
"""

from __future__ import annotations

from collections.abc import Mapping
import importlib
import threading
from typing import Any

from tree_sway.parameters import Value
from tree_sway_ros.process.spin import create, own_context

_CHECK_PERIOD = 0.2
NODES = ('anemometer', 'wind', 'solver', 'player', 'sensor', 'viewer')


def place_of(node: str) -> tuple[str, str]:
    """Return the module and the class of a node."""
    return f'tree_sway_ros.nodes.{node}', f'{node.title()}Node'


class Composition:
    """
    Nodes that share a process and an executor, in the order and with the values given.

    The ROS domain is that of the environment if None.

    Raises
    ------
    TreeSwayError
        ROS is missing or cannot start, a parameter is refused, a file cannot be read.

    """

    def __init__(
        self,
        parameters: Mapping[str, Mapping[str, Value]],
        *,
        namespace: str = '',
        domain_id: int | None = None,
    ) -> None:
        self.context = own_context(domain_id)
        from rclpy.executors import SingleThreadedExecutor

        self._nodes: dict[str, Any] = {}
        self._executor = SingleThreadedExecutor(context=self.context)
        self._is_closing = False
        self._failure: Exception | None = None
        self._thread = threading.Thread(target=self._spin, name='executor', daemon=True)
        try:
            for name, values in parameters.items():
                self.add(name, values, namespace)
        except BaseException:
            self.close()
            raise
        self._thread.start()

    def add(self, name: str, values: Mapping[str, Value], namespace: str = '') -> Any:
        """Start a further node of `NODES` in a namespace, with values of its parameters."""
        from rclpy.parameter import Parameter

        module, class_name = place_of(name)
        node = create(
            getattr(importlib.import_module(module), class_name),
            context=self.context,
            namespace=namespace,
            use_global_arguments=False,
            parameter_overrides=[Parameter(key, value=value) for key, value in values.items()],
        )
        self._nodes[f'{namespace}/{name}'.lstrip('/')] = node
        self._executor.add_node(node)
        return node

    def __getitem__(self, name: str) -> Any:
        """Return a node by its name, and namespace if it has one: ``solver``, ``oak/solver``."""
        return self._nodes[name]

    @property
    def nodes(self) -> tuple[Any, ...]:
        """Return the nodes, in the order of their start."""
        return tuple(self._nodes.values())

    def check(self) -> None:
        """Raise the error that ended the executor or the thread of a node."""
        if self._failure is not None:
            raise self._failure
        for node in self._nodes.values():
            if node.failure is not None:
                raise node.failure

    @property
    def is_done(self) -> bool:
        """Whether a node has finished, as a player at the end of its record."""
        return any(node.is_done for node in self._nodes.values())

    def close(self) -> None:
        """Stop the threads, then the executor, then leave the graph; may be called twice."""
        for node in self._nodes.values():
            node.stop()
        # The executor destroys objects that its thread waits on: end the thread first.
        self._is_closing = True
        if self._thread.is_alive():
            self._executor.wake()
            self._thread.join(timeout=5.0)
        self._executor.shutdown(timeout_sec=1.0)
        while self._nodes:
            self._nodes.popitem()[1].destroy_node()
        self.context.try_shutdown()

    def __enter__(self) -> Composition:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _spin(self) -> None:
        from rclpy.executors import ExternalShutdownException

        try:
            while self.context.ok() and not self._is_closing:
                self._executor.spin_once(timeout_sec=_CHECK_PERIOD)
        except ExternalShutdownException:
            pass
        except Exception as error:
            self._failure = error
