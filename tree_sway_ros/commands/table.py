# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The commands of the nodes, found by the entry point of the package."""

from __future__ import annotations

from tree_sway.commands.command import Command

COMMANDS: dict[str, Command] = {
    'demo': Command(
        'a tree sways in wind, all nodes in one process over real DDS',
        'demo goldcrest --speed 8 --seconds 10',
        'tree_sway_ros.commands.demo',
    ),
    'listen': Command(
        'count the poses that a solver in another process streams',
        'listen --seconds 10',
        'tree_sway_ros.commands.listen',
    ),
    'record': Command(
        'wind, state and description of a running tree as a bag',
        'record -o bag --seconds 10',
        'tree_sway_ros.commands.record',
    ),
}
