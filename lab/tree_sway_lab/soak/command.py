# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
``tree-sway lab soak``: the whole chain through every fault of a sensor, for hours; what it costs.

Every node is a process of its own, or all are in one, as the demo has them (`chain`). ``--page``
runs a page without ROS instead, with instruments and clients (`page_soak`).
"""

from __future__ import annotations

import argparse

from tree_sway.errors import ParameterError
from tree_sway.files.trees import open_scene

_HOUR = 3600.0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add = parser.add_argument
    add('--hours', type=float, default=1.0, help='how long (%(default)s)')
    add('--tree', default='goldcrest', help='what sways (%(default)s)')
    add('--demo', action='store_true', help='all in one process, as the demo; else one per node')
    add(
        '--page',
        action='store_true',
        help='without ROS: a page with four clients, an anemometer and two motion sensors',
    )
    add('--every', type=float, default=20.0, help='seconds from fault to fault (%(default)s)')
    add(
        '--rate',
        type=float,
        default=1.0,
        metavar='K',
        help='K times as many frames and faults (%(default)s)',
    )
    add(
        '--slope',
        type=float,
        default=0.1,
        metavar='MIB',
        help='largest growth of the memory of a process after ten minutes [MiB/h] (%(default)s)',
    )


def run(arguments: argparse.Namespace) -> int:
    """Run it, then report what it took; 1 if memory grew, or something failed."""
    if not arguments.hours > 0.0:
        raise ParameterError(f'{arguments.hours:g} h is no time to run', where='--hours')
    if not 0.1 <= arguments.rate <= 10.0:
        what = f'{arguments.rate:g} is no rate within 0.1 to 10'
        raise ParameterError(what, where='--rate')
    open_scene(arguments.tree)  # refuses what is no tree
    seconds, rate = _HOUR * arguments.hours, 60.0 * arguments.rate
    if arguments.page:
        from tree_sway_lab.soak.page_soak import soak_page

        return soak_page(arguments, seconds, rate)
    from tree_sway_lab.soak.chain import soak_chain

    return soak_chain(arguments, seconds, rate)
