# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
JSON of weather services: columns of equal length, lists of records, or values by time.

Open-Meteo has columns, their units beside them (``hourly``, ``hourly_units``); weather.com, the US
and other services have records, with names of quantities inside names of groups, which are joined
(``metric.windspeedAvg``); Ecowitt has ``list`` and ``unit`` of each quantity; Home Assistant lists
of states; Prometheus, Grafana and SensorThings a list of times and values with its name and unit
beside it. The longest of these in the document is the table.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
import re
from typing import Any

import numpy as np

from tree_sway.errors import FormatError
from tree_sway.files.cell_table import table_of_cells
from tree_sway.files.column_names import folded, is_named, is_wind, SENDERS, unit_known
from tree_sway.files.json_values import (
    cell_of,
    DEEPEST,
    document_of,
    flat,
    list_of,
    object_of,
    Record,
    text_of,
    unit_beside,
)
from tree_sway.files.layouts.layout import begins, Layout
from tree_sway.files.layouts.long import (
    note_of_several,
    unit_for,
    Value,
    wide_table,
    widened,
)
from tree_sway.files.layouts.spread_columns import spread_rows
from tree_sway.files.layouts.station_messages import (
    SIGNALK_PAIRS,
    signalk_values,
    SIGNALK_WIND,
    tempest_values,
)
from tree_sway.files.row_times import time_columns
from tree_sway.files.table_file import TextTable
from tree_sway.files.text_file import finite
from tree_sway.files.time_stamps import times_of

_BEGINS = r'\s*(\{|\[\s*([\[{"]|[1-9]\d*\s*,))'
_CLOCK = re.compile(r'\d{9}|\d{4}-\d\d-\d\d')
"""Begin of a time since 1970, or of a date."""
_UNIT = re.compile('unit|uom', re.IGNORECASE)
"""Part of a name of units."""
Cells = dict[str, str]


def _read_json_table(lines: list[str], source: str) -> TextTable:
    """Return the longest table of a JSON document; a `FormatError` if there is none."""
    document = document_of(lines)
    messages = document if isinstance(document, list) else [document]
    told = _of_tempest(messages)
    deltas = _of_deltas(messages, source)
    units = dict(_units_in(document, is_inside=False))
    searched = told or document
    tables = [deltas] if deltas else list(_tables(searched, units, source, 0))
    # One with a wind before a longer one of another sensor.
    winds = [each for each in tables if each.find_all('wind_speed') or each.find_all('wind_x')]
    if not tables:
        raise FormatError(
            'no table in the JSON',
            cure='give columns or records with a time, a speed and a direction',
        )
    longest = max(winds or tables, key=lambda table: len(table.texts))
    alike = {tuple(each.texts) for each in winds if each.columns == longest.columns}
    if len(alike) > 1:
        raise FormatError(
            f'{len(alike)} tables of the same columns in the JSON, where one is read',
            cure='write the records of one instrument into one list',
        )
    above = (f'{name}: {cell_of(each)}' for name, each in object_of(document).items())
    return replace(longest, above=tuple(above))


def _units_in(node: Any, *, is_inside: bool, depth: int = 0) -> Iterator[tuple[str, str]]:
    """Yield the names and units of all objects of units in a document, wherever they are."""
    for name, each in object_of(node).items() if depth < DEEPEST else ():
        if isinstance(each, str):
            yield from [(name, each)] if is_inside and _is_unit(each) else ()
        else:
            inside = is_inside or _UNIT.search(name) is not None
            yield from _units_in(each, is_inside=inside, depth=depth + 1)


def _of_tempest(messages: list[Any]) -> list[Record]:
    """Return the wind of a Tempest's messages of the most common type; empty for others."""
    of_type: dict[str, list[Record]] = {}
    for message in messages:
        if found := tempest_values(message):
            of_type.setdefault(message['type'], []).extend(found)
    return max(of_type.values(), key=len, default=[])


def _of_deltas(messages: list[Any], source: str) -> TextTable | None:
    """Return the wind of deltas of Signal K; None for other messages."""
    found = [
        (line, each.time, each.path.removeprefix(SIGNALK_WIND), text_of(each.value))
        for line, message in enumerate(messages, start=1)
        for each in signalk_values(message)
    ]
    there = {name for _, _, name, _ in found}
    for speed, angle, is_from_bow in SIGNALK_PAIRS:
        names = {speed: 'wind_speed [m/s]', angle: 'wind_direction [rad]'}
        if names.keys() <= there and not is_from_bow:
            wind = [(*each[:2], names[each[2]], each[3]) for each in found if each[2] in names]
            return wide_table(wind, source, 'time')
    if found:
        raise FormatError(
            f'no true wind among the paths {", ".join(sorted(there)[:8])}',
            cure=f'record {SIGNALK_WIND}directionTrue and speedOverGround or speedTrue',
        )
    return None


