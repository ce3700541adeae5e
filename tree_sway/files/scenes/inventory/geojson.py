# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
JSON of trees as tables: a row per record, a column per property.

So are GeoJSON (RFC 7946), whose place is a point or else the mean of the corners, OpenStreetMap's
elements with ``tags``, ArcGIS's features with ``attributes``, and the records of the portals CKAN
and Opendatasoft; records in all lists of a document, by their keys or as columns, one in each
line, or one in each file of a zip.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import lru_cache
import json
from pathlib import Path
import re
from typing import Any

from tree_sway.errors import FormatError
from tree_sway.files.cell_table import table_of_cells
from tree_sway.files.column_names import is_named
from tree_sway.files.json_values import DEEPEST, document_of, flat, list_of, object_of, Record
from tree_sway.files.scenes.inventory.columns import missing_columns
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
_MOST_NAMES = 1000
_IS_WIND = re.compile(r'"wind_?(speed|dir)', re.IGNORECASE)
_MERCATOR = re.compile(r'"(?:spatialReference|crs)"[^\]]{0,200}?\b(?:3857|102100|900913)\b')
"""The system of maps on the web, whose metres are longer than those of the ground."""
PLACES = ('latitude', 'longitude', 'x', 'y', 'lat', 'lon')
"""Properties that a geometry replaces."""


def looks_like_geojson(head: str) -> bool:
    """Whether the beginning of a file is JSON with a list of records, none of which is a wind."""
    return _BEGINS.match(head) is not None and _IS_WIND.search(head) is None


def read_geojson(path: Path) -> TextTable:
    """
    Return a table of the records; one whose geometry is broken has no place.

    Raises a `FormatError` for broken JSON, no records, or places of a web map in metres.
    """
    texts = [lines for _, lines in tables_in(path) if _IS_JSON.match('\n'.join(lines[:_HEAD]))]
    documents = [document_of(lines, 'GeoJSON') for lines in texts]
    several = set[str]()
    found = [object_of(each) for document in documents for each in _records_of(document)]
    records = [dict(_cells(record, several)) for record in found]
    # Among nodes, ways and relations of OpenStreetMap.
    records = [each for each in records if each.get('tags.natural') == 'tree'] or records
    if not any(records):
        raise FormatError('no features', cure='export points with properties')
    if any(_MERCATOR.search('\n'.join(lines)) for lines in texts):
        raise FormatError(
            'places in the Web Mercator of maps, which is not in metres of the ground',
            cure='export degrees, as by outSR=4326 in ArcGIS',
        )
    names = list(dict.fromkeys(name for record in records for name in record))
    rows = [[record.get(name, '') for name in names] for record in records]
    table = table_of_cells(names, rows, str(path), row_name='feature')
    note = f'some trees have several of {", ".join(sorted(several))}: the first of each counts'
    return replace(table, note=note) if several else table


def _records_of(document: Any) -> list[Any]:
    """Return the records in a document: of a known list or columns, or else those of trees."""
    inner = object_of(document)
    features, elements, *others = (list_of(inner.get(name)) for name in _LISTS)
    columns = [[*list_of(each), *object_of(each).values()] for each in inner.values()]  # of pandas
    sizes = {len(each) for each in columns}
    rows = [*zip(*columns, strict=True)] if len(sizes) == 1 and _is_tree(tuple(inner)) else []
    records = [dict(zip(inner, row, strict=True)) for row in rows]
    known = features or elements or records or _trees_in([document])
    return known or list_of(document) or [each for other in others for each in other]


def _trees_in(node: Any, depth: int = DEEPEST) -> list[Any]:
    """Return the records of trees in all lists of a document, and in objects by their names."""
    inside = list_of(node) or [*object_of(node).values()]
    deeper = [tree for each in inside for tree in _trees_in(each, depth - 1)] if depth else []
    records = [*filter(object_of, inside)]
    n_trees = sum(_is_tree(tuple(dict(flat(each, lists=True)))) for each in records[:_HEAD])
    is_list = n_trees > isinstance(node, dict)  # an object may have one tree beside other things
    # Lists and objects in a record of a tree are its stems, surveys or pictures.
    own = [
        tuple(name for name, cell in each.items() if not (object_of(cell) or list_of(cell)))
        for each in map(object_of, records[:_HEAD])
    ]
    are_whole = bool(own) and all(map(_is_tree, own))
    return records if is_list and (are_whole or len(deeper) < 2) else deeper


@lru_cache(2000)
def _is_tree(names: tuple[str, ...]) -> bool:
    """Whether names have two of the place, the species and the size; the first of many tell."""
    return len(missing_columns(table_of_cells(names[:_MOST_NAMES], [], ''))) < 2


def _cells(record: Record, several: set[str]) -> Iterator[tuple[str, str]]:
    """Yield the names and cells of a record, its place last; add sizes that are ``several``."""
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
            if cell not in ('', found[name]) and is_named(name, 'height', 'diameter', 'girth'):
                several.add(name)
    yield from found.items()
    if is_placed:
        yield _GEOMETRY, corners
