# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Files without a header whose lines are known: `lines.csv` has the form of each.

``line`` is a regular expression with a group for each column. ``skipped`` lines stand above, those
of the form ``others`` between; ``units`` are those of columns, a cell of the form ``missing`` is
empty. A group ``unit`` is of speeds, all alike; ``units`` may tell what its letters stand for.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from itertools import islice
import re
from typing import Any

from tree_sway.files.cell_table import table_of_cells
from tree_sway.files.column_names import unit_known
from tree_sway.files.layouts.layout import Layout
from tree_sway.files.table_file import TextTable
from tree_sway.tables import table_beside

_LINES = {
    each['name']: {
        **each,
        'line': re.compile(each['line'], re.ASCII),
        'units': dict(unit.split('=') for unit in each['units'].split(';')),
    }
    for each in table_beside(__file__, 'lines.csv')
}
_SPEEDS = ('wind_speed', 'gust')


def form_of(name: str) -> re.Pattern[str]:
    """Return the form of the lines of a name in `lines.csv`."""
    form: re.Pattern[str] = _LINES[name]['line']
    return form


def _rows(lines: Sequence[str], known: dict[str, Any]) -> Iterator[tuple[int, str]]:
    """Yield the lines that have a row, each after its number."""
    others = re.compile(f'(?:{known["others"] or ""})?', re.ASCII)  # or a blank line
    for number, line in enumerate(lines[known['skipped'] :], start=known['skipped'] + 1):
        text = line.strip()
        if others.fullmatch(text) is None:
            yield number, text


def _has_form(lines: Sequence[str], known: dict[str, Any]) -> bool:
    units = known['units']
    found = [known['line'].fullmatch(text) for _, text in islice(_rows(lines, known), 2)]
    said = [each.groupdict().get('unit', 'm/s') for each in found if each]
    return 0 < len(found) == len(said) and all(
        unit_known('speed', units.get(unit, unit)) for unit in said
    )


def _read(lines: list[str], source: str, known: dict[str, Any]) -> TextTable:
    names = [name for name in known['line'].groupindex if name != 'unit']
    missing = re.compile(known['missing'] or '')
    unit = ''
    rows = {}
    for number, text in _rows(lines, known):
        found = known['line'].fullmatch(text)
        cells = {} if found is None else found.groupdict('')
        unit = unit or cells.get('unit', '')
        if cells.get('unit', '') != unit:
            cells = {}
        row = (cells.get(name, '') for name in names)
        plain = ('' if missing.fullmatch(cell) else cell.replace(',', '.') for cell in row)
        rows[number] = ['', *plain]
    units = known['units']
    if unit:
        units = units | dict.fromkeys(_SPEEDS, units.get(unit, unit))
    columns = [known['name'], *names]
    told = [units.get(name, '') for name in columns]
    table = table_of_cells(columns, rows.values(), source, [*rows], told)
    return replace(table, above=tuple(lines[: known['skipped']]))


LINES = tuple(
    Layout(partial(_has_form, known=known), partial(_read, known=known))
    for known in _LINES.values()
)
