# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The parameters of each node, one table per node, as ``nodes.yaml`` defines them.

Those of its annexes come last in the table of the solver.
"""

from __future__ import annotations

from itertools import chain
from pathlib import Path

from tree_sway.parameters import read_tables, SWAY, Table
from tree_sway_ros.parameters.annexes import ANNEXES

NODE_PARAMETERS: dict[str, Table] = read_tables(
    Path(__file__).with_name('nodes.yaml'), tuple(SWAY.values())
)
NODE_PARAMETERS['solver'] += tuple(chain(*ANNEXES.values()))
