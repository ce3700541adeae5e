# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""JSON of files: read or refused, and its values as cells of a table."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
import json
import re
from typing import Any

from tree_sway.errors import FormatError
from tree_sway.files.column_names import is_named, is_wind

DEEPEST = 12
Record = dict[str, Any]
"""An object of JSON."""
_DECIMAL = re.compile(r'-?\d+,\d+')


def parsed(text: str, kind: str = 'JSON') -> Any:
    """Return a document; a `FormatError` for what is no JSON, or nested too deep."""
    try:
        return json.loads(text)
    except (ValueError, RecursionError) as error:
        raise FormatError(f'not {kind}: {error}', cure='save it again whole') from None


def document_of(lines: Sequence[str], kind: str = 'JSON') -> Any:
    """Return a document of several lines, or a list of those that are one each."""
    try:
        return parsed('\n'.join(lines), kind)
    except FormatError:
        filled = [line for line in lines if line.strip()]
        if not (filled and filled[0].rstrip().endswith('}')):
            raise
        return [parsed(line, kind) for line in filled]


def cell_of(value: Any) -> str:
    """Return a value as a cell; empty for none, and for lists and objects."""
    is_one = value is not None and not isinstance(value, dict | list)
    return str(value).replace('\n', ' ') if is_one else ''


def object_of(value: Any) -> Record:
    """Return an object of JSON; an empty one in place of any other value."""
    return value if isinstance(value, dict) else {}


def list_of(value: Any) -> list[Any]:
    """Return a list of JSON; an empty one in place of any other value."""
    return value if isinstance(value, list) else []


def text_of(value: Any) -> str:
    """Return a value as a cell with a decimal point; empty for true and false."""
    text = '' if isinstance(value, bool) else cell_of(value)
    return text.replace(',', '.') if _DECIMAL.fullmatch(text) else text


def flat(
    node: Mapping[str, Any], before: str = '', depth: int = 0, *, lists: bool = False
) -> Iterator[tuple[str, str]]:
    """
    Yield name and text of each value in an object, with the names of its groups before it.

    Three or four numbers in a list are those of axes. Objects in a list have values beside their
    names, as those of Frost and the IMS; one alone counts too, and with ``lists`` all do.
    """
    for name, each in node.items():
        whole = f'{before}{name}'
        if isinstance(each, dict) and depth < DEEPEST:
            yield from flat(each, f'{whole}.', depth + 1, lists=lists)
        elif isinstance(each, list):
            if name == 'coordinates' and len(each) == 2:  # longitude first, as in GeoJSON
                yield whole, json.dumps({name: each})
            if len(each) in (3, 4) and not any(isinstance(item, dict | list) for item in each):
                axes = zip('xyzw', each, strict=False)
                yield from ((f'{whole}.{axis}', text_of(item)) for axis, item in axes)
            for item in map(object_of, each if depth < DEEPEST else ()):
                if 'value' in item:
                    first = next(iter(item.values()))
                    own = item['name'] if is_wind(cell_of(item.get('name'))) else first
                    yield from flat(item, f'{own}.', depth + 1, lists=lists)
                elif lists or len(each) == 1:
                    yield from flat(item, f'{whole}.', depth + 1, lists=lists)
        else:
            yield whole, text_of(each) or cell_of(each)


def unit_beside(record: Mapping[str, str], name: str) -> str | None:
    """Return the unit that is beside a value, as ``unitCode`` is; of a wind it is the speed's."""
    if is_named(name, 'wind_direction') and not name.endswith('.value'):
        return None
    group = name.rpartition('.')[0]
    beside = (f'{group}.{word}' for word in ('unitCode', 'unit', 'units'))
    return next((record[each] for each in beside if each in record), None)
