# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a format of tree files is to the registry: a name, a sniffer and a reader."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

from tree_sway_ros.files.trees.cylinders.cylinders import Cylinders
from tree_sway_ros.files.trees.imported_tree import TreeFile


@dataclass(frozen=True)
class TreeFormat:
    """
    A format of tree files.

    Parameters
    ----------
    name
        Its name for people and for the ``format`` option.
    suffixes
        Its usual suffixes, lower case.
    recognise
        Whether the beginning of a file, as text with all else replaced, looks like it.
    read
        Reader of such a file: of a tree, or of the cylinders of trees. Its arguments after the path
        are the format's own options.

    """

    name: str
    suffixes: tuple[str, ...]
    recognise: Callable[[str], bool]
    read: Callable[..., TreeFile | tuple[Cylinders, ...]]

    @property
    def gives_cylinders(self) -> bool:
        """Whether the reader gives cylinders, which take the options of all such formats."""
        return "Cylinders" in str(self.read.__annotations__["return"])

    @property
    def own_options(self) -> tuple[str, ...]:
        """Options of the reader itself."""
        return tuple(name for name in self.read.__annotations__ if name not in ("path", "return"))


def has_columns(*names: str) -> Callable[[str], bool]:
    """Recognise a table by the columns in its first line that is no comment."""

    def recognise(head: str) -> bool:
        for line in head.splitlines():
            if line.strip() and not line.startswith("#"):
                cells = {cell.strip(' "').lower() for cell in re.split("[,;\t]", line)}
                return all(name.lower() in cells for name in names)
        return False

    return recognise
