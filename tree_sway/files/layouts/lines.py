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
from functools import partial
from itertools import islice
import re
from typing import Any

from tree_sway.files.cell_table import numbered, table_of_lines
from tree_sway.files.column_names import unit_known
from tree_sway.files.layouts.layout import Layout
from tree_sway.files.table_file import TextTable
from tree_sway.tables import table_beside

_LINES = {each['name']: each for each in table_beside(__file__, 'lines.csv')}
_SPEEDS = ('wind_speed', 'gust')


def form_of(name: str) -> re.Pattern[str]:
    """Return the form of the lines of a name in `lines.csv`."""
    return re.compile(_LINES[name]['line'], re.ASCII)


def _rows(lines: Sequence[str], known: dict[str, Any]) -> Iterator[tuple[int, str]]:
    """Yield the lines that have a row, each after its number."""
    others = re.compile(f'(?:{known["others"] or ""})?', re.ASCII)  # or a blank line
    for number, line in numbered(lines, known['skipped']):
        text = line.strip()
        if others.fullmatch(text) is None:
            yield number, text


def _units(known: dict[str, Any]) -> dict[str, str]:
    return dict(each.split('=') for each in known['units'].split(';'))


def _has_form(lines: Sequence[str], known: dict[str, Any], form: re.Pattern[str]) -> bool:
    units = _units(known)
    found = [form.fullmatch(text) for _, text in islice(_rows(lines, known), 2)]
    said = [each.groupdict().get('unit', 'm/s') for each in found if each]
    return 0 < len(found) == len(said) and all(
        unit_known('speed', units.get(unit, unit)) for unit in said
    )


def _read(
    lines: list[str], source: str, known: dict[str, Any], form: re.Pattern[str]
) -> TextTable:
    names = [name for name in form.groupindex if name != 'unit']
    missing = re.compile(known['missing'] or '')
    unit = ''
    rows = []
    for number, text in _rows(lines, known):
        found = form.fullmatch(text)
        cells = {} if found is None else found.groupdict('')
        unit = unit or cells.get('unit', '')
        if cells.get('unit', '') != unit:
            cells = {}
        cells = dict.fromkeys(names, '') | cells
        row = ['' if missing.fullmatch(cells[name]) else cells[name] for name in names]
        rows.append((number, ['', *(cell.replace(',', '.') for cell in row)]))
    units = _units(known)
    if unit:
        units |= dict.fromkeys(_SPEEDS, units.get(unit, unit))
    columns = [known['name'], *names]
    return table_of_lines(columns, rows, source, [units.get(name, '') for name in columns])


LINES = tuple(
    Layout(
        name,
        partial(_has_form, known=known, form=form_of(name)),
        partial(_read, known=known, form=form_of(name)),
    )
    for name, known in _LINES.items()
)
