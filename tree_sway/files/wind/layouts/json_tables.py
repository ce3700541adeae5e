# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
JSON of weather services: columns of equal length, lists of records, or values by time.

Open-Meteo has columns, their units beside them (``hourly``, ``hourly_units``); weather.com, the US
and other services have records, with names of quantities inside names of groups, which are joined
(``metric.windspeedAvg``); Ecowitt has ``list`` and ``unit`` of each quantity; Home Assistant lists
of states. The longest of these in the document is the table.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
import json
from typing import Any

from tree_sway.errors import FormatError
from tree_sway.files.cell_table import table_of_cells
from tree_sway.files.table_file import TextTable
from tree_sway.files.wind.layouts.layout import Layout
from tree_sway.files.wind.layouts.long import Value, wide_table

_DEEPEST = 12
Cells = dict[str, str]


def _is_json(lines: Sequence[str]) -> bool:
    first = next((line.strip() for line in lines if line.strip()), '')
    return first[:1] in ('{', '[') and first[:2] != '[0'


def read_json_table(lines: list[str], source: str) -> TextTable:
    """Return the longest table of a JSON document; a `FormatError` if there is none."""
    try:
        document = json.loads('\n'.join(lines))
    except (ValueError, RecursionError) as error:
        raise FormatError(f'not JSON: {error}', where=source, cure='save it again whole') from None
    if tables := list(_tables(document, {}, source, 0)):
        return max(tables, key=lambda table: len(table.texts))
    cure = 'give columns or records with a time, a speed and a direction'
    raise FormatError('no table in the JSON', where=source, cure=cure)


def _tables(node: Any, units: Cells, source: str, depth: int) -> Iterator[TextTable]:
    """Yield all tables of a document."""
    if depth > _DEEPEST:
        return
    if isinstance(node, dict):
        if values := list(_of_times(node, '')):
            yield _by_time(node, values, source)
        if table := _columns(node, units, source):
            yield table
        for name, each in node.items():
            below = node.get(f'{name}_units', _said_units(node))
            yield from _tables(each, below if isinstance(below, dict) else {}, source, depth + 1)
    elif isinstance(node, list):
        if states := list(_states(node)):
            yield _of_states(node, states, source)
        elif node and all(isinstance(each, dict) for each in node):
            yield _records(node, units, source)
        else:
            for each in node:
                yield from _tables(each, units, source, depth + 1)


def _said_units(node: dict[str, Any]) -> Cells:
    """System of units that the metadata of weather.com's history gives (e, m, h or s)."""
    inside = node.get('metadata')
    system = inside.get('units') if isinstance(inside, dict) else None
    return {'*': system} if isinstance(system, str) else {}


def _columns(node: dict[str, Any], units: Cells, source: str) -> TextTable | None:
    columns = {name: each for name, each in node.items() if isinstance(each, list)}
    lengths = {len(each) for each in columns.values()}
    if len(columns) < 2 or len(lengths) != 1 or not lengths.pop():
        return None
    if any(isinstance(cell, dict | list) for each in columns.values() for cell in each[:1]):
        return None
    cells = [[_text(cell) for cell in each] for each in columns.values()]
    rows = list(zip(*cells, strict=True))
    return table_of_cells(
        list(columns), rows, source, units=[_unit(units.get(name)) for name in columns]
    )


def _records(node: list[dict[str, Any]], units: Cells, source: str) -> TextTable:
    flat = [dict(_flat(each, '', 0)) for each in node]
    names = list(dict.fromkeys(name for each in flat for name in each))
    of_names = [_unit(_unit_beside(flat[0], name)) for name in names]
    if system := units.get('*'):
        names.append('units')
        flat = [{**each, 'units': system} for each in flat]
        of_names.append('')
    rows = [[each.get(name, '') for name in names] for each in flat]
    return table_of_cells(names, rows, source, units=of_names)


def _flat(node: dict[str, Any], before: str, depth: int) -> Iterator[tuple[str, str]]:
    """Yield name and text of each value in a record, with the names of its groups before it."""
    for name, each in node.items():
        whole = f'{before}{name}'
        if isinstance(each, dict) and depth < _DEEPEST:
            yield from _flat(each, f'{whole}.', depth + 1)
        elif not isinstance(each, list):
            yield whole, _text(each)


def _unit_beside(record: Cells, name: str) -> str | None:
    """Return the unit of the value that is beside it, as ``unitCode`` is beside ``value``."""
    group = name.rpartition('.')[0]
    beside = (f'{group}.{word}' for word in ('unitCode', 'unit', 'units'))
    return next((record[each] for each in beside if each in record), None)


def _of_times(node: dict[str, Any], before: str) -> Iterator[tuple[str, str, dict[str, Any]]]:
    """Yield name, unit and values by time of Ecowitt's quantities."""
    for name, each in node.items():
        if not isinstance(each, dict):
            continue
        if isinstance(each.get('list'), dict):
            yield f'{before}{name}', _text(each.get('unit', '')), each['list']
        else:
            yield from _of_times(each, f'{name}_')


def _by_time(
    node: dict[str, Any], values: list[tuple[str, str, dict[str, Any]]], source: str
) -> TextTable:
    times = sorted({time for _, _, by_time in values for time in by_time})
    rows = [[time, *(_text(by_time.get(time)) for _, _, by_time in values)] for time in times]
    names, units = ['time', *(name for name, _, _ in values)], ['', *(u for _, u, _ in values)]
    return table_of_cells(names, rows, source, units=units)


def _states(node: Any) -> Iterator[Value]:
    """Yield the states of Home Assistant in a list of lists of them."""
    lists = [each for each in node if isinstance(each, list)]
    for states in lists:
        name = ''
        for state in states:
            if not isinstance(state, dict) or 'state' not in state:
                return
            name = state.get('entity_id', name)
            time = _text(state.get('last_changed', state.get('last_updated')))
            if state['state'] not in ('unavailable', 'unknown'):
                yield 1, time, name, _text(state['state'])


def _of_states(node: list[Any], states: list[Value], source: str) -> TextTable:
    table = wide_table(states, source, 'last_changed')
    units = ['']
    for each in dict.fromkeys(name for _, _, name, _ in states):
        of_one = [s for group in node for s in group if s.get('entity_id') == each]
        inside = of_one[0].get('attributes') if of_one else None
        units.append(_unit(inside.get('unit_of_measurement')) if isinstance(inside, dict) else '')
    rows = [list(table.split(text)) for text in table.texts]
    return table_of_cells(table.columns, rows, source, units=units)


def _text(cell: Any) -> str:
    if cell is None or isinstance(cell, dict | list | bool):
        return ''
    return str(cell).replace('\x1f', ' ').replace('\n', ' ')


def _unit(cell: Any) -> str:
    return cell if isinstance(cell, str) else ''


JSON = Layout('json', _is_json, read_json_table)
