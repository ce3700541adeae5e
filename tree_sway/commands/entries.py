# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What houses and other packages bring to the command line, by entry points.

``tree_sway.commands`` names tables of commands. Those of this distribution are one table; another
package's is called by the name of its entry point, as ``tree-sway lab``. ``tree_sway.COMMAND``
names what is added to a command: its module says what that is.
"""

from __future__ import annotations

from collections.abc import Iterable
from importlib.metadata import distribution, entry_points, EntryPoint, PackageNotFoundError
from typing import Any

from tree_sway.commands.command import Command
from tree_sway.errors import MissingDependencyError
from tree_sway.extras import loaded, PACKAGE

GROUP = 'tree_sway.commands'


def own_commands() -> tuple[dict[str, Command], list[str]]:
    """Return the commands of this distribution in their order, and whose are not there."""
    tables, missing = _loaded(_own())
    commands = [each for table in tables for each in table.items()]
    table = dict(sorted(commands, key=lambda each: each[1].place))
    return table, missing if table else [PACKAGE]


def commands_called(group: str) -> dict[str, Command] | None:
    """Return the commands of another package by the name of its entry point; None without."""
    own = _own()
    points = (each for each in entry_points(group=GROUP) if each not in own)
    return next((loaded(each) for each in points if each.name == group), None)


def other_groups() -> list[str]:
    """Return the names by which commands of other packages are called."""
    own = _own()
    return sorted({each.name for each in entry_points(group=GROUP) if each not in own})


def additions(command: str) -> list[Any]:
    """Return what is added to a command, in the order of the names of its entry points."""
    points = entry_points(group=f'tree_sway.{command}')
    return _loaded(sorted(points, key=lambda each: each.name))[0]


def _own() -> list[EntryPoint]:
    """Entry points of the tables of this distribution, which is found without the others."""
    try:
        return [each for each in distribution(PACKAGE).entry_points if each.group == GROUP]
    except PackageNotFoundError:
        return []


def _loaded(points: Iterable[EntryPoint]) -> tuple[list[Any], list[str]]:
    """Load entry points, and return the names of those whose package is not there."""
    found, missing = list[Any](), list[str]()
    for point in points:
        try:
            found.append(loaded(point))
        except MissingDependencyError as error:
            module = getattr(error.__cause__, 'name', None)
            if not f'{point.module}.'.startswith(f'{module}.'):
                raise
            missing.append(point.name)
    return found, missing
