# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Parameters of sway and simulated wind, shared by commands, pages and nodes."""

from __future__ import annotations

from pathlib import Path

from tree_sway.parameters.parameter import Parameter, read_tables

SWAY: dict[str, Parameter] = {
    each.name: each for each in read_tables(Path(__file__).with_name('sway.yaml'))['sway']
}
