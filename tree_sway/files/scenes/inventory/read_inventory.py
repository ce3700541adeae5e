# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The trees of an inventory: a row each, in SI units, and what was assumed for it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
import re
from typing import Any, TypeVar

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.species import Species
from tree_sway.errors import FormatError
from tree_sway.files.column_names import folded
from tree_sway.files.scenes.inventory.columns import InventoryColumns
from tree_sway.files.scenes.inventory.inventory_file import missing_columns, SPECIES, why_missing
from tree_sway.files.scenes.inventory.places import about_centre, Places, places_of
from tree_sway.files.scenes.inventory.sizes import diameters_of, fill_heights, heights_of
from tree_sway.files.scenes.inventory.species_names import species_of_rows
from tree_sway.files.table_file import TextTable
from tree_sway.simulation import EXPOSURES

T = TypeVar('T')
_DEAD = re.compile(
    r'\b(dead|stump|removed|felled|fallen|retired|vacant|tot|abgestorben|gefällt|stubben|mort|'
    r'abattu|souche|muerto|seco|tocón|vacía|vacío|dood|död)\b',
    re.IGNORECASE,
)

_SAYS_DEAD = {
    'alive': ('false', 'no', 'non', '0', 'dead'),
    'dead': ('true', 'yes', 'oui', 'si', '1', 'dead'),
}
"""Cells of a column of living or of dead trees that say that one is dead."""
_CODES = (
    ('status', {'A', 'AB', 'AS', 'D', 'G', 'M', 'P', 'L', ''}, {'A', 'L'}, 'D'),
    ('statuscd', {'0', '1', '2', '3', ''}, {'1'}, '23'),
)
"""
Columns of codes: all of them, those of living trees, and of trees that are dead or gone.

ForestGEO (forestgeo/fgeo.validate), with the L of plots that have L and D; FIA (user guide).
"""


@dataclass(frozen=True)
class Inventory:
    """
    The trees of an inventory, (n,) each.

    Parameters
    ----------
    source
        Name of the file.
    lines
        Line of each tree.
    names
        Name of each tree, each once.
    species
        Name of its species as in the file; empty without one.
    wood
        Species of the table by name; without those that the caller gave.
    x, y, z
        Place [m], east, north and up.
    yaw
        Rotation about the vertical [rad], NaN if none is given.
    height
        Height [m].
    diameter
        Diameter at breast height [m], NaN if unknown.
    is_height_found
        Whether the height is that of a grown tree of its stem.
    models
        Model of each tree; None if none is given.
    exposures
        Exposure of each tree to the wind, a kind of `EXPOSURES`; None if none is given.
    notes
        Assumptions, one sentence each.

    """

    source: str
    lines: tuple[int, ...]
    names: tuple[str, ...]
    species: tuple[str, ...]
    wood: Mapping[str, Species]
    x: Floats
    y: Floats
    z: Floats
    yaw: Floats
    height: Floats
    diameter: Floats
    is_height_found: tuple[bool, ...]
    models: tuple[str | None, ...]
    exposures: tuple[str | None, ...]
    notes: tuple[str, ...]

    def where(self, row: int) -> str:
        """File and line of a tree."""
        return f'{self.source}:{self.lines[row]}'


def inventory_of(
    table: TextTable, given: Mapping[str, object] | None = None, *, needs_place: bool = True
) -> Inventory:
    """
    Return the trees of a table; species of names in ``given`` are not looked up.

    A row without a place, a size or a number in it is left out and counted. Without a column of
    places all are at the origin, unless that ``needs_place``. Raises a `FormatError` for a missing
    column, or if no row is left.
    """
    given = given or {}
    # Among columns of other things, as of lamps, a place and a height do not make a tree.
    missing = missing_columns(table)
    if SPECIES in missing and not table.find_all('other_thing'):
        missing.remove(SPECIES)
    if not needs_place:
        missing = [each for each in missing if 'place' not in each]
    if missing:
        cure = 'give a row for each tree, with place, species, and height or dbh'
        cure = f'name them so in the header, if it is an inventory: {cure} (doc/trees.md)'
        raise table.error(why_missing(table) or 'no column of an inventory', cure=cure)
    columns = InventoryColumns(table)
    found = places_of(columns)
    zero = np.zeros(columns.n_rows)
    places = Places(zero, zero) if found is None else found
    _leave_out_dead(columns)
    names, wood = species_of_rows(columns, given, is_in_states=places.is_in_states)
    keys = [wood[each].key if each in wood else each for each in names]
    diameter = diameters_of(columns, places.is_in_states)
    height = heights_of(columns, diameter, places.is_in_states)
    if found is None:
        found = about_centre(columns)
        places = found or places
    for row in np.flatnonzero(~np.isfinite(places.x + places.y)).tolist():
        columns.leave_out(row, 'no place', _why_no_place(columns, row))
    height = np.full(columns.n_rows, np.nan) if height is None else height
    is_found = fill_heights(columns, height, diameter, keys)
    kept = np.flatnonzero(columns.is_kept).tolist()
    columns.note(columns.why_left_out())
    stems = np.full(columns.n_rows, np.nan) if diameter is None else diameter
    if found is not None:
        columns.note(_double(columns, kept, [places.x, places.y, names, height, stems]))
    if not kept:
        raise FormatError(
            f'no tree is left: {columns.why_left_out() or "no row"}',
            where=table.source,
            cure='fill the cells, or remove the rows',
        )
    tree_names = _names(columns, kept)
    z, yaw = (_optional(columns, each) for each in ('z', 'yaw'))
    models = columns.texts_of('model')
    exposures = _exposures(columns)
    unused = [each for i, each in enumerate(table.columns) if each and i not in columns.used]
    if unused:
        columns.note(f'columns that are not used: {", ".join(unused[:20])}')

    def of_kept(cells: Sequence[T]) -> tuple[T, ...]:
        return tuple(cells[row] for row in kept)

    return Inventory(
        table.source,
        of_kept(table.numbers),
        tuple(tree_names),
        of_kept(names),
        wood,
        places.x[kept],
        places.y[kept],
        np.nan_to_num(z[kept]),
        yaw[kept],
        height[kept],
        stems[kept],
        of_kept(is_found),
        tuple(text or None for text in of_kept(models)),
        of_kept(exposures),
        tuple(columns.notes),
    )


