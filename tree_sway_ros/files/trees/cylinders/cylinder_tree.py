# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Cylinders of a scanned or digitised tree to a tree.

A format's own file only parses; what follows is the same for all: branches that lost their parent
are set on the nearest cylinder, tiny cylinders are merged, chains of extensions become branches,
diameters are smoothed if asked for, and the base is moved to the origin. Each step says in a note
what it did.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from tree_sway_ros.core.tree.species import species_named
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.errors import FormatError, ParameterError, TreeError
from tree_sway_ros.files.trees.assembly import checked_order, MAX_COORDINATE, SegmentTable
from tree_sway_ros.files.trees.cylinders.cylinders import Cylinders
from tree_sway_ros.files.trees.cylinders.diameter_fit import corrected_twigs, fitted_taper
from tree_sway_ros.files.trees.cylinders.joining import branch_keys, join_loose_branches
from tree_sway_ros.files.trees.cylinders.merging import merge_tiny
from tree_sway_ros.files.trees.imported_tree import TreeFile

_LONGEST = {'merge_below': 10.0, 'twig_diameter': 0.1, 'trusted_diameter': 2.0}
"""Largest value of each option in [m]."""


@dataclass(frozen=True)
class CylinderOptions:
    """
    What to do with cylinders.

    Parameters
    ----------
    species
        Key of the wood.
    merge_below
        Cylinders shorter than this are merged with their neighbour in [m].
    taper
        Whether to replace the diameters of each branch by a robust straight taper.
    twig_diameter
        Measured diameter of a twig's tip in [m], to which what is thinner than `trusted_diameter`
        is made to taper; None to leave the twigs as thick as the scan has them.
    trusted_diameter
        Diameter from which on a scan is trusted in [m]; only used with `twig_diameter`.
    to_origin
        Whether to move the base of the stem to the origin.

    """

    species: str = 'broadleaf'
    merge_below: float = 1e-6
    taper: bool = False
    twig_diameter: float | None = None
    trusted_diameter: float = 0.05
    to_origin: bool = True

    def __post_init__(self) -> None:
        """Check the values."""
        for name in _LONGEST:
            value = getattr(self, name)
            if value is not None and not 0.0 <= value <= _LONGEST[name]:
                cure = f'give 0 to {_LONGEST[name]:g} m, 0.003 for 3 mm'
                raise ParameterError(f'{name} is {value:g} m', cure=cure)


def tree_of_cylinders(cylinders: Cylinders, path: Path, options: CylinderOptions) -> TreeFile:
    """
    Build a tree from cylinders.

    A `TreeError` tells of one that cannot be: no root, a cycle, several trees, what is not finite.
    """
    source, notes = str(path), list(cylinders.notes)
    species = species_named(options.species)
    _check(cylinders, source)
    if (joined := join_loose_branches(cylinders)) is not None:
        cylinders = replace(cylinders, parent=joined.parent)
        notes.append(
            f'{joined.loose} branches had no parent and were set on the nearest cylinder, '
            f'at most {joined.distance:.3g} m away'
        )
    order = checked_order(cylinders.parent, cylinders.labels)
    merged = merge_tiny(cylinders, order, options.merge_below)
    cylinders = merged.cylinders
    if merged.tiny:
        notes.append(
            f'{merged.tiny} cylinders shorter than {options.merge_below:g} m were merged, '
            f'{merged.dropped} of them branches of nothing else, left out'
        )
    tree = _table(cylinders).build(source, cylinders.name or path.stem, species.key)
    tree, fitted = _diameters(tree, options)
    origin = tree.start[0].copy()
    if options.to_origin and origin.any():
        tree = replace(tree, start=tree.start - origin, end=tree.end - origin)
        notes.append(
            f'moved by {", ".join(f"{-x:.6g}" for x in origin)} m, the base to the origin'
        )
    else:
        origin = np.zeros(3)
    position = (float(origin[0]), float(origin[1]), float(origin[2]))
    return TreeFile(tree, species, source, (*notes, *fitted), position)


def _check(cylinders: Cylinders, source: str) -> None:
    if len(cylinders.start) == 0:
        raise FormatError('no cylinders', where=source)
    values = np.hstack([cylinders.start, cylinders.end, cylinders.diameter])
    for index in np.flatnonzero(
        ~np.isfinite(values).all(axis=1) | (np.abs(values) > MAX_COORDINATE).any(axis=1)
    ):
        raise TreeError(
            f'a number that is not finite or too large: {values[index].tolist()}',
            where=cylinders.labels[index],
            cure='check that the columns are what they should be, in metres',
        )


def _table(cylinders: Cylinders) -> SegmentTable:
    keys = branch_keys(cylinders)
    return SegmentTable(
        start=cylinders.start.tolist(),
        end=cylinders.end.tolist(),
        diameter=cylinders.diameter.tolist(),
        parent=cylinders.parent.tolist(),
        branch=[] if keys is None else keys.tolist(),
        labels=cylinders.labels,
    )


def _diameters(tree: Tree, options: CylinderOptions) -> tuple[Tree, list[str]]:
    notes = []
    if options.taper:
        tree = fitted_taper(tree)
        notes.append("diameters of each branch are a straight taper fitted to the file's")
    if options.twig_diameter is not None:
        tree = corrected_twigs(tree, options.twig_diameter, options.trusted_diameter)
        notes.append(f'what is thinner than {options.trusted_diameter:g} m tapers to '
                     f'{options.twig_diameter:g} m at the tips')  # fmt: skip
    return tree, notes
