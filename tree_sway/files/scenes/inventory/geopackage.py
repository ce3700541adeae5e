# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
GeoPackage (.gpkg, OGC 12-128r18) as a table: the first layer of points in the SQLite file.

A geometry is a header, whose length its flags tell, and a point in well-known binary. Layers in
degrees (EPSG 4326) have latitude and longitude, those of a web map (EPSG 3857) are turned into
them, all others are taken in metres.
"""

from __future__ import annotations

from contextlib import closing
import math
from pathlib import Path
import sqlite3
import struct

from tree_sway.errors import FormatError
from tree_sway.files.cell_table import table_of_cells
from tree_sway.files.table_file import TextTable
from tree_sway.files.text_file import MAX_LINES, reason_of

_LAYERS = """
    SELECT c.table_name, g.column_name, g.srs_id FROM gpkg_contents c
    JOIN gpkg_geometry_columns g ON g.table_name = c.table_name WHERE c.data_type = 'features'
"""
_ENVELOPES = (0, 32, 48, 48, 64)
"""Bytes of the envelope by its code in the flags."""
_WEB_MAP = (3857, 900913)
_RADIUS = 6378137.0


def is_geopackage(head: str, path: Path) -> bool:
    """Whether the beginning of a file is SQLite and its name that of a GeoPackage."""
    return head.startswith('SQLite format 3\0') and path.suffix.lower() == '.gpkg'


def read_geopackage(path: Path) -> TextTable:
    """Return the first layer with points; a `FormatError` if there is none."""
    try:
        with closing(sqlite3.connect(f'{path.resolve().as_uri()}?mode=ro', uri=True)) as base:
            layers = base.execute(_LAYERS).fetchall()
            for table, geometry, system in layers:
                found = _layer(base, table, geometry, system, str(path))
                if found is not None:
                    return found
    except (sqlite3.Error, struct.error, ValueError) as error:
        what = f'cannot be read as GeoPackage: {reason_of(error)}'
        raise FormatError(what, where=str(path), cure='export it again') from None
    raise FormatError('no layer of points', where=str(path), cure='export the trees as points')


def _layer(
    base: sqlite3.Connection, table: str, geometry: str, system: int, source: str
) -> TextTable | None:
    quoted = table.replace('"', '""')
    cursor = base.execute(f'SELECT * FROM "{quoted}" LIMIT {MAX_LINES}')
    columns = [each[0] for each in cursor.description]
    at = columns.index(geometry)
    taken = ('x', 'y', 'latitude', 'longitude', 'lat', 'lon')
    kept = [i for i, name in enumerate(columns) if i != at and name.lower() not in taken]
    is_degrees = system == 4326 or system in _WEB_MAP
    rows = []
    for row in cursor:
        point = _point(row[at]) if isinstance(row[at], bytes) else None
        if point is not None and system in _WEB_MAP:
            point = _degrees(*point)
        place = ['', ''] if point is None else [repr(each) for each in point]
        rows.append([*place, *('' if row[i] is None else str(row[i]) for i in kept)])
    names = ('longitude', 'latitude') if is_degrees else ('x', 'y')
    if not any(row[0] for row in rows):
        return None
    return table_of_cells([*names, *(columns[i] for i in kept)], rows, source)


def _point(blob: bytes) -> tuple[float, float] | None:
    """Return x and y of a point, or the first of a multipoint; None for another geometry."""
    if blob[:2] != b'GP':
        return None
    at = 8 + _ENVELOPES[(blob[3] >> 1) & 7]
    for _ in range(2):
        order = '<' if blob[at] == 1 else '>'
        (kind,) = struct.unpack_from(f'{order}I', blob, at + 1)
        if kind % 1000 == 1:
            x, y = struct.unpack_from(f'{order}2d', blob, at + 5)
            return (x, y) if math.isfinite(x) and math.isfinite(y) else None
        if kind % 1000 != 4:
            return None
        at += 9
    return None


def _degrees(x: float, y: float) -> tuple[float, float]:
    """Longitude and latitude of a place on a web map [deg]."""
    latitude = 2.0 * math.atan(math.exp(y / _RADIUS)) - 0.5 * math.pi
    return math.degrees(x / _RADIUS), math.degrees(latitude)
