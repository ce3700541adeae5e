# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Options of reading a tree's file of any format: units of its numbers, and corrections."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any, TypeVar

import numpy as np

from tree_sway.core.checks import one_of, within
from tree_sway.core.setup import is_in_leaf, standing_tree
from tree_sway.core.species import Species, species_named
from tree_sway.core.tree import refuse_implausible, Tree
from tree_sway.errors import TreeSwayError
from tree_sway.files.trees.cylinders.cylinders import Cylinders
from tree_sway.files.trees.cylinders.diameter_fit import corrected_twigs
from tree_sway.files.trees.imported_tree import TreeFile
from tree_sway.growth import grown_beyond, is_cut

_Shape = TypeVar('_Shape', Tree, Cylinders)
_RANGES = {
    'length_unit': (1e-6, 1e3), 'diameter_unit': (1e-6, 1e3),
    'twig_diameter': (0.0, 0.1), 'trusted_diameter': (0.0, 2.0),
}  # fmt: skip


FITTED = {'twig_diameter': None, 'thicken': True, 'to_origin': True}
"""
Defaults of formats that a program writes which fits cylinders to a scan, with the faults of one.
All others describe a tree, which is as its file states it unless a change is asked for.
"""


Wood = Callable[[Species], Species]
"""Function that returns the species to use in place of that of a file."""


def same(species: Species) -> Species:
    """Return the species of a file unchanged."""
    return species


@dataclass(frozen=True)
class TreeOptions:
    """
    Changes to the trees of a file.

    Parameters
    ----------
    species
        Key of the species; that of the file if None.
    length_unit, diameter_unit
        Units of positions and of diameters in [m].
    up
        Axis of the file that points up, ``z`` or ``y``.
    twig_diameter
        Diameter in [m] of the last twigs, which are too thick in a scan (`corrected_twigs`); that
        of the species if None, unless the scan ends at a thickness (`is_cut`), and 0 to leave all
        twigs as they are.
    trusted_diameter
        Diameter above which a scan is trusted in [m].
    beyond_scan
        ``grow`` what the scan could not see (`grown_beyond`), or ``none``.
    thicken
        Whether to thicken the limbs that cannot carry themselves in the season that the tree is
        opened for (`standing_tree`).
    to_origin
        Whether to move the base of the stem to the origin.
    tree
        Number of the tree to read, from 1 on; 0 for all.

    """

    species: str | None = None
    length_unit: float = 1.0
    diameter_unit: float = 1.0
    up: str = 'z'
    twig_diameter: float | None = 0.0
    trusted_diameter: float = 0.05
    beyond_scan: str = 'none'
    thicken: bool = False
    to_origin: bool = False
    tree: int = 0

    def __post_init__(self) -> None:
        """Check the values; a `ParameterError` gives the range."""
        for name, (low, high) in _RANGES.items():
            if getattr(self, name) is not None:
                within(name, getattr(self, name), low, high, 'm (0.01 is 1 cm)')
        one_of('up', self.up, ('z', 'y'))
        one_of('to_origin', self.to_origin, (True, False))
        one_of('beyond_scan', self.beyond_scan, ('grow', 'none'))
        one_of('thicken', self.thicken, (True, False))

    def in_metres(self, shape: _Shape) -> _Shape:
        """Return a tree, or its cylinders, in metres, z up."""
        changed = dict[str, Any]()
        for name in ('start', 'end'):
            nodes = getattr(shape, name)
            turned = nodes[:, [0, 2, 1]] * [1.0, -1.0, 1.0] if self.up == 'y' else nodes
            changed[name] = np.ascontiguousarray(self.length_unit * turned)
        for name in ('diameter', 'base_diameter', 'tip_diameter'):
            if hasattr(shape, name):
                changed[name] = self.diameter_unit * getattr(shape, name)
        return replace(shape, **changed)

    def applied(
        self,
        content: TreeFile,
        wood: Wood = same,
        in_leaf: bool | None = None,
    ) -> TreeFile:
        """
        Return a tree in metres with these options applied, and notes of the changes.

        ``wood`` returns the species to use in place of that of the file or of the option, and
        ``in_leaf`` is the season, by the species if None: what a limb can carry depends on both.
        """
        tree = content.tree
        notes = [*content.notes]
        faults = [*content.faults]
        origin = content.origin
        species = wood(content.species if self.species is None else species_named(self.species))
        twig = species.twig_diameter if self.twig_diameter is None else self.twig_diameter
        if twig > 0.0 and (self.twig_diameter is not None or not is_cut(tree)):
            tree = corrected_twigs(tree, twig, self.trusted_diameter)
        left = float(tree.volume.sum() / content.tree.volume.sum())
        if left < 1.0:
            notes.append(
                f'twigs are made {1e3 * twig:g} mm thick: {100.0 * (1.0 - left):.0f} % of the '
                'wood taken off (twig_diameter=0 leaves it)'
            )
        if self.beyond_scan == 'grow':
            own = replace(tree, species=species.key)
            tree, beyond = grown_beyond(own, twig, self.trusted_diameter)
            notes.append(beyond.sentence() if beyond else _why_nothing_grows(twig))
        if self.to_origin and tree.start[0].any():
            x, y, z = tree.start[0].tolist()
            origin = x, y, z
            tree = replace(tree, start=tree.start - origin, end=tree.end - origin)
            notes.append(f'moved by {-x:.6g}, {-y:.6g}, {-z:.6g} m, the base to the origin')
        if self.thicken:
            # Numbers that are no tree's are refused where the tree is checked or simulated.
            with suppress(TreeSwayError):
                refuse_implausible(tree, species)
                season = is_in_leaf(species, in_leaf)
                tree, thickening = standing_tree(tree, species, in_leaf=season)
                if thickening:
                    faults.append(thickening.sentence(tree))
        done = replace(content, tree=tree, notes=tuple(notes), faults=tuple(faults), origin=origin)
        return done if species is content.species else done.of_species(species)


def _why_nothing_grows(twig: float) -> str:
    """Say why nothing was grown beyond a scan, whose last twigs have a diameter [m]."""
    if twig <= 0.0:
        return 'nothing is grown beyond it: give the diameter of its twigs, twig_diameter=0.003'
    return f'nothing is grown beyond it: no end is thicker than two twigs of {1e3 * twig:g} mm'
