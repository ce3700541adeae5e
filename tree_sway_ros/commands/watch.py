# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Monitoring of a stream until its time is over or it is ended, with a line of statistics."""

from __future__ import annotations

from collections.abc import Callable
import sys
import time

from tree_sway.commands import waiting
from tree_sway.errors import TransportError
from tree_sway_ros.commands.monitor import StreamMonitor
from tree_sway_ros.commands.text import status_line

_SETTLING = 0.5
_LIVE_PERIOD = 0.5
_LOG_PERIOD = 2.0


def watch(
    monitor: StreamMonitor, seconds: float, check: Callable[[], bool], *, patience: float = 30.0
) -> None:
    """
    Receive for a time [s] from the first poses on, and print statistics.

    ``check`` is called repeatedly: it raises on a failure, and returns True to continue. A
    `TransportError` is raised if no poses arrive within the ``patience`` [s].
    """
    deadline = time.monotonic() + patience
    with waiting('waiting for poses'):
        while not monitor.totals.poses.count and check():
            monitor.spin(0.1)
            if time.monotonic() > deadline:
                raise TransportError(
                    f'no poses within {patience:g} s',
                    cure='is a solver running in this ROS_DOMAIN_ID? without multicast, '
                    'set ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST or ROS_STATIC_PEERS',
                )
    monitor.spin(_SETTLING)
    monitor.restart()
    begin = time.monotonic()
    is_live = sys.stdout.isatty()
    try:
        while check() and (left := begin + seconds - time.monotonic()) > 0.0:
            monitor.spin(min(_LIVE_PERIOD if is_live else _LOG_PERIOD, left))
            line = status_line(monitor.take_recent(), time.monotonic() - begin)
            if is_live:
                # `sys.stdout` escapes control sequences inside a command.
                print('\r\033[K', end='', file=sys.__stdout__, flush=True)
            print(line, end='' if is_live else '\n', flush=True)
    except KeyboardInterrupt:
        pass
    if is_live:
        print()
