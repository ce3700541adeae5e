# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Commands of many trees: studies and risk."""

from tree_sway.commands import commands_of

COMMANDS = commands_of(__name__)
