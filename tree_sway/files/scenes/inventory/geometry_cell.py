# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A point in one cell of a table: a pair of numbers, WKT or GeoJSON."""

from __future__ import annotations

import re
from typing import NamedTuple

_NUMBER = r'-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?'
_NUMBERS = re.compile(_NUMBER)
_LATITUDE_FIRST = re.compile(rf'\s*\(?\s*({_NUMBER})\s*,\s*({_NUMBER})\s*\)?\s*')
"""As in ``48.85, 2.32`` or ``(48.85, 2.32)``."""

_GEOMETRY = re.compile(r'(?:POINT[\sZM]*\(|coordinates)(.*)', re.IGNORECASE | re.DOTALL)
"""Coordinates of a geometry, without its reference system, as in ``SRID=4326;POINT...``."""


class Point(NamedTuple):
    """East or longitude, and north or latitude."""

    east: float
    north: float


def point_of_cell(cell: str) -> Point | None:
    """
    Return the point of a cell, the first of several; None without one.

    A pair is latitude and longitude, ``48.85, 2.32``. Geometries have longitude or easting first:
    WKT ``POINT (2.32 48.85)`` and GeoJSON ``{"type": "Point", "coordinates": [2.32, 48.85]}``.
    """
    pair = _LATITUDE_FIRST.fullmatch(cell)
    if pair is not None:
        return Point(east=float(pair[2]), north=float(pair[1]))
    geometry = _GEOMETRY.search(cell)
    numbers = _NUMBERS.findall(geometry[1]) if geometry is not None else []
    if len(numbers) < 2:
        return None
    return Point(east=float(numbers[0]), north=float(numbers[1]))
