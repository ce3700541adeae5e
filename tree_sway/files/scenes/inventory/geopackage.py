# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
GeoPackage (.gpkg, OGC 12-128r18) as a table: the first layer of points in the SQLite file.

A geometry is a header, whose length its flags tell, and a point in well-known binary. Layers in
degrees (EPSG 4326) have latitude and longitude, those of a web map (EPSG 3857) are turned into
them, all others are taken in metres.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing, suppress
from itertools import chain, islice
import math
from pathlib import Path
import sqlite3
import struct

from tree_sway.errors import FormatError
from tree_sway.files.bounded import Arrays, bounded_arrays, packed_rows, unpacked_rows
from tree_sway.files.cell_table import table_of_cells
from tree_sway.files.scenes.inventory.geojson import PLACES
from tree_sway.files.table_file import TextTable
from tree_sway.files.text_file import MAX_LINES

_LAYERS = """
    SELECT c.table_name, g.column_name, g.srs_id FROM gpkg_contents c
    JOIN gpkg_geometry_columns g ON g.table_name = c.table_name WHERE c.data_type = 'features'
"""
_ENVELOPES = (0, 32, 48, 48, 64)
"""Bytes of the envelope by its code in the flags."""
_WEB_MAP = (3857, 900913)
_RADIUS = 6378137.0
_LARGEST_CELL = 16 << 20
"""Largest text or geometry [bytes]."""
_MOST_LAYERS = 1000
_MOST_WITHOUT_POINT = 100_000
"""Rows at the beginning of a layer of which one has a point, if it is one of points."""


def is_geopackage(head: str, path: Path) -> bool:
    """Whether the beginning of a file is SQLite and its name that of a GeoPackage."""
    return head.startswith('SQLite format 3\0') and path.suffix.lower() == '.gpkg'


def read_geopackage(path: Path) -> TextTable:
    """Return the first layer with points; a `FormatError` if there is none."""
    cure = 'export it again'
    arrays = bounded_arrays(_points_of_geopackage, path, kind='a GeoPackage', cure=cure)
    rows = unpacked_rows(arrays['rows'])
    return table_of_cells(next(rows), rows, str(path))


def _points_of_geopackage(path: str) -> Arrays:
    """Yield the names and rows of the first layer with points."""
    # The journal of a program that still has it open counts; without one, nothing is written.
    journal = Path(f'{path}-wal')
    is_open = journal.is_file() and journal.stat().st_size > 0
    options = 'mode=ro' if is_open else 'mode=ro&immutable=1'
    with closing(sqlite3.connect(f'{Path(path).as_uri()}?{options}', uri=True)) as base:
        base.execute('PRAGMA trusted_schema = OFF')
        base.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, _LARGEST_CELL)
        for layer in base.execute(_LAYERS).fetchmany(_MOST_LAYERS):
            table, geometry, system = layer
            if not (isinstance(table, str) and isinstance(geometry, str)):
                raise ValueError('a layer whose name is no text')
            rows = _layer(base, table, geometry, system)
            first = next(rows)
            found = list(islice(rows, _MOST_WITHOUT_POINT))
            if any(row[0] for row in found):
                yield 'rows', packed_rows(chain([first], found, rows))
                return
    raise FormatError('no layer of points', cure='export the trees as points')


def _layer(
    base: sqlite3.Connection, table: str, geometry: str, system: object
) -> Iterator[list[object]]:
    """Names of the columns, then the rows; a row has empty places without a point."""
    quoted = table.replace('"', '""')
    cursor = base.execute(f'SELECT * FROM "{quoted}" LIMIT {MAX_LINES}')
    columns = [each[0] for each in cursor.description]
    at = columns.index(geometry)
    kept = [i for i, name in enumerate(columns) if i != at and name.lower() not in PLACES]
    is_degrees = system == 4326 or system in _WEB_MAP
    names = ('longitude', 'latitude') if is_degrees else ('x', 'y')
    yield [*names, *(columns[i] for i in kept)]
    for row in cursor:
        point = _point(row[at]) if isinstance(row[at], bytes) else None
        if point is not None and system in _WEB_MAP:
            point = _degrees(*point)
        place = ['', ''] if point is None else [repr(each) for each in point]
        yield [*place, *(row[i] for i in kept)]


def _point(blob: bytes) -> tuple[float, float] | None:
    """Return x and y of a point, or the first of a multipoint; None for what is neither."""
    if blob[:2] != b'GP':
        return None
    with suppress(struct.error, IndexError):  # cut off, or a code that the standard does not have
        at = 8 + _ENVELOPES[(blob[3] >> 1) & 7]
        for begin in (at, at + 9):  # of a point, and of the first in a multipoint
            order = '<' if blob[begin] == 1 else '>'
            (kind,) = struct.unpack_from(f'{order}I', blob, begin + 1)
            if kind % 1000 == 1:
                x, y = struct.unpack_from(f'{order}2d', blob, begin + 5)
                return (x, y) if math.isfinite(x + y) else None
            if kind % 1000 != 4:
                break
    return None


def _degrees(x: float, y: float) -> tuple[float, float]:
    """Longitude and latitude of a place on a web map [deg]."""
    latitude = 2.0 * math.atan(math.exp(min(y / _RADIUS, 100.0))) - 0.5 * math.pi
    return math.degrees(x / _RADIUS), math.degrees(latitude)
