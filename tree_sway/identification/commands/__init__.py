# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The command that calibrates a tree."""

from tree_sway.commands import commands_of

COMMANDS = commands_of(__name__)
