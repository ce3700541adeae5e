# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The executables that ``ros2 run tree_sway_ros`` starts; they can be imported without ROS.

The argument of each is a command line without the program's name (by default that of the process),
the result the exit code.
"""

from __future__ import annotations

from functools import partial

from tree_sway_ros.process.composition import NODES, place_of
from tree_sway_ros.process.spin import run

anemometer, wind, solver, player, sensor, viewer = (
    partial(run, *place_of(name)) for name in NODES
)
