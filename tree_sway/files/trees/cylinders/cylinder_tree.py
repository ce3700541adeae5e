# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Cylinders of a scanned or digitised tree to a tree.

A format's own file only parses; what follows is the same for all: branches that lost their parent
are set on the nearest cylinder, cylinders of no length are left out, chains of extensions become
branches, thin twigs are corrected if asked for, and the base is moved to the origin. Each step
says what it did in a note.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from tree_sway.core.tree.building import check_numbers
from tree_sway.core.tree.parents_first import checked_order
from tree_sway.core.tree.species import species_named
from tree_sway.errors import FormatError, ParameterError
from tree_sway.files.trees.assembly import built_tree
from tree_sway.files.trees.cylinders.cylinders import Cylinders
from tree_sway.files.trees.cylinders.diameter_fit import corrected_twigs
from tree_sway.files.trees.cylinders.joining import branch_keys, join_loose_branches
from tree_sway.files.trees.cylinders.zero_length import without_zero_length
from tree_sway.files.trees.imported_tree import TreeFile

_LONGEST = {'twig_diameter': 0.1, 'trusted_diameter': 2.0}
"""Largest value of each option in [m]."""


@dataclass(frozen=True)
class CylinderOptions:
    """
    What to do with cylinders.

    Parameters
    ----------
    species
        Key of the wood.
    twig_diameter
        Measured diameter of a twig's tip in [m], to which what is thinner than `trusted_diameter`
        is made to taper; None to leave the twigs as thick as the scan has them.
    trusted_diameter
        Diameter from which on a scan is trusted in [m]; only used with `twig_diameter`.
    to_origin
        Whether to move the base of the stem to the origin.

    """

    species: str = 'broadleaf'
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

    Raises a `TreeError` for one that cannot be: no root, a cycle, several trees, what is not
    finite.
    """
    source, notes = str(path), list(cylinders.notes)
    species = species_named(options.species)
    if len(cylinders.start) == 0:
        raise FormatError('no cylinders', where=source)
    numbers = np.hstack([cylinders.start, cylinders.end, cylinders.diameter])
    check_numbers(numbers, cylinders.labels)
    order = checked_order(cylinders.parent, cylinders.labels)
    if (joined := join_loose_branches(cylinders, order)) is not None:
        cylinders = replace(cylinders, parent=joined.parent)
        order = checked_order(cylinders.parent, cylinders.labels)
        notes.append(
            f'{joined.loose} branches had no parent and were set on the nearest cylinder, '
            f'at most {joined.distance:.3g} m away'
        )
    count = len(cylinders.start)
    cylinders = without_zero_length(cylinders, order)
    if len(cylinders.start) < count:
        notes.append(f'{count - len(cylinders.start)} cylinders of no length were left out')
    tree = built_tree(
        source,
        cylinders.start,
        cylinders.end,
        cylinders.diameter,
        parent=cylinders.parent,
        branch=branch_keys(cylinders),
        labels=cylinders.labels,
        name=cylinders.name or path.stem,
        species=species.key,
    )
    if options.twig_diameter is not None:
        tree = corrected_twigs(tree, options.twig_diameter, options.trusted_diameter)
        notes.append(
            f'what is thinner than {options.trusted_diameter:g} m tapers to '
            f'{options.twig_diameter:g} m at the tips'
        )
    origin = tree.start[0].copy()
    if options.to_origin and origin.any():
        tree = replace(tree, start=tree.start - origin, end=tree.end - origin)
        notes.append(
            f'moved by {", ".join(f"{-x:.6g}" for x in origin)} m, the base to the origin'
        )
    else:
        origin = np.zeros(3)
    position = (float(origin[0]), float(origin[1]), float(origin[2]))
    return TreeFile(tree, species, source, tuple(notes), position)
