# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The life of a node's process, written once: start, spin, end.

Exit codes: 0 after Ctrl-C, SIGTERM or the end of the work, 2 with one line for an error that the
user can correct. ROS itself may be missing, so it is not imported at the top.
"""

from __future__ import annotations

from collections.abc import Sequence
import ctypes
import gc
import importlib
import os
from pathlib import Path
import sys
from typing import Any

from tree_sway.commands import Ending
from tree_sway.errors import MissingDependencyError, TransportError, TreeSwayError
from tree_sway.files.models import use_disk_cache

_REFUSALS = ('InvalidNamespaceException', 'InvalidNodeNameException', 'RCLError')
_CHECK_PERIOD = 0.2
_SWITCH_INTERVAL = 0.0005
_M_MMAP_THRESHOLD, _LARGE = -3, 1 << 20
"""Limit of glibc [bytes]: larger blocks are returned to the system when freed."""
_PROFILES = ('FASTRTPS_DEFAULT_PROFILES_FILE', 'FASTDDS_DEFAULT_PROFILES_FILE')
"""Variables for the profiles of Fast DDS 2 and 3."""


def run(module: str, node_class: str, args: Sequence[str] | None = None) -> int:
    """
    Run a node until it has finished or is ended; returns the exit code.

    Its module is imported only if ROS is there; the command line is `sys.argv` if None.
    """
    gc.disable()  # modules loaded at the start stay
    try:
        rclpy = require_rclpy()
        use_disk_cache()
        _spin(rclpy, module, node_class, args)
    except TreeSwayError as error:
        print(f'{module.rsplit(".", 1)[-1]}: {error}', file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        pass
    return 0


def require_rclpy() -> Any:
    """Import rclpy; raises a `MissingDependencyError` with a cure if it is missing."""
    try:
        return importlib.import_module('rclpy')
    except ImportError as error:
        raise MissingDependencyError(
            f'ROS 2 (rclpy) cannot be imported: {error}',
            cure='source /opt/ros/jazzy/setup.bash, or run it with python3 .ci/in_venv.py',
        ) from None


def init(
    rclpy: Any, args: Sequence[str] | None = None, profile: str = 'discovery.xml', **options: Any
) -> None:
    """
    Initialise rclpy with one of the profiles beside this file, where the environment has none.

    A `TransportError` if the domain or the arguments cannot be used.
    """
    # Pacer threads must not wait 5 ms for an executor that runs in the interpreter.
    sys.setswitchinterval(_SWITCH_INTERVAL)
    # glibc would raise the threshold to the last freed size, and memory would grow.
    if hasattr(ctypes.pythonapi, 'mallopt'):
        ctypes.pythonapi.mallopt(_M_MMAP_THRESHOLD, _LARGE)
    own = Path(__file__).with_name(profile)
    named = [os.environ.get(name) for name in _PROFILES]
    if all(Path(each or own).parent == own.parent for each in named):  # not by the user
        os.environ.update(dict.fromkeys(_PROFILES, str(own)))
    domain = os.environ.get('ROS_DOMAIN_ID', '')
    if domain and not (domain.isdecimal() and int(domain) <= 232):
        raise TransportError(
            f'ROS_DOMAIN_ID={domain} is no domain', cure='use a whole number from 0 to 101'
        )
    given = sys.argv if args is None else [sys.argv[0], *args]
    try:
        rclpy.init(args=given, **options)
    except Exception as error:  # rclpy has one class per error and no common root
        first_line = str(error).split('\n', 1)[0]
        cure = 'set ROS_LOG_DIR to a writable folder' if 'log' in first_line else ''
        raise TransportError(f'ROS 2 cannot start: {first_line}', cure=cure) from error


def own_context(domain_id: int | None = None) -> Any:
    """
    Return a context for nodes of a program that handles signals itself.

    The ROS domain is that of the environment if None. Errors are those of `require_rclpy` and
    `init`.
    """
    rclpy = require_rclpy()
    context = rclpy.context.Context()
    off = rclpy.signals.SignalHandlerOptions.NO
    init(rclpy, [], context=context, domain_id=domain_id, signal_handler_options=off)
    return context


def create(make: Any, **options: Any) -> Any:
    """Create a node; a `TransportError` if the middleware cannot join the domain."""
    try:
        return make(**options)
    except Exception as error:
        if type(error).__name__ not in _REFUSALS:
            raise
        domain = os.environ.get('ROS_DOMAIN_ID', '0')
        raise TransportError(
            f'no node in domain {domain}: {" ".join(str(error).split(", at /")[0].split())}',
            where=f"namespace '{options['namespace']}'" if options.get('namespace') else '',
            cure='names have letters, digits and _; if yours do, too many processes may be in the '
            'domain, no network up, or no security library installed',
        ) from None


def _spin(rclpy: Any, module: str, node_class: str, args: Sequence[str] | None) -> None:
    from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor

    node = None
    with Ending() as ending:
        no_handlers = rclpy.signals.SignalHandlerOptions.NO
        init(rclpy, args, 'node.xml', signal_handler_options=no_handlers)
        try:
            node = create(getattr(importlib.import_module(module), node_class))
            gc.freeze()
            gc.enable()
            ending.look()
            executor = SingleThreadedExecutor()
            executor.add_node(node)
            while not (ending.is_asked or node.is_done or node.failure) and rclpy.ok():
                executor.spin_once(timeout_sec=_CHECK_PERIOD)
            if node.failure is not None:
                raise node.failure
        except ExternalShutdownException:
            pass
        finally:
            if node is not None:
                node.close()
            rclpy.try_shutdown()
