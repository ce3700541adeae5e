# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Files without a header whose lines are known: `lines.csv` has the form of each.

``line`` is a regular expression with a group for each column. ``skipped`` lines stand above,
``units`` are those of columns, a cell of the form ``missing`` is empty. A group ``unit`` is of
speeds.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
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


def _has_form(lines: Sequence[str], form: re.Pattern[str], skipped: int) -> bool:
    filled = [line.strip() for line in lines[skipped:] if line.strip()][:2]
    found = [form.fullmatch(line) for line in filled]
    return bool(found) and all(
        each and unit_known('speed', each.groupdict().get('unit', 'm/s')) for each in found
    )


def _read(
    lines: list[str], source: str, known: dict[str, Any], form: re.Pattern[str]
) -> TextTable:
    names = [name for name in form.groupindex if name != 'unit']
    missing = re.compile(known['missing'] or '')
    unit = ''
    rows = []
    for number, line in numbered(lines, known['skipped']):
        if not line.strip():
            continue
        found = form.fullmatch(line.strip())
        cells = dict.fromkeys(names, '') if found is None else found.groupdict('')
        unit = unit or cells.get('unit', '')
        row = ['' if missing.fullmatch(cells[name]) else cells[name] for name in names]
        rows.append((number, ['', *(cell.replace(',', '.') for cell in row)]))
    units = dict(each.split('=') for each in known['units'].split(';'))
    if unit:
        units |= dict.fromkeys(_SPEEDS, unit)
    columns = [known['name'], *names]
    return table_of_lines(columns, rows, source, [units.get(name, '') for name in columns])


LINES = tuple(
    Layout(
        name,
        partial(_has_form, form=form_of(name), skipped=known['skipped']),
        partial(_read, known=known, form=form_of(name)),
    )
    for name, known in _LINES.items()
)
