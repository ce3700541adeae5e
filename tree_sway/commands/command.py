# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A command of ``tree-sway`` in the help."""

from __future__ import annotations

from typing import NamedTuple

from tree_sway.tables import table_beside


class Command(NamedTuple):
    """
    A command of ``tree-sway``.

    Parameters
    ----------
    summary, example
        Texts for its help.
    module
        Module with its arguments and its function.
    needs
        Modules of other packages that it cannot run without, separated by spaces.

    """

    summary: str
    example: str
    module: str
    needs: str = ''


def commands_beside(module: str) -> dict[str, Command]:
    """Read the commands of a package by name, from ``commands.csv`` beside a module's file."""
    found = {}
    for row in table_beside(module, 'commands.csv'):
        name, needs = row.pop('name'), row.pop('needs') or ''  # an empty cell is read as None
        found[name] = Command(**row, needs=needs)
    return found
