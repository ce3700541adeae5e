# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Commands that draw: pictures and films."""

from tree_sway.commands import commands_of

COMMANDS = commands_of(__name__)
