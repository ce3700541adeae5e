# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A stand from an inventory: a table of places, species and heights, and maybe of stem diameters.

Columns are recognised by their names in inventories: ``x``, ``y`` (or easting, northing, or
latitude and longitude in degrees, in two columns or one), ``species``, ``height``; ``dbh`` at
breast height or ``girth``, in cm where no unit is given and they are not fractions of a metre.
Missing heights are those of grown trees of that diameter. Further ones may be ``name``, ``z``,
``yaw`` [rad] and ``model``; a tree without a name has that of its row, one without a yaw has a
random one. Trees are scaled from few grown ones: those of one species whose heights are within a
factor of three, and height over diameter within a factor of 1.3, share one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
import math
from pathlib import Path
import re
from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.growth.grow import grow, height_of_stem, stem_range
from tree_sway.core.scene.placed_tree import LARGEST, PlacedTree, SMALLEST
from tree_sway.core.scene.scene import Scene
from tree_sway.core.tree.grown_tree import GrownTree, rooted
from tree_sway.core.tree.species import Species, species_like
from tree_sway.errors import FormatError, ParameterError, TreeSwayError
from tree_sway.files.column_names import COLUMNS
from tree_sway.files.scenes.tree_names import refuse_same_names
from tree_sway.files.table_file import Column, parse_table, TextTable
from tree_sway.files.text_file import read_lines
from tree_sway.files.trees.imported_tree import TreeFile

_EARTH = 6.371e6
_NUMBER = re.compile(r'-?\d+(?:\.\d+)?')
_FAR = 1e5
_HEIGHTS, _SLENDERNESSES = 3.0, 1.3
_NEEDED = {
    'the place (x and y, or latitude and longitude)': (
        ('x', 'y'), ('latitude', 'longitude'), ('place',),
    ),
    'the species': (('species',),),
    'the size (height, dbh or girth)': (('height',), ('diameter',), ('girth',)),
}  # fmt: skip
"""Columns of a stand: what they say, and the quantities that do."""


def is_stand_table(head: str) -> bool:
    """Whether the beginning of a file is a table with the columns of a stand."""
    table = _begun(head)
    return table is not None and not _missing(table)


def why_no_stand(head: str) -> str:
    """
    Return which columns of a stand the beginning of a file lacks.

    The text is empty for a stand, and for a file that has no column of one.
    """
    table = _begun(head)
    missing = _missing(table) if table is not None else []
    if table is None or not missing or len(missing) == len(_NEEDED):
        return ''
    return f'no column for {" and none for ".join(missing)} among {", ".join(table.columns[:20])}'


def _begun(head: str) -> TextTable | None:
    """Table at the beginning of a file; None if it is no table."""
    try:
        return parse_table(head.splitlines()[:20], '')
    except FormatError:
        return None


def _missing(table: TextTable) -> list[str]:
    """Describe the columns of a stand that a table lacks."""
    return [
        what
        for what, choices in _NEEDED.items()
        if not any(_find(table, *quantities) for quantities in choices)
    ]


