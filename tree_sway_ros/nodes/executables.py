# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The executables that ``ros2 run tree_sway_ros`` starts; they can be imported without ROS."""

from __future__ import annotations

from collections.abc import Sequence

from tree_sway_ros.ros.process.spin import run


def anemometer(args: Sequence[str] | None = None) -> int:
    """Run the anemometer node; returns the exit code."""
    return run("tree_sway_ros.nodes.anemometer", "AnemometerNode", args)


def wind(args: Sequence[str] | None = None) -> int:
    """Run the wind node; returns the exit code."""
    return run("tree_sway_ros.nodes.wind", "WindNode", args)


def solver(args: Sequence[str] | None = None) -> int:
    """Run the solver node; returns the exit code."""
    return run("tree_sway_ros.nodes.solver", "SolverNode", args)


def sensor(args: Sequence[str] | None = None) -> int:
    """Run the sensor node; returns the exit code."""
    return run("tree_sway_ros.nodes.sensor", "SensorNode", args)


def viewer(args: Sequence[str] | None = None) -> int:
    """Run the viewer node; returns the exit code."""
    return run("tree_sway_ros.nodes.viewer", "ViewerNode", args)


def player(args: Sequence[str] | None = None) -> int:
    """Run the player node; returns the exit code."""
    return run("tree_sway_ros.nodes.player", "PlayerNode", args)
