# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The trees of an inventory: a row each, in SI units, and what was assumed for it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
import re
from typing import Any, TypeVar

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.species import Species
from tree_sway.errors import FormatError
from tree_sway.files.column_names import INVENTORY
from tree_sway.files.scenes.inventory.columns import (
    InventoryColumns,
    missing_columns,
    SPECIES,
)
from tree_sway.files.scenes.inventory.no_trees import (
    gone_by_codes,
    GROUP,
    said_of_none,
    UNKNOWN,
)
from tree_sway.files.scenes.inventory.places import about_centre, places_of
from tree_sway.files.scenes.inventory.sizes import (
    diameters_of,
    fill_heights,
    heights_of,
    leave_out_without_size,
    refuse_list_of_species,
)
from tree_sway.files.scenes.inventory.species_names import species_of_rows
from tree_sway.files.table_file import TextTable
from tree_sway.simulation import EXPOSURES

T = TypeVar('T')
_OF_SCHEDULE = re.compile(r'([A-Z]) ?\d+[a-z]?')
_KINDS_OF_SCHEDULE = set('TGHWAS')
"""Trees, groups, hedges, woodlands, areas and shrubs, as BS 5837 and orders of councils count."""


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
    may_lack = SPECIES if not table.find_all('other_thing') else ''
    missing = missing_columns(table)
    place = next((each for each in missing if 'place' in each), '')
    if {*missing} - {place, may_lack}:
        raise _lacking(table, missing)
    columns = InventoryColumns(table)
    columns.note(table.note)
    found = places_of(columns)
    _leave_out_no_trees(columns)
    diameter = diameters_of(columns)
    height = heights_of(columns, diameter)
    if found is None:
        refuse_list_of_species(columns, diameter)
        found = about_centre(columns)
    if found is None and needs_place:
        raise _lacking(table, [place])
    x, y = np.zeros((2, columns.n_rows)) if found is None else found
    for row in np.flatnonzero(~np.isfinite(x + y)).tolist():
        columns.leave_out(row, 'no place', _why_no_place(columns, row))
    leave_out_without_size(columns, height, diameter)
    _leave_out_repeated(columns, [x, y, height, diameter])
    names, wood = species_of_rows(columns, given)
    keys = [wood[each].key if each in wood else each for each in names]
    is_found = fill_heights(columns, height, diameter, keys)
    kept = np.flatnonzero(columns.is_kept).tolist()
    columns.note(columns.why_left_out())
    if found is not None:
        columns.note(_double(columns, kept, [x, y, names, height, diameter]))
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
        x[kept],
        y[kept],
        np.nan_to_num(z[kept]),
        yaw[kept],
        height[kept],
        diameter[kept],
        of_kept(is_found),
        tuple(text or None for text in of_kept(models)),
        of_kept(exposures),
        tuple(columns.notes),
    )


def _lacking(table: TextTable, missing: Sequence[str]) -> FormatError:
    """Make the error of a table that lacks columns of an inventory."""
    what = f'no column for {" and none for ".join(missing)} among '
    what += ', '.join([*filter(None, table.columns)][:20])
    cure = 'give a row for each tree, with place, species, and height or dbh'
    cure = f'name them so in the header, if it is an inventory: {cure} (doc/trees.md)'
    if len(missing) == 1 and 'place' in missing[0]:
        cure = f'a scene needs it; tree-sway risk reads trees without; {cure}'
    is_none = len(missing) == len(INVENTORY)
    return table.error('no column of an inventory' if is_none else what, cure=cure)


def _leave_out_no_trees(columns: InventoryColumns) -> None:
    """Leave out the rows of dead trees, stumps, empty places, groups, and of no tree at all."""
    for quantity in ('status', 'species', 'genus', 'alive', 'dead'):
        for index in columns.table.find_all(quantity):
            texts = columns.texts(index)
            gone = gone_by_codes(columns.table.columns[index], quantity, {*texts})
            none = {'', UNKNOWN, GROUP if quantity == 'status' else ''}
            for row, text in enumerate(texts):
                why = 'dead or gone' if text in gone else said_of_none(text)
                if why not in none:
                    columns.leave_out(row, why, columns.told(index, row))
    for index in columns.table.find_all('tree_name')[:1]:
        kinds = [_OF_SCHEDULE.fullmatch(text) for text in columns.texts(index)]
        if {'T'} < {each[1] for each in kinds if each} <= _KINDS_OF_SCHEDULE:
            for row, each in enumerate(kinds):
                if each and each[1] != 'T':
                    columns.leave_out(row, GROUP, columns.told(index, row))
    for index in columns.table.find_all('tree_count')[:1]:
        _count_trees(columns, index)


def _count_trees(columns: InventoryColumns, index: int) -> None:
    """Leave out rows of no tree, and tell of those that stand for several."""
    count, _ = columns.numbers(index)
    for row in np.flatnonzero(count == 0.0).tolist():
        columns.leave_out(row, 'without a tree', columns.told(index, row))
    rows = np.flatnonzero(columns.is_kept & (count > 1.0)).tolist()
    if rows:
        columns.note(
            f'rows for several trees by {columns.table.columns[index]}: {len(rows)}, '
            f'{columns.line(rows[0])} for {count[rows[0]]:.0f}; each is taken as one tree'
        )


def _leave_out_repeated(columns: InventoryColumns, cells: Sequence[Floats]) -> None:
    """Leave out all rows of a tree but its first, where rows of a name have one place and size."""
    trees = [*map(str, zip(*cells, columns.texts_of('species'), strict=True))]
    groups_of = [columns.table.rows_by(each) for each in columns.table.find_all('tree_name')]
    if any(len(each) == columns.n_rows for each in groups_of):
        return
    for index, by_name in zip(columns.table.find_all('tree_name'), groups_of, strict=True):
        by_name.pop('', None)
        groups = by_name.values()
        if all(len({trees[row] for row in rows}) == 1 for rows in groups):
            for row in (row for rows in groups for row in rows[1:]):
                columns.leave_out(row, 'of a tree above', columns.told(index, row))


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
    places = [index for index in map(columns.index_of, names) if index in columns.used]
    wrong = [each for each in places if not any(map(str.isdigit, columns.cell(each, row)))]
    told = [columns.told(each, row) for each in wrong[:1] or places]
    return f'{" and ".join(told)}, no place'


def _names(columns: InventoryColumns, kept: list[int]) -> list[str]:
    """Names of trees, each once: a further one of a name gets its number."""
    # Of several the first that tells the trees apart: numbers may begin anew in each street.
    index = max(
        columns.table.find_all('tree_name'),
        key=lambda each: round(len({*columns.table.cells(each, kept)}) / len(kept), 1),
        default=None,
    )
    texts = [''] * columns.n_rows if index is None else columns.texts(index)
    names = Counter[str]()
    n_changed = 0
    for row in kept:
        name = whole = texts[row].replace('/', '-') or f'tree{row + 1}'
        while whole in names:
            names[name] += 1
            whole = f'{name}-{names[name]}'
        names[whole] = 1
        n_changed += whole != (texts[row] or name)
    if n_changed:
        columns.note(
            f'{n_changed} names are changed, as they occur twice or have a slash; rows that are '
            'stems or measurements of one tree count as trees: keep one of each'
        )
    return [*names]
