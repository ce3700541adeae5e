# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Commands of the nodes, and monitoring of a stream: messages, statistics, text.

Memory does not grow with the length of a stream.
"""

from tree_sway.commands import commands_of

COMMANDS = commands_of(__name__)
