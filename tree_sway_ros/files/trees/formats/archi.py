# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
aRchi's table of cylinders (Martin-Ducup et al. 2021): numbered from 1, the root's parent 0.

A cylinder that is the ``extension_ID`` of its parent goes on with the branch.

"""

from __future__ import annotations

from pathlib import Path

from tree_sway_ros.files.table_file import parse_table
from tree_sway_ros.files.text_file import read_lines
from tree_sway_ros.files.trees.cylinders.cylinders import Cylinders, cylinder_axes
from tree_sway_ros.files.trees.tree_format import TreeFormat, has_columns


def read_archi_csv(path: Path) -> tuple[Cylinders, ...]:
    """
    Read the cylinders of an aRchi table.

    Raises
    ------
    FormatError
        A column that is missing, a cell that is no finite number, a number that stands twice.
    TreeError
        A parent that is not there.

    """
    table = parse_table(read_lines(path), str(path))
    labels, parent = table.family("cyl_ID", "parent_ID", [0, -1], "cylinder")
    number, after = table.strict(["cyl_ID", "extension_ID"]).T
    extension = table.whole(after, "extension_ID")
    continues = (parent >= 0) & (extension[parent] == number)
    return (Cylinders(*cylinder_axes(table, "radius_cyl"), parent, continues, labels),)


FORMAT = TreeFormat("archi", (), has_columns("cyl_ID", "extension_ID"), read_archi_csv)
