# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
``tree-sway record``: the wind of a live source as a table, or a running tree of ROS as a bag.

The first needs no ROS.
"""

from __future__ import annotations

import argparse

from tree_sway.commands.record_wind import record_wind
from tree_sway.commands.sensor_arguments import add_sensor_argument
from tree_sway.extras import refuse_missing
from tree_sway.files.recording.bag_writer import FORMATS
from tree_sway_ros.commands.duration import add_seconds, seconds_of


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add = parser.add_argument
    add('-o', '--output', required=True, metavar='FILE', help='wind.csv, or the folder of a bag')
    add_sensor_argument(parser)
    add('--force', action='store_true', help='write over an existing table')
    add('--format', choices=FORMATS, default=FORMATS[0], help='format of the bag (%(default)s)')
    add('--namespace', default='', help="namespace of the tree's nodes")
    add('--poses', action='store_true', help='also poses, markers and diagnostics: GB per hour')
    add_seconds(parser)


def run(arguments: argparse.Namespace) -> int:
    """Record until the time is over or Ctrl-C."""
    seconds = seconds_of(arguments)
    if arguments.sensor is not None:
        return record_wind(arguments, seconds)
    refuse_missing(['rclpy', 'rosbags'], 'record ...')
    from tree_sway_ros.commands.bag_recorder import record_bag

    return record_bag(arguments, seconds)
