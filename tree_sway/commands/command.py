# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A command of ``tree-sway`` in the help, and the table of commands of a package."""

from __future__ import annotations

import sys
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
    place
        Commands of all tables are listed by it, rising.

    """

    summary: str
    example: str
    module: str
    needs: str = ''
    place: int = 0


def commands_of(package: str) -> dict[str, Command]:
    """
    Read the commands of a package by name, from its ``commands.csv``.

    The module of a command has its name and is in the package, which is given by its ``__name__``.
    """
    found = {}
    for row in table_beside(str(sys.modules[package].__file__), 'commands.csv'):
        name, needs = row.pop('name'), row.pop('needs') or ''  # an empty cell is read as None
        found[name] = Command(**row, module=f'{package}.{name}', needs=needs)
    return found
