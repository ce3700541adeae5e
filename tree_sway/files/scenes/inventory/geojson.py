# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
GeoJSON (RFC 7946) and OpenStreetMap's JSON as tables: a row per point, a column per property.

A tree's place is a point; of other shapes the mean of the corners. OpenStreetMap's elements have
their properties under ``tags``.
"""

from __future__ import annotations

from collections.abc import Iterator
import math
from pathlib import Path
from typing import Any

from tree_sway.errors import FormatError
from tree_sway.files.cell_table import table_of_cells
from tree_sway.files.json_values import cell_of, list_of, object_of, parsed
from tree_sway.files.table_file import TextTable
from tree_sway.files.text_file import read_lines

_DEEPEST = 6
PLACES = ('latitude', 'longitude', 'x', 'y', 'lat', 'lon')
"""Properties that a geometry replaces."""


def looks_like_geojson(head: str) -> bool:
    """Whether the beginning of a file is GeoJSON, or JSON of OpenStreetMap."""
    begun = head.lstrip()[:1] == '{'
    return begun and ('"FeatureCollection"' in head or '"elements"' in head or '"Feature"' in head)


def read_geojson(path: Path) -> TextTable:
    """
    Return a table of the features; one whose place is broken has none.

    Raises a `FormatError` for broken JSON, no features, or no feature with a place.
    """
    document = object_of(parsed('\n'.join(read_lines(path)), 'GeoJSON'))
    records = [*_elements(document), *_features(document)]
    if not records:
        raise FormatError('no features', cure='export points with properties')
    names = list(dict.fromkeys(name for record in records for name in record))
    if not {'x', 'longitude'} & {*names}:
        raise FormatError(
            'no feature has a place',
            cure='give each feature a geometry with coordinates of two numbers',
        )
    rows = [[record.get(name, '') for name in names] for record in records]
    return table_of_cells(names, rows, str(path), row_name='feature')


def _elements(document: dict[str, Any]) -> Iterator[dict[str, str]]:
    """Yield the cells of each element of OpenStreetMap that has a place and tags."""
    for element in map(object_of, list_of(document.get('elements'))):
        tags = object_of(element.get('tags'))
        if 'lat' in element and 'lon' in element and tags:
            place = {'latitude': cell_of(element['lat']), 'longitude': cell_of(element['lon'])}
            yield place | {f'tags.{name}': cell_of(each) for name, each in tags.items()}


def _features(document: dict[str, Any]) -> Iterator[dict[str, str]]:
    """Yield the cells of each feature."""
    is_one = document.get('type') == 'Feature'
    for feature in map(object_of, [document] if is_one else list_of(document.get('features'))):
        properties = _flat(object_of(feature.get('properties')))
        place = _place(object_of(feature.get('geometry')).get('coordinates'))
        taken = PLACES if place else ()
        cells = {name: each for name, each in properties.items() if name.lower() not in taken}
        yield {name: cell_of(each) for name, each in cells.items()} | place


def _flat(properties: dict[str, Any]) -> dict[str, Any]:
    """Properties, and those of the records in a list among them, of which the first with one."""
    inside: dict[str, Any] = {}
    for each in properties.values():
        for record in reversed(list(map(object_of, list_of(each)))):
            inside |= {name: cell for name, cell in record.items() if cell is not None}
    return inside | properties


def _place(coordinates: Any) -> dict[str, str]:
    """Cells of the mean of the corners; none if there are none, or one is broken."""
    try:
        corners = list(_corners(coordinates, 0))
    except (ValueError, TypeError, OverflowError):
        return {}
    if not corners:
        return {}
    x = sum(corner[0] for corner in corners) / len(corners)
    y = sum(corner[1] for corner in corners) / len(corners)
    if not math.isfinite(x + y):
        return {}
    is_degrees = abs(x) <= 360.0 and abs(y) <= 90.0
    names = ('longitude', 'latitude') if is_degrees else ('x', 'y')
    return {names[0]: repr(x), names[1]: repr(y)}


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
