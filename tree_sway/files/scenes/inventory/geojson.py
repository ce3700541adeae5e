# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
GeoJSON (RFC 7946) and OpenStreetMap's JSON as tables: a row per point, a column per property.

A tree's place is a point; of other shapes the mean of the corners. OpenStreetMap's elements have
their properties under ``tags``.
"""

from __future__ import annotations

from collections.abc import Iterator
import json
from typing import Any

from tree_sway.errors import FormatError
from tree_sway.files.cell_table import table_of_cells
from tree_sway.files.table_file import TextTable

_DEEPEST = 6


def looks_like_geojson(head: str) -> bool:
    """Whether the beginning of a file is GeoJSON, or JSON of OpenStreetMap."""
    begun = head.lstrip()[:1] == '{'
    return begun and ('"FeatureCollection"' in head or '"elements"' in head or '"Feature"' in head)


def read_geojson(text: str, source: str) -> TextTable:
    """Return a table of the features; a `FormatError` for broken JSON or none."""
    try:
        document = json.loads(text)
        records = list(_records(document))
    except (ValueError, OverflowError, RecursionError, TypeError, AttributeError) as error:
        raise FormatError(f'not GeoJSON: {error}', where=source, cure='save it again') from None
    if not records:
        raise FormatError('no features', where=source, cure='export points with properties')
    names = list(dict.fromkeys(name for record in records for name in record))
    rows = [[record.get(name, '') for name in names] for record in records]
    return table_of_cells(names, rows, source)


def _records(document: dict[str, Any]) -> Iterator[dict[str, str]]:
    for element in document.get('elements', ()):
        tags = {f'tags.{name}': _text(each) for name, each in element.get('tags', {}).items()}
        if 'lat' in element and 'lon' in element and tags:
            yield {'latitude': _text(element['lat']), 'longitude': _text(element['lon'])} | tags
    is_one = document.get('type') == 'Feature'
    for feature in (document,) if is_one else document.get('features', ()):
        own = {name: _text(each) for name, each in (feature.get('properties') or {}).items()}
        corners = list(_corners((feature.get('geometry') or {}).get('coordinates'), 0))
        if corners:
            x = sum(corner[0] for corner in corners) / len(corners)
            y = sum(corner[1] for corner in corners) / len(corners)
            is_degrees = abs(x) <= 360.0 and abs(y) <= 90.0
            names = ('longitude', 'latitude') if is_degrees else ('x', 'y')
            taken = ('latitude', 'longitude', 'x', 'y', 'lat', 'lon')
            own = {name: each for name, each in own.items() if name.lower() not in taken}
            own |= {names[0]: repr(x), names[1]: repr(y)}
        yield own


def _corners(node: Any, depth: int) -> Iterator[list[float]]:
    if not isinstance(node, list) or depth > _DEEPEST or not node:
        return
    if isinstance(node[0], int | float):
        if len(node) < 2:
            raise ValueError(f'a place of one number, {node[0]}')
        yield [float(each) for each in node[:2]]
    else:
        for each in node:
            yield from _corners(each, depth + 1)


def _text(cell: Any) -> str:
    if cell is None or isinstance(cell, dict | list):
        return ''
    return str(cell).replace('\x1f', ' ').replace('\n', ' ')
