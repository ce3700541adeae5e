# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A point in one cell of a table: a pair of numbers, WKT or GeoJSON."""

from __future__ import annotations

import math
import re
from typing import NamedTuple

_NUMBER = r'-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?'
_LATITUDE_FIRST = re.compile(rf'\s*\(?\s*({_NUMBER})\s*,\s*({_NUMBER})\s*\)?\s*')
"""As in ``48.85, 2.32`` or ``(48.85, 2.32)``."""

_GEOMETRY = re.compile(r'(?:[A-Z ]*\(|coordinates)(.*)', re.IGNORECASE | re.DOTALL)
"""Coordinates of a geometry, without its reference system, as in ``SRID=4326;POINT...``."""
_CORNER = re.compile(
    rf'\[\s*({_NUMBER})\s*,\s*({_NUMBER})|({_NUMBER})\s+({_NUMBER})(?:\s+{_NUMBER})*'
)
"""East and north of a corner, maybe before its height: of GeoJSON, and of WKT."""


class Point(NamedTuple):
    """East or longitude, and north or latitude."""

    east: float
    north: float


def point_of_cell(cell: str) -> Point | None:
    """
    Return the point of a cell, the mean of several; None without one.

    A pair is latitude and longitude, ``48.85, 2.32``. Geometries have longitude or easting first:
    WKT ``POINT (2.32 48.85)`` and GeoJSON ``{"type": "Point", "coordinates": [2.32, 48.85]}``.
    """
    pair = _LATITUDE_FIRST.fullmatch(cell)
    if pair is not None:
        return Point(east=float(pair[2]), north=float(pair[1]))
    geometry = _GEOMETRY.search(cell)
    corners = [
        list(filter(None, each)) for each in _CORNER.findall(geometry[1] if geometry else '')
    ]
    if not corners:
        return None
    east, north = (
        math.fsum(map(float, axis)) / len(corners) for axis in zip(*corners, strict=True)
    )
    return Point(east, north) if math.isfinite(east + north) else None