def _tables(node: Any, units: Cells, source: str, depth: int) -> Iterator[TextTable]:
    """Yield all tables of a document."""
    if depth > DEEPEST:
        return
    if isinstance(node, list):
        node = list(_samples(node)) or list(_states(node)) or node
    elif object_of(node) and all(map(_CLOCK.match, node)) and all(map(object_of, node.values())):
        node = [{'time': clock, **each} for clock, each in node.items()]
    own: Cells = {}
    if values := list(_series(node, '', own)):
        yield wide_table(values, source, 'time', own)
    if isinstance(node, list):
        if node and all(isinstance(each, dict) for each in node):
            yield _records(node, units, source)
        inner = [table for each in node for table in _tables(each, units, source, depth + 1)]
        is_of_several = any(folded(name) in SENDERS for each in node for name in object_of(each))
        yield from inner if is_of_several else _one_after_another(inner)
    elif isinstance(node, dict):
        if rows := list(_rows(node, own)):
            yield _records(rows, units | own, source)
        for name, each in node.items():
            beside = object_of(node.get('units')) or _said_units(node)
            own_units = object_of(node.get(f'{name}_units', beside))
            yield from _tables(each, units | own_units, source, depth + 1)
        if columns := spread_rows(node, own):  # after those of a part of it
            yield _records(columns, units | own, source)


def _one_after_another(tables: Iterable[TextTable]) -> Iterator[TextTable]:
    """Yield the tables of a list, those of following times, as of days, as one."""
    by_columns: dict[tuple[tuple[str, ...], ...], list[TextTable]] = {}
    for each in tables:
        by_columns.setdefault((each.columns, each.units), []).append(each)
    for alike in by_columns.values():
        texts = [text for table in alike for text in table.texts]
        notes = dict.fromkeys(each.note for each in alike if each.note)
        note = '; '.join([f'{len(alike)} lists of following times are read as one', *notes])
        whole = replace(alike[0], texts=texts, numbers=range(1, len(texts) + 1), note=note)
        clock = time_columns(whole) if len(alike) > 1 else None
        times = times_of(whole.cells(clock[0][0], whole.rows)).seconds if clock else [0.0, 0.0]
        yield from [whole] if (np.diff(times) > 0.0).all() else alike


def _samples(messages: list[Any]) -> Iterator[Record]:
    """
    Yield the samples of messages with a time and a list of samples each, at even times.

    So are those of Movesense, within ``acc`` or ``gyro``; nothing of any other list, as one whose
    messages have values beside the time and their lists.
    """
    bodies = [
        object_of(next(iter(message.values()), None)) or message
        for message in map(object_of, messages)
    ]
    n_values = [sum(not list_of(each) for each in body.values()) for body in bodies]
    if len(bodies) < 2 or {*n_values} != {1}:
        return
    clock = next((name for name in bodies[0] if is_named(name, 'time')), '')
    batch = next((name for name, each in bodies[0].items() if list_of(each)), '')
    told = (finite(cell_of(body.get(clock))) for body in bodies)
    starts = [start for start in told if start is not None]
    if not batch or len(starts) < len(bodies):
        return
    ends = [*starts[1:], 2.0 * starts[-1] - starts[-2]]
    for body, start, end in zip(bodies, starts, ends, strict=True):
        samples = list_of(body.get(batch))
        for number, sample in enumerate(samples):
            yield {clock: start + number * (end - start) / len(samples), batch: sample}


def _said_units(node: Record) -> Cells:
    """System of units of weather.com's history and Dark Sky, or titles of columns behind #."""
    system = object_of(node.get('metadata', node.get('flags'))).get('units')
    channel = object_of(node.get('channel'))  # ThingSpeak's names of its fields
    titles = {f'#{name}': channel[name] for name in channel if name.startswith('field')}
    return {'*': system} if isinstance(system, str) else titles


