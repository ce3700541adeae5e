# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a format of tree files is to the registry: a name, a sniffer and a reader."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tree_sway.files.file_format import FileFormat
from tree_sway.files.trees.cylinders.cylinders import Cylinders
from tree_sway.files.trees.imported_tree import TreeFile

MEASURED = {'twig_diameter': 0.0}
"""Defaults of forms whose twigs are no thicker than they are."""

AS_IT_IS = {'to_origin': False, **MEASURED}
"""Defaults of our own forms, whose trees are also where they are meant to be."""


@dataclass(frozen=True)
class TreeFormat(FileFormat):
    """
    A format of tree files, whose reader gives a tree, or the cylinders of trees.

    ``defaults`` are those of its options that are not as in `TreeOptions`.
    """

    read: Callable[[Path], TreeFile | tuple[Cylinders, ...]]
    defaults: Mapping[str, Any] = field(default_factory=dict)
