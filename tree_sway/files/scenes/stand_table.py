# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A stand from an inventory: places, species and heights, and maybe stem diameters.

Columns are recognised by their names in inventories, however they are written: ``x``, ``y`` (or
easting, northing, or latitude and longitude, in two columns or one), ``species``, ``height``;
``dbh`` at breast height or ``girth``. Further ones may be ``name``, ``z``, ``yaw`` [rad] and
``model``; a tree without a yaw has a random one. Trees are scaled from few grown ones
(`kind_classes`). Rows that lack what a tree needs are left out and counted (`inventory_of`).
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache, partial
import math
from pathlib import Path
from typing import Any

import numpy as np

from tree_sway.core.scene import PlacedTree, SCALES, Scene
from tree_sway.core.species import Species
from tree_sway.core.tree import GrownTree, rooted
from tree_sway.errors import ParameterError, TreeSwayError
from tree_sway.files.scenes.classes import kind_classes, own_kinds
from tree_sway.files.scenes.inventory.inventory_file import (
    has_own_format,
    inventory_table,
    lacking_columns,
)
from tree_sway.files.scenes.inventory.read_inventory import Inventory, inventory_of
from tree_sway.files.text_file import read_head
from tree_sway.files.trees.imported_tree import TreeFile
from tree_sway.growth import grow, height_of_stem, stem_range


def is_stand_table(head: str, path: Path) -> bool:
    """Whether the beginning of a file is an inventory; ``path`` tells those that are not text."""
    return has_own_format(path, head) or lacking_columns(head) == []


def read_stand_table(
    path: Path,
    kinds: Mapping[str, GrownTree] | None = None,
    *,
    seed: int = 0,
    exact: bool = False,
    head: str | None = None,
    **fields: Any,
) -> Scene:
    """
    Read a stand from an inventory; trees of species without a tree in ``kinds`` are grown.

    The seed is for grown trees and for yaws; further arguments are those of `Scene`. An unknown
    species is replaced as by `species_like`. With ``exact`` each tree is grown by itself, to its
    own height and diameter. ``head`` is the beginning of the file where it was read before.

    Raises
    ------
    FormatError
        No tree, or a missing column.
    TreeSwayError
        A tree that cannot be grown, an unknown model; with the line.

    """
    given = dict(kinds or {})
    table = inventory_table(path, read_head(path) if head is None else head)
    inventory = inventory_of(table, given)
    notes = list(inventory.notes)
    wood = inventory.wood
    keys = [wood[each].key if each in wood else each for each in inventory.species]
    sizes = inventory.height, inventory.diameter
    classes = own_kinds(*sizes) if exact else kind_classes(keys, *sizes)
    grown = cache(partial(_grown_kind, seed=seed, notes=notes))
    random_yaw = np.random.default_rng(seed).uniform(0.0, 2.0 * np.pi, len(keys))
    yaw = np.where(np.isnan(inventory.yaw), random_yaw, inventory.yaw)
    trees = []
    rows = zip(keys, inventory.species, *(each.tolist() for each in classes), strict=True)
    for row, (key, name, height, slenderness) in enumerate(rows):
        try:
            kind = given.get(name) or grown(wood[name], height, slenderness)
            trees.append(_placed(inventory, row, kind, key, float(yaw[row])))
        except TreeSwayError as error:
            raise error.at(inventory.where(row)) from None
    scene_fields = {'name': path.stem, 'source': str(path), 'notes': tuple(notes)}
    return Scene(trees, **scene_fields | fields)


def _placed(inventory: Inventory, row: int, kind: GrownTree, key: str, yaw: float) -> PlacedTree:
    height = float(inventory.height[row])
    scale = height / kind.tree.height
    smallest, largest = SCALES
    if not smallest <= scale <= largest:
        raise ParameterError(
            f"{height:g} m is {scale:.3g} times the height of the tree of '{key}'",
            cure=f'give {smallest:g} to {largest:g} times',
        )
    return PlacedTree(
        inventory.names[row],
        kind.tree,
        float(inventory.x[row]),
        float(inventory.y[row]),
        float(inventory.z[row]),
        scale,
        yaw=yaw,
        species=kind.species,
        model=inventory.models[row],
    )


def _grown_kind(
    species: Species, height: float, slenderness: float, seed: int, notes: list[str]
) -> GrownTree:
    """
    Grow the tree of a class, of a height [m] and height over diameter, 0 if unknown.

    A height beyond those of the habit is scaled from the nearest of them, and an impossible stem
    is made thinner or thicker, which is added to the notes.
    """
    key = species.key
    diameter = None
    possible = max(height, height_of_stem(key, 0.0))
    possible = min(possible, height_of_stem(key, math.inf))
    if possible != height:
        notes.append(f'{key} of {height:.3g} m: scaled from one of {possible:.3g} m')
    if slenderness:
        low, high = stem_range(species, possible)
        wanted = possible / slenderness
        diameter = min(max(wanted, low), high)
        if diameter != wanted:
            notes.append(
                f'{key} of {possible:.3g} m with stems of {wanted:.3g} m: grown with '
                f'{diameter:.3g} m, as others would buckle'
            )
    tree = grow(key, possible, diameter, rng=np.random.default_rng(seed))
    return TreeFile(tree, rooted(tree, species), key)