def _rows(node: Record, units: Cells) -> Iterator[Record]:
    """
    Yield records of a list of rows beside a list of its names, and note the units beside these.

    Names are a text with commas as well, or sensors of Edge Impulse, whose rows are at even times.
    """
    lists = [_words(each) for each in node.values()]
    step = finite(cell_of(node.get('interval_ms')))
    index = list_of(node.get('index'))  # of pandas
    for rows in (each for each in lists if each and isinstance(each[0], list)):
        heads = [[*map(text_of, each)] for each in lists if len(each) == len(rows[0])]
        sensors = [*map(object_of, list_of(node.get('sensors')))]
        if step is not None and sensors:
            heads = [[text_of(each.get(word)) for each in sensors] for word in ('name', 'units')]
        if not any(map(any, heads)):
            continue
        for row in heads[1:]:
            if any(unit_known(kind, unit) for unit in row for kind in ('speed', 'acceleration')):
                units |= dict(zip(heads[0], row, strict=False))
        for number, row in enumerate(rows):
            clock = {} if step is None else {'time [ms]': number * step}
            if len(index) == len(rows) and _CLOCK.match(cell_of(index[number])):
                clock = {'time': index[number]}
            yield clock | dict(zip(heads[0], list_of(row), strict=False))


def _words(value: Any) -> list[Any]:
    """Return a list, or the names in a text between commas."""
    return value.split(',') if isinstance(value, str) and ',' in value else list_of(value)


def _records(node: list[Record], units: Cells, source: str) -> TextTable:
    """Return the table of records; a system of units becomes a column of its own."""
    system = {'units': text_of(units['*'])} if units.get('*') else {}
    records = list[Cells]()
    several: Cells = {}
    for number, each in enumerate(node, start=1):
        record: Cells = {}
        for name, text in flat(each):
            if record.get(name, text) != text and is_wind(name.removesuffix('.value')):
                several[name] = f'record {number}'
            record[name] = text
        records.append(record | system)
    names = list(dict.fromkeys(name for record in records for name in record))
    rows = [[record.get(name, '') for name in names] for record in records]
    beside = [unit_beside(records[0], name) or unit_for(name, units) for name in names]
    titles = [text_of(units.get(f'#{name}', name)) for name in names]
    table = table_of_cells(titles, rows, source, units=beside)
    return widened(replace(table, note=note_of_several(several)))


def _series(node: Any, before: str, units: Cells) -> Iterator[Value]:
    """
    Yield the values of quantities that are lists of a time and a value, and note their units.

    Their names are those of the lists, or texts beside these, as at Prometheus and SensorThings.
    """
    unnamed = (('', each) for each in list_of(node))
    own_names = node.items() if isinstance(node, dict) else unnamed
    for own, each in own_names:
        inside = object_of(each)
        pairs = [] if any(map(is_wind, inside)) else _listed(each)
        if not pairs:
            yield from _series(inside, f'{own}_' if own else '', units)
            continue
        texts = dict(flat(inside))
        name = f'{before}{own}' or next(filter(is_wind, texts.values()), '')
        if is_wind(name) and name in units:
            raise FormatError(
                f'rows of several instruments: {name} occurs twice', cure='ask for one of them'
            )
        said = [text for key, text in texts.items() if _UNIT.search(key)]
        units[name] = next(filter(_is_unit, said), said[0] if said else '')
        for time, value in pairs:
            yield 0, time, name, text_of(value)


def _is_unit(text: str) -> bool:
    return any(unit_known(kind, text) for kind in ('speed', 'angle', 'acceleration'))


def _listed(node: Any, depth: int = 2) -> list[tuple[str, Any]]:
    """Return the times and values of a node or of what is in it; empty without."""
    inner = (_listed(each, depth - 1) for each in object_of(node).values() if depth)
    return _pairs(node) or next(filter(None, inner), [])


def _pairs(listed: Any) -> list[tuple[str, Any]]:
    """Return times and values: by time, in lists of two, or in records of two; empty without."""
    cells = [*listed.items()] if isinstance(listed, dict) else list_of(listed)
    found = []
    for each in cells:
        own = dict(object_of(each))
        values = [own.pop(name) for name in [*own] if is_named(name, 'value')]
        parts = [*own.values(), *values]
        if isinstance(each, list | tuple) and len(each) == 2:
            parts = sorted(each, key=lambda part: not _CLOCK.match(cell_of(part)))
        elif not values:
            return []
        clock = next(filter(_CLOCK.match, map(cell_of, parts)), '')
        if not clock:
            return []
        begin = clock.partition('/P')[0]
        found.append((begin, parts[-1]))
    return found


def _states(node: list[Any]) -> Iterator[Record]:
    """Yield the states of Home Assistant's lists; only the first of each may name its entity."""
    for states in node if all(map(list_of, node)) else ():
        known: Record = {}
        for state in map(object_of, states):
            known = known | {'last_changed': state.get('last_updated')} | state
            if 'state' in state:
                yield known


JSON = Layout(begins(_BEGINS), _read_json_table)