def read_stand_table(
    path: Path,
    kinds: Mapping[str, GrownTree] | None = None,
    *,
    seed: int = 0,
    exact: bool = False,
    **fields: Any,
) -> Scene:
    """
    Read a stand from a table; trees of species without a tree in ``kinds`` are grown.

    The seed is for grown trees and for yaws; further arguments are those of `Scene`. An unknown
    species is replaced as by `species_like`. With ``exact`` each tree is grown by itself, to its
    own height and diameter.

    Raises
    ------
    FormatError
        No tree, a missing column (also one for the size), a cell that is not a finite number, an
        impossible height, two trees of one name; with the line.

    """
    table = parse_table(read_lines(path), str(path))
    stand = _Inventory(table)
    given, made = dict(kinds or {}), dict[tuple[str, float, float], GrownTree]()
    rng = np.random.default_rng(seed)
    yaw = stand.optional('yaw', rng.uniform(0.0, 2.0 * np.pi, len(stand.species)))
    z = stand.optional('z', np.zeros(len(yaw)))
    models: Sequence[str | None] = stand.texts('model') or [None] * len(yaw)
    names = stand.texts('tree_name') or [f'tree{row + 1}' for row in range(len(yaw))]
    refuse_same_names(names, table.where)
    wood = {each: species_like(each) for each in dict.fromkeys(stand.species) if each not in given}
    stand.note(*(note for _, note in wood.values() if note))
    keys = [wood[each][0].key if each in wood else each for each in stand.species]
    stand.find_heights(keys)
    sizes, slender = stand.sizes() if exact else stand.classes(keys)
    trees = []
    for row, key in enumerate(keys):
        try:
            height, own = float(stand.height[row]), (key, float(sizes[row]), float(slender[row]))
            if not height > 0.0:
                raise FormatError(f'a height of {height:g} m', cure='above 0')
            kind = given.get(stand.species[row]) or made.get(own)
            if kind is None:
                kind = made[own] = _grown(wood[stand.species[row]][0], own, seed, stand)
            scale = height / kind.tree.height
            if not SMALLEST <= scale <= LARGEST:
                what = f"{height:g} m is {scale:.3g} times the height of the tree of '{key}'"
                raise ParameterError(what, cure=f'give {SMALLEST:g} to {LARGEST:g} times')
            at = float(stand.x[row]), float(stand.y[row]), float(z[row])
            how: dict[str, Any] = {
                'yaw': float(yaw[row]),
                'species': kind.species,
                'model': models[row],
            }
            trees.append(PlacedTree(names[row], kind.tree, *at, scale, **how))
        except TreeSwayError as error:
            raise error.at(table.where(row)) from None
    unused = [each for i, each in enumerate(table.columns) if i not in stand.used]
    if unused:
        stand.note(f'columns that are not used: {", ".join(unused[:20])}')
    notes = tuple(stand.notes)
    return Scene(trees, **{'name': path.stem, 'source': str(path), 'notes': notes, **fields})


