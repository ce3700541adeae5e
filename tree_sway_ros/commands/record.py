# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
``tree-sway record``: live wind as a table, wind and motion of a tree, or a running tree as a bag.

Only the last needs ROS.
"""

from __future__ import annotations

import argparse

from tree_sway.errors import ParameterError
from tree_sway.extras import refuse_missing
from tree_sway.files.recording import FORMATS
from tree_sway.live.commands import (
    add_live_motion_arguments,
    add_sensor_argument,
    record_tree,
    record_wind,
)
from tree_sway_ros.commands.duration import add_seconds, seconds_of


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add = parser.add_argument
    add(
        '-o', '--output', required=True, metavar='FILE',
        help='wind.csv, the folder of a record with motion, or that of a bag',
    )  # fmt: skip
    add_sensor_argument(parser, '--wind')
    add_live_motion_arguments(parser)
    add('--tree', metavar='TREE', help='the real tree, for a record with motion: file or name')
    add('--force', action='store_true', help='write over an existing table')
    add('--format', choices=FORMATS, default=FORMATS[0], help='format of the bag (%(default)s)')
    add('--namespace', default='', help="namespace of the tree's nodes")
    add('--poses', action='store_true', help='also poses, markers and diagnostics: GB per hour')
    add_seconds(parser)


def run(arguments: argparse.Namespace) -> int:
    """Record until the time is over or Ctrl-C."""
    seconds = seconds_of(arguments)
    if arguments.motion:
        return record_tree(arguments, seconds)
    if arguments.sensor is not None:
        return record_wind(arguments, seconds)
    if arguments.output.endswith('.csv'):
        cure = 'add --sensor SOURCE, or name the folder of a bag'
        raise ParameterError('a table, and no wind for it', where=arguments.output, cure=cure)
    refuse_missing(['rclpy', 'rosbags'], 'record ...')
    from tree_sway_ros.commands.bag_recorder import record_bag

    return record_bag(arguments, seconds)
