# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Read a tree from a file of any known format.

The content decides before the suffix, as suffixes vary. A new format is one module in `formats`,
with a `FileFormat`.
"""

from __future__ import annotations

from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import numpy as np

from tree_sway.errors import ParameterError
from tree_sway.files.file_format import format_of
from tree_sway.files.kinds import expected
from tree_sway.files.paths import of_file
from tree_sway.files.trees.cylinders.cylinder_tree import tree_of_cylinders
from tree_sway.files.trees.imported_tree import TreeFile
from tree_sway.files.trees.tree_formats import TREE_FORMATS as TREE_FORMATS
from tree_sway.files.trees.tree_options import same, TreeOptions, Wood


@of_file
def read_trees(
    path: Path,
    /,
    format: str | None = None,  # noqa: A002
    *,
    head: str | None = None,
    wood: Wood = same,
    in_leaf: bool | None = None,
    **options: Any,
) -> tuple[TreeFile, ...]:
    """
    Read every tree of a file, of a given format or found from content and suffix.

    Options are those of `TreeOptions`. ``head`` is the beginning of the file if it is known;
    ``wood`` returns the species to use in place of that of the file; ``in_leaf`` is the season, by
    the species if None, in which a limb that cannot carry itself is thickened, where that is so.

    Raises
    ------
    FormatError
        A file of an unknown format, or with contents that do not match its format.
    TreeError
        An impossible tree.
    ParameterError
        An option that this format does not have, or a wrong value.

    """
    with expected(path, 'tree'):
        chosen = format_of(path, format, TREE_FORMATS, 'tree', head=head)
        chosen.refuse_others(options, [each.name for each in fields(TreeOptions)])
        wanted = TreeOptions(**{**chosen.defaults, **options})
        content = chosen.read(path)
    if isinstance(content, TreeFile):
        files = [replace(content, tree=wanted.in_metres(content.tree))]
    else:
        files = [tree_of_cylinders(wanted.in_metres(each), path) for each in content]
    if len({each.tree.name for each in files}) < len(files):
        files = [
            replace(each, tree=replace(each.tree, name=f'{each.tree.name}{number}'))
            for number, each in enumerate(files, start=1)
        ]
    if wanted.tree not in range(len(files) + 1):
        raise ParameterError(
            f'tree {wanted.tree} of {len(files)}', cure=f'give 1 to {len(files)}, or 0 for all'
        )
    if wanted.tree:
        files = [files[int(wanted.tree) - 1]]
    first, *others = read = [wanted.applied(each, wood, in_leaf) for each in files]
    places = np.array([each.tree.start[0] + each.origin for each in read])
    distances = np.linalg.norm(places[1:] - places[0], axis=1)
    in_stem = np.count_nonzero(distances < 0.5 * first.tree.base_diameter[0])
    if in_stem:
        fault = (
            f'{in_stem} more of the {len(read)} trees stand in the stem of this one: they may '
            'be models of the same tree, of which tree=1 reads the first alone'
        )
        first = replace(first, faults=(*first.faults, fault))
    return first, *others


def read_tree(path: str | Path, format: str | None = None, **options: Any) -> TreeFile:  # noqa: A002, E501
    """
    Read the tree of a file, the first of several; see `read_trees`.

    The notes of the result have the number of others.
    """
    first, *others = read_trees(path, format, **options)
    if not others:
        return first
    return replace(first, notes=(*first.notes, f'the file has {len(others)} more trees'))
