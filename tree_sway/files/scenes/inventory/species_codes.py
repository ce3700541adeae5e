# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Codes of species in inventories of forests: those of FIA and of ICP Forests.

``species_codes.csv`` has the codes below 1,000 of the reference table ``REF_SPECIES`` of the
Forest Inventory and Analysis program (USDA Forest Service, 2023), and those of the dictionary
``d_tree_spec`` of ICP Forests. Both lists use the same numbers, so the name of the column decides,
or where the trees stand.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
import re

from tree_sway.files.column_names import folded
from tree_sway.tables import table_beside

FIA = 'fia'
ICP = 'icp'
TITLES = {FIA: 'FIA', ICP: 'ICP Forests'}

_FIA_COLUMN = re.compile(r'spcd|fia')
_ICP_COLUMNS = ('codetreespecies', 'treespec', 'treespecies', 'icp')
_CODE = re.compile(r'-?0*(\d{1,4})(?:\.0*)?')
LETTERS = re.compile('[A-Za-z]{4}')
_LEAST_KNOWN = 0.9
"""Share of the codes of a column that its list has to know."""


@cache
def names_of(list_name: str) -> dict[int, str]:
    """Latin names of a list, by code; ``conifer`` and ``broadleaf`` for groups."""
    rows = table_beside(__file__, 'species_codes.csv')
    return {row['code']: row['name'] for row in rows if row['list'] == list_name}


@cache
def latin_name(code: str) -> str:
    """
    Return the name of a code of two letters of the genus and two of the epithet, as ``PIAB``.

    It is the genus where several species of one have the code; empty if several genera have it.
    """
    names = {name for each in TITLES for name in names_of(each).values()}
    form = re.compile(rf'{code[:2]}\w+ {code[2:]}\w+', re.IGNORECASE)
    found = sorted(name for name in names if form.match(name))
    genera = {name.split()[0] for name in found}
    return '' if len(genera) != 1 else found[0] if len(found) == 1 else genera.pop()


def has_codes(cells: Sequence[str]) -> bool:
    """Whether all cells of a column that are not empty are whole numbers, and there is one."""
    filled = [cell for cell in cells if cell]
    return bool(filled) and all(_CODE.fullmatch(cell) for cell in filled)


def list_of(column: str, codes: Sequence[str], *, is_in_states: bool) -> str:
    """
    Return the list, `FIA` or `ICP`, of the codes of a column; empty if it is neither.

    The name of the column decides; under any other name, codes in the United States are of FIA.
    """
    name = folded(column)
    is_fia = _FIA_COLUMN.search(name) is not None
    is_icp = not is_fia and name.startswith(_ICP_COLUMNS)
    found = ICP if is_icp else FIA if is_fia or is_in_states else ''
    known = [name_of(code, found) for code in codes if code]
    n_known = sum(bool(each) for each in known)
    return found if n_known >= _LEAST_KNOWN * len(known) else ''


def name_of(cell: str, list_name: str) -> str:
    """Name of the species of a code; empty if the list does not have it."""
    code = _CODE.fullmatch(cell)
    if code is None or cell.startswith('-'):  # negative numbers are missing values
        return ''
    return names_of(list_name).get(int(code[1]), '')
