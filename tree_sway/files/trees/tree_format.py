# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a format of tree files is to the registry: a name, a sniffer and a reader."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from tree_sway.files.file_format import FileFormat
from tree_sway.files.trees.cylinders.cylinders import Cylinders
from tree_sway.files.trees.imported_tree import TreeFile


@dataclass(frozen=True)
class TreeFormat(FileFormat):
    """A format of tree files, whose reader gives a tree, or the cylinders of trees."""

    read: Callable[..., TreeFile | tuple[Cylinders, ...]]

    @property
    def gives_cylinders(self) -> bool:
        """Whether the reader gives cylinders, which take the options of all such formats."""
        return 'Cylinders' in str(self.read.__annotations__['return'])
