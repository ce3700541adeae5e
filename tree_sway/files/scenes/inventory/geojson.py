# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
JSON of trees as tables: a row per record, a column per property.

So are GeoJSON (RFC 7946), whose place is a point or else the mean of the corners, OpenStreetMap's
elements with ``tags``, ArcGIS's features with ``attributes``, and the records of the portals CKAN
and Opendatasoft, and records in a list, one in each line, or one in each file of a zip.
"""

from __future__ import annotations

from collections.abc import Iterator
import json
from pathlib import Path
import re
from typing import Any

from tree_sway.errors import FormatError
from tree_sway.files.cell_table import table_of_cells
from tree_sway.files.json_values import document_of, flat, list_of, object_of, Record
from tree_sway.files.scenes.inventory.geometry_cell import point_of_cell
from tree_sway.files.table_file import TextTable
from tree_sway.files.zipped import tables_in

_GEOMETRY = 'geometry'
_LISTS = ('features', 'elements', 'records', 'results')
_PROPERTIES = ('properties', 'attributes', 'fields', 'tags')
_BEGINS = re.compile(
    rf'\s*\{{.*"({"|".join(_LISTS)}|Feature(Collection)?|geometryType)"', re.DOTALL
)
_IS_JSON = re.compile(r'\s*[{\[]')
_HEAD = 9
_IS_WIND = re.compile(r'"wind_?(speed|dir)', re.IGNORECASE)
_MERCATOR = re.compile(r'\b(3857|102100|900913)\b')
"""Numbers of the system of maps on the web, whose metres are longer than those of the ground."""
PLACES = ('latitude', 'longitude', 'x', 'y', 'lat', 'lon')
"""Properties that a geometry replaces."""


def looks_like_geojson(head: str) -> bool:
    """Whether the beginning of a file is JSON with a list of records, none of which is a wind."""
    return _BEGINS.match(head) is not None and _IS_WIND.search(head) is None


def read_geojson(path: Path) -> TextTable:
    """
    Return a table of the records; one whose geometry is broken has no place.

    Raises a `FormatError` for broken JSON, no records, or features of which none has a place.
    """
    texts = [lines for _, lines in tables_in(path) if _IS_JSON.match('\n'.join(lines[:_HEAD]))]
    documents = [document_of(lines, 'GeoJSON') for lines in texts]
    parts = [*map(_listed, documents)]
    listed = parts[0][0] if parts else ''
    found = [object_of(record) for _, part in parts for record in part]
    records = [dict(_cells(record)) for record in found]
    if listed == 'elements':  # those of ways and relations have no tags
        tagged = [each for each in records if any(name.startswith('tags.') for name in each)]
        records = [each for each in tagged if each.get('tags.natural') == 'tree'] or tagged
    if not any(records):
        raise FormatError('no features', cure='export points with properties')
    heads = map(object_of, documents)
    systems = [each.get('spatialReference', each.get('crs')) for each in heads]
    if _MERCATOR.search(str(systems)):
        raise FormatError(
            'places in the Web Mercator of maps, which is not in metres of the ground',
            cure='export degrees, as by outSR=4326 in ArcGIS',
        )
    names = list(dict.fromkeys(name for record in records for name in record))
    if listed == 'features' and _GEOMETRY not in names:
        raise FormatError(
            'no feature has a place',
            cure='give each feature a geometry with coordinates of two numbers',
        )
    rows = [[record.get(name, '') for name in names] for record in records]
    return table_of_cells(names, rows, str(path), row_name='feature')


def _listed(document: Any) -> tuple[str, list[Any]]:
    """Return the name of the list of records in a document, and these; it may be one itself."""
    if isinstance(document, list):
        return 'records', document
    inner = object_of(object_of(document).get('result')) or object_of(document)
    listed = next((name for name in _LISTS if name in inner), '')
    return listed, list_of(inner[listed]) if listed else [inner]


def _cells(record: Record) -> Iterator[tuple[str, str]]:
    """Yield the names and cells of a record, its place last."""
    own = next((name for name in _PROPERTIES if object_of(record.get(name))), '')
    geometry = object_of(record.get('geometry'))
    place = geometry.get('coordinates', [geometry.get('x'), geometry.get('y')])
    corners = json.dumps({'coordinates': place})
    is_placed = point_of_cell(corners) is not None
    taken = PLACES if is_placed else ()
    if own == 'tags':  # those of OpenStreetMap keep their group
        cells = {name: record.get(name) for name in ('tags', 'lat', 'lon')}
    else:
        cells = object_of(record[own]) if own else record
    found: dict[str, str] = {}
    for name, cell in flat(cells, lists=True):
        if name.lower() not in taken:
            found[name] = found.get(name) or cell  # the first of several records
    yield from found.items()
    if is_placed:
        yield _GEOMETRY, corners
