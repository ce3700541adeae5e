# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Nodes that run no kernel start without the compiler: numba alone takes half a second to load."""

from __future__ import annotations

import subprocess
import sys

import pytest

pytest.importorskip('rclpy')

PROGRAM = """
import importlib, sys
importlib.import_module("tree_sway_ros.nodes.{}")
print([name for name in sys.modules if name == "numba" or name == "tree_sway.core.kernel"])
"""


@pytest.mark.ros
@pytest.mark.parametrize('node', ['wind', 'anemometer', 'player', 'viewer'])
def test_a_node_without_kernels_loads_no_compiler(node):
    done = subprocess.run(
        [sys.executable, '-c', PROGRAM.format(node)], capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == '[]'
