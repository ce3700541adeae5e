"""
The life of a node's process, written once: start, spin, end.

Exit codes: 0 after Ctrl-C, SIGTERM or the end of the work, 2 with one line where the user can do
something about it. ROS itself may be missing, so nothing here imports it at the top.

"""

from __future__ import annotations

import importlib
import os
import signal
import sys
from collections.abc import Sequence
from typing import Any

from tree_sway_ros.errors import MissingDependencyError, TransportError, TreeSwayError

_CHECK_PERIOD = 0.2
_SWITCH_INTERVAL = 0.0005


def run(module: str, node_class: str, args: Sequence[str] | None = None) -> int:
    """
    Run a node until it is done or told to end.

    Parameters
    ----------
    module, node_class
        Where the node is defined and what it is called; imported only if ROS is there.
    args
        Command line without the program's name; `sys.argv` if None.

    Returns
    -------
    int
        The exit code.

    """
    try:
        rclpy = require_rclpy()
        _spin(rclpy, module, node_class, args)
    except TreeSwayError as error:
        print(f"{module.rsplit('.', 1)[-1]}: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        pass
    return 0


def require_rclpy() -> Any:
    """
    Import rclpy.

    Raises
    ------
    MissingDependencyError
        If it is not there, with what to do.

    """
    try:
        return importlib.import_module("rclpy")
    except ImportError as error:
        raise MissingDependencyError(
            f"ROS 2 (rclpy) cannot be imported: {error}",
            cure="source /opt/ros/jazzy/setup.bash, or pip install 'tree_sway_ros[ros]'",
        ) from None


def init(rclpy: Any, args: Sequence[str] | None = None, **options: Any) -> None:
    """
    Initialise rclpy, with clear errors for what users meet.

    Raises
    ------
    TransportError
        If the domain or the arguments cannot be used.

    """
    # The paced threads must not wait 5 ms for an executor that holds the interpreter.
    sys.setswitchinterval(_SWITCH_INTERVAL)
    domain = os.environ.get("ROS_DOMAIN_ID", "")
    if domain and not (domain.isdecimal() and int(domain) <= 232):
        raise TransportError(
            f"ROS_DOMAIN_ID={domain} is no domain", cure="use a whole number from 0 to 101"
        )
    command = None if args is None else [sys.argv[0], *args]
    try:
        rclpy.init(args=command, **options)
    except Exception as error:  # rclpy has a class an error and no common root
        raise TransportError(f"ROS 2 cannot start: {_first_line(error)}") from error


def create(make: Any, **options: Any) -> Any:
    """
    Create a node, with a clear error where the middleware refuses.

    Raises
    ------
    TransportError
        If the middleware cannot join the domain.

    """
    try:
        return make(**options)
    except RuntimeError as error:
        if type(error).__name__ != "RCLError":
            raise
        domain = os.environ.get("ROS_DOMAIN_ID", "0")
        raise TransportError(
            f"cannot join domain {domain}: {_first_line(error)}",
            cure="too many processes may be in it, or no network is up: try another ROS_DOMAIN_ID",
        ) from error


def _spin(rclpy: Any, module: str, node_class: str, args: Sequence[str] | None) -> None:
    from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor

    node = None
    init(rclpy, args)
    try:
        # Made before anything can tell us to end: rclpy's own, made later, would say so with a
        # trace.
        executor = SingleThreadedExecutor()
        node = create(getattr(importlib.import_module(module), node_class))
        executor.add_node(node)
        while rclpy.ok() and node.failure is None and not node.is_done:
            executor.spin_once(timeout_sec=_CHECK_PERIOD)
        if node.failure is not None:
            raise node.failure
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except Exception:
        if rclpy.ok():  # otherwise told to end, amid whatever it was doing
            raise
    finally:
        # A second Ctrl-C while things close would end the process with an error.
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        if node is not None:
            node.close()
        rclpy.try_shutdown()


def _first_line(error: Exception) -> str:
    return str(error).split("\n", 1)[0]
