# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Species of the trees of an inventory: from columns of Latin and other names."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from functools import cache, partial
import re

import numpy as np

from tree_sway.core.species import Species, species_like, species_named
from tree_sway.errors import SpeciesError
from tree_sway.files.scenes.inventory.columns import InventoryColumns
from tree_sway.files.scenes.inventory.no_trees import said_of_none, UNKNOWN
from tree_sway.files.scenes.inventory.species_codes import (
    has_codes,
    latin_name,
    LETTERS,
    list_of,
    name_of,
    TITLES,
)
from tree_sway.tables import table_beside

_AMBIGUOUS = {each['name']: each for each in table_beside(__file__, 'ambiguous_names.csv')}
"""Common names of trees that are others elsewhere: where, and the Latin name there."""
_UNKNOWN = 'broadleaf'
"""Name of a tree without one."""
_GENERAL = ('broadleaf', 'conifer')
"""Trees of no known species."""
_MOST_NOTES = 20
_SHORTEST_NAME = 3
_TRIED = 50
"""Cells of a column that are tried as names of species, where no column is called so."""


def species_of_rows(
    columns: InventoryColumns, given: Mapping[str, object]
) -> tuple[list[str], dict[str, Species]]:
    """
    Return the name of each row's species, and the species of each name.

    Of several columns the first with a name that is known counts, Latin ones first; genus and
    epithet in two columns are joined, a genus alone counts last. Names in ``given`` are left as
    they are. Codes are read by `species_codes`, for which it counts whether all trees are in the
    United States.
    """
    tables = [_decoded(columns, index, given) for index in columns.table.find_all('species')]
    if columns.index_of('genus') is not None:
        genera = columns.texts_of('genus')
        pairs = zip(genera, columns.texts_of('epithet'), strict=True)
        tables = [[_joined(*pair) if pair[1] else '' for pair in pairs], *tables, genera]
    if not tables and (index := _column_of_names(columns)) is not None:
        tables.append(columns.texts(index))
        columns.note(f'{columns.table.columns[index]} is taken as the species, by its cells')
    chosen = cache(partial(_chosen, given=given))
    names = [*map(chosen, zip(*(tables or [[''] * columns.n_rows]), strict=True))]
    known: dict[str, Species] = {}
    counts = Counter(names[row] for row in np.flatnonzero(columns.is_kept))
    notes = []
    for name, count in counts.most_common():
        if name in given:
            continue
        known[name], note = (species_named(_UNKNOWN), '') if not name else species_like(name)
        if not name:
            note = 'trees without a species are taken as a broadleaf of no known species'
        if other := _AMBIGUOUS.get(name.lower().replace('-', '')):
            note = f"'{name}' is taken as {known[name].title}; in {other['where']} it is "
            note += f'{other["meaning"]}: write that if it is'
        if note:
            notes.append(f'{note} ({count} {"tree" if count == 1 else "trees"})')
    columns.notes[:0] = notes[:_MOST_NOTES]
    return names, known


def _column_of_names(columns: InventoryColumns) -> int | None:
    """Column most of whose first cells are names, of species if any has these; None without."""
    shares = list[tuple[float, int]]()
    for index in range(len(columns.table.columns)):
        cells = columns.table.cells(index, columns.table.rows[:_TRIED])
        filled = [cell for cell in cells if cell]
        named = [cell for cell in filled if len(cell) >= _SHORTEST_NAME and cell[0].isalpha()]
        if filled:
            shares.append((sum(map(_specificity, named)) / len(filled), index))
    share, index = max(shares, default=(0.0, 0), key=lambda each: each[0])
    return index if share > 0.5 else None


def _specificity(name: str) -> int:
    """Return 0 for an unknown name, 1 for a broadleaf or conifer of no species, else 2."""
    try:
        species = species_named(name)
    except SpeciesError:
        return 0
    return 1 if species.key in _GENERAL else 2


def _decoded(columns: InventoryColumns, index: int, given: Mapping[str, object]) -> list[str]:
    """Cells of a column, with the names of species in place of codes of a known list."""
    cells = columns.texts(index)
    filled = {cell for cell in cells if cell}
    if filled and all(LETTERS.fullmatch(cell) and not _specificity(cell) for cell in filled):
        columns.note(f'{columns.table.columns[index]} is taken as letters of genus and epithet')
        return [latin_name(cell) or cell if cell else '' for cell in cells]
    if not has_codes(cells) or any(cell in given for cell in cells):
        return cells
    column = columns.table.columns[index]
    found = list_of(column, cells, is_in_states=columns.is_in_states)
    if not found:
        columns.note(
            f'{column} has codes of an unknown list: name the column SPCD for those of FIA, '
            'code_tree_species for those of ICP Forests'
        )
        return cells
    columns.note(f'{column} is taken as codes of {TITLES[found]}')
    return [name_of(cell, found) or cell for cell in cells]


def _joined(genus: str, epithet: str) -> str:
    """Return a Latin name; the second cell alone if it has the genus too."""
    if not genus or epithet.lower().startswith(genus.lower().split()[0]):
        return epithet
    return f'{genus} {epithet}'.strip()


def _chosen(cells: tuple[str, ...], given: Mapping[str, object]) -> str:
    """First name of a species, else of a broadleaf or conifer, else the first that is there."""
    # A cell may have several names of one species, as a common and a Latin one.
    parts = [part.strip() for cell in cells for part in re.split(r'::|\|', cell) if part.strip()]
    for name in parts:
        if name in given:
            return name
    parts = [part for part in parts if said_of_none(part) != UNKNOWN]
    return max(parts, default='', key=_specificity)  # the first of those that say most
