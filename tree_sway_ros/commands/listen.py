# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
``tree-sway listen``: count the poses that a solver streams, by a raw subscription.

`ros2 topic hz` turns every pose into a Python object and is too slow for a thousand of them.
"""

from __future__ import annotations

import argparse

from tree_sway.commands import Ending
from tree_sway_ros.commands.duration import add_seconds, seconds_of
from tree_sway_ros.commands.monitor import StreamMonitor
from tree_sway_ros.commands.text import summary
from tree_sway_ros.commands.watch import watch

_DISCOVERY, _LONGEST_WAIT = 2.0, 30.0
"""Times for the first poses [s]: until programs have found each other, and at most."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument('--namespace', default='', help="namespace of the tree's nodes")
    add_seconds(parser)
    text = 'expected poses per second [Hz] (%(default)s)'
    parser.add_argument('--rate', type=float, default=60.0, help=text)


def run(arguments: argparse.Namespace) -> int:
    """Listen until the time is over or Ctrl-C, or as long without poses."""
    seconds = seconds_of(arguments)
    with Ending() as ending, StreamMonitor(None, None, arguments.namespace) as monitor:
        ending.limit = Ending.LONGEST
        patience = min(max(seconds, _DISCOVERY), _LONGEST_WAIT)
        watch(monitor, seconds, lambda: True, patience=patience)
        print(summary(monitor.totals, arguments.rate), flush=True)
    return 0
