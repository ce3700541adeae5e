# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A command of ``tree-sway`` in the help."""

from __future__ import annotations

from typing import NamedTuple

from tree_sway.tables import table_beside


class Command(NamedTuple):
    """Summary, example and module of a command."""

    summary: str
    example: str
    module: str


def commands_beside(module: str) -> dict[str, Command]:
    """Read the commands of a package by name, from ``commands.csv`` beside a module's file."""
    return {row.pop('name'): Command(**row) for row in table_beside(module, 'commands.csv')}