def _leave_out_dead(columns: InventoryColumns) -> None:
    for index in columns.table.find_all('status'):
        name, texts = columns.table.columns[index], columns.texts(index)
        gone = ''.join(
            codes
            for each, known, alive, codes in _CODES
            if each == folded(name) and known >= {*texts} and alive & {*texts}
        )
        for row, text in enumerate(texts):
            if _DEAD.search(text) or (text and text in gone):
                columns.leave_out(row, 'dead or gone', columns.told(index, row))
    for quantity, words in _SAYS_DEAD.items():
        for index in columns.table.find_all(quantity):
            for row, text in enumerate(columns.texts(index)):
                if text.lower() in words:
                    columns.leave_out(row, 'dead or gone', columns.told(index, row))


def _double(columns: InventoryColumns, kept: list[int], cells: Sequence[Any]) -> str:
    """Tell how many trees have the place, species and size of one before; empty for none."""
    first: dict[str, int] = {}
    twice = [
        (first[tree], row)
        for row in kept
        if first.setdefault(tree := str([each[row] for each in cells]), row) != row
    ]
    if not twice:
        return ''
    one, other = map(columns.line, twice[0])
    return (
        f'{len(twice)} trees have the place, species and size of another, as {one} and {other}: '
        'remove their rows if they are the same'
    )


def _exposures(columns: InventoryColumns) -> list[str | None]:
    """Kinds of exposure; a text that is none is counted and left out."""
    texts = [text.strip().lower() for text in columns.texts_of('exposure')]
    unknown = [text for text in texts if text and text not in EXPOSURES]
    if unknown:
        name = columns.table.columns[columns.index_of('exposure') or 0]
        columns.note(
            f"{len(unknown)} cells of {name} do not count: '{unknown[0][:40]}' is none of "
            f'{", ".join(EXPOSURES)}'
        )
    return [text if text in EXPOSURES else None for text in texts]


def _optional(columns: InventoryColumns, quantity: str) -> Floats:
    found = columns.table.find(quantity)
    if found is None:
        return np.full(columns.n_rows, np.nan)
    return columns.numbers(found.index)[0] * found.factor


def _why_no_place(columns: InventoryColumns, row: int) -> str:
    names = ('x', 'y', 'latitude', 'longitude', 'place')
    places = [index for index in map(columns.index_of, names) if index is not None]
    wrong = [each for each in places if not any(map(str.isdigit, columns.cell(each, row)))]
    told = [columns.told(each, row) for each in wrong[:1] or places]
    return f'{" and ".join(told)}, no place'


def _names(columns: InventoryColumns, kept: list[int]) -> list[str]:
    """Names of trees, each once: a further one of a name gets its number."""
    texts = columns.texts_of('tree_name')
    names = list[str]()
    n_changed = 0
    counts: dict[str, int] = {}
    for row in kept:
        name = texts[row].replace('/', '-') or f'tree{row + 1}'
        count = counts[name] = counts.get(name, 0) + 1
        n_changed += count > 1 or name != (texts[row] or name)
        while count > 1 and f'{name}-{count}' in counts:
            count += 1
        whole = name if count == 1 else f'{name}-{count}'
        counts.setdefault(whole, 1)
        names.append(whole)
    if n_changed:
        columns.note(f'{n_changed} names are changed, as they occur twice or have a slash')
    return names