class _Inventory:
    """Columns of the table in SI units, names of used ones, and assumptions."""

    def __init__(self, table: TextTable) -> None:
        self._table = table
        self.used, self.notes = set[int](), list[str]()
        place = _find(table, 'x', 'y')
        self.x, self.y = self._degrees() if place is None else self._values(*place)
        # x and y of a map have too many digits for single precision, in pictures as well.
        if max(np.abs(self.x).max(), np.abs(self.y).max()) > _FAR:
            east, north = float(np.floor(self.x.min())), float(np.floor(self.y.min()))
            self.x, self.y = self.x - east, self.y - north
            self.note(f'moved by {-east:.0f}, {-north:.0f} m to be near the origin')
        self.species = self.texts('species') or table.cells(table.index_of('species'), ())
        height = table.find('height')
        self.height = np.zeros(0) if height is None else self._values(height)[0]
        self.diameter = self._diameter()
        if not len(self.height) and self.diameter is None:
            what = f'no column for the size among {", ".join(table.columns[:20])}'
            raise table.error(what, cure='add one of height, dbh or girth')

    def note(self, *notes: str) -> None:
        """Add assumptions."""
        self.notes += notes

    def texts(self, quantity: str) -> list[str]:
        """Texts of a column; an empty list if it is missing, an error for empty cells."""
        column = self._table.find(quantity)
        if column is None:
            return []
        self.used.add(column.index)
        texts = self._table.cells(column.index, range(len(self._table.texts)))
        for row, text in enumerate(texts):
            if not text:
                raise self._table.error(f'no {quantity}', row, 'fill the cell')
        return texts

    def optional(self, name: str, otherwise: Floats) -> Floats:
        """Numbers of a column, or others where the column is missing."""
        found = self._table.find(name)
        return otherwise if found is None else self._values(found)[0]

    def _values(self, *columns: Column) -> list[Floats]:
        self.used.update(column.index for column in columns)
        values = self._table.strict([self._table.columns[column.index] for column in columns])
        return list((values * [column.factor for column in columns]).T)

    def _degrees(self) -> list[Floats]:
        """East and north of the first tree [m], from degrees on a sphere."""
        found = _find(self._table, 'latitude', 'longitude')
        degrees = self._pairs() if found is None else self._values(*found)
        north, east = np.radians(degrees)
        self.note('east and north are counted from the first tree')
        return [_EARTH * math.cos(north[0]) * (east - east[0]), _EARTH * (north - north[0])]

    def _pairs(self) -> list[Floats]:
        """Latitude and longitude in one column: ``48.85, 2.32`` or ``POINT (2.32 48.85)``."""
        cells = self.texts('place') or self._table.cells(self._table.index_of('x'), ())
        pairs = np.empty((2, len(cells)))
        for row, cell in enumerate(cells):
            found = _NUMBER.findall(cell)
            if len(found) != 2:
                raise self._table.error(f"'{cell[:40]}' is no latitude and longitude", row)
            pairs[:, row] = found[::-1] if cell.upper().startswith('POINT') else found
        return list(pairs)

    def _diameter(self) -> Floats | None:
        """Diameters at breast height [m]; None if the table has none."""
        for quantity, over in (('diameter', 1.0), ('girth', math.pi)):
            found = self._table.find(quantity)
            if found is None:
                continue
            (values,) = self._values(found)
            heading, unit = self._table.headings[found.index]
            if not unit and heading in COLUMNS[quantity]['names']:
                is_cm = float(np.median(values)) / over > 3.0
                values = values * (0.01 if is_cm else 1.0)
                self.note(f'{heading} is taken as {"cm" if is_cm else "m"}')
            return values / over
        return None

    def find_heights(self, keys: list[str]) -> None:
        """Take the heights of grown trees of such stems, where the table has none."""
        if len(self.height) or self.diameter is None:
            return
        found = [height_of_stem(key, d) for key, d in zip(keys, self.diameter, strict=True)]
        self.height = np.array(found)
        self.note('heights are those of grown trees of these stems, as the table has no heights')

    def sizes(self) -> tuple[Floats, Floats]:
        """Height of each tree, and its height over diameter, 0 if unknown."""
        if self.diameter is None:
            return self.height, np.zeros(len(self.height))
        known = (self.height > 0.0) & (self.diameter > 0.0)
        return self.height, np.where(known, self.height / np.where(known, self.diameter, 1.0), 0.0)

    def classes(self, keys: list[str]) -> tuple[Floats, Floats]:
        """Height of the grown tree of each tree, and its height over diameter, 0 if unknown."""
        sizes, slender = np.array(self.height), np.zeros(len(keys))
        named = np.array(keys)
        for key in dict.fromkeys(keys):
            own = np.flatnonzero((named == key) & (self.height > 0.0))
            ratio = None
            if self.diameter is not None and (self.diameter[own] > 0.0).all():
                ratio = self.height[own] / self.diameter[own]
            groups = _steps(self.height[own], _HEIGHTS)
            if ratio is not None:
                groups = 1000 * groups + _steps(ratio, _SLENDERNESSES)
            for group in np.unique(groups):
                of_one = own[groups == group]
                sizes[of_one] = _middle(self.height[of_one])
                if ratio is not None:
                    slender[of_one] = _middle(ratio[groups == group])
        return sizes, slender


def _find(table: TextTable, *quantities: str) -> list[Column] | None:
    """Columns of quantities; None if one is missing."""
    found = [table.find(each) for each in quantities]
    return None if None in found else [each for each in found if each is not None]


def _steps(values: Floats, factor: float) -> Floats:
    """Class of each value, such that values of a class are within a factor."""
    if len(values) == 0:
        return values
    return np.round(np.log(values / np.median(values)) / math.log(factor))


def _middle(values: Floats) -> float:
    return float(np.exp(np.log(values).mean()))


def _grown(
    species: Species, size: tuple[str, float, float], seed: int, stand: _Inventory
) -> GrownTree:
    """Grow the tree of a class; an impossible stem is made thinner or thicker."""
    key, height, slenderness = size
    diameter = None
    if slenderness:
        low, high = stem_range(species, height)
        diameter = min(max(height / slenderness, low), high)
        if not low <= height / slenderness <= high:
            stand.note(
                f'{key} of {height:.3g} m with stems of {height / slenderness:.3g} m: grown with '
                f'{diameter:.3g} m, as others would buckle'
            )
    tree = grow(key, height, diameter, rng=np.random.default_rng(seed))
    return TreeFile(tree, rooted(tree, species), key)
