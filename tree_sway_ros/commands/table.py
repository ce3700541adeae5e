# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The commands of the nodes, for the entry point of the package."""

from __future__ import annotations

from tree_sway.commands import commands_beside

COMMANDS = commands_beside(__file__)
