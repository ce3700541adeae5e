# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Places of the trees of an inventory: on a map in metres, in degrees, or as a geometry."""

from __future__ import annotations

from dataclasses import dataclass
import math
import re

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.files.scenes.inventory.columns import InventoryColumns

_EARTH = 6.371e6
_FAR = 1e5
_NUMBER = re.compile(r'-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?')
_LATITUDE_FIRST = re.compile(r'\s*\(?\s*-?\d+(\.\d+)?\s*,\s*-?\d+(\.\d+)?\s*\)?\s*')
_GEOMETRY = re.compile(r'(?:POINT[\sZM]*\(|coordinates)(.*)', re.IGNORECASE | re.DOTALL)
"""The places of a geometry, behind the number of its reference system (``SRID=4326;POINT...``)."""
_DEGREE_DIGITS = 5
"""Digits after the point of degrees, the fifth of which is a metre; metres have fewer."""
_STATES_SOUTH = 24.0
_STATES_NORTH = np.array([
    (-125.0, 49.0), (-95.2, 49.0), (-89.6, 48.0), (-84.6, 46.5), (-83.0, 45.5), (-82.5, 43.0),
    (-82.0, 41.9), (-79.0, 42.8), (-78.9, 43.5), (-76.5, 44.1), (-75.0, 45.0), (-71.5, 45.0),
    (-70.3, 46.2), (-69.2, 47.4), (-67.8, 47.1), (-66.9, 44.8),
])  # fmt: skip
"""Longitude and latitude along the northern border of the United States, from west to east [deg],
roughly; foresters there measure in inches and feet, those of Canada in metres."""


@dataclass(frozen=True)
class Places:
    """East and north of each tree [m], NaN without a place; ``is_in_states`` if all are there."""

    x: Floats
    y: Floats
    is_in_states: bool = False


def places_of(columns: InventoryColumns) -> Places | None:
    """Return the places of all rows; None without columns of them."""
    pair = columns.find('latitude', 'longitude')
    if pair is not None:
        north, east = (columns.numbers(column.index)[0] for column in pair)
        return _of_degrees(columns, north, east)
    on_map = columns.find('x', 'y')
    if on_map is not None:
        x, y = (columns.numbers(column.index)[0] * column.factor for column in on_map)
        if all(
            _has_degrees(columns, each.index, most)
            for each, most in zip(on_map, (180, 90), strict=True)
        ):
            names = ' and '.join(columns.table.columns[each.index] for each in on_map)
            columns.note(f'{names} are taken as longitude and latitude, by their many digits')
            return _of_degrees(columns, y, x)
        return _near_origin(columns, x, y)
    geometry = columns.table.find('place')
    return None if geometry is None else _of_geometries(columns, geometry.index)


def _has_degrees(columns: InventoryColumns, index: int, most: float) -> bool:
    """Whether a column has degrees: within their range, with digits that metres need not have."""
    values, unit = columns.numbers(index)
    known = np.abs(values[np.isfinite(values)])
    if unit or columns.table.unit_of(index, 'x') or not len(known) or known.max() > most:
        return False
    digits = [len(cell.partition('.')[2].strip()) for cell in columns.texts(index) if cell]
    return float(np.median(digits)) >= _DEGREE_DIGITS


def _of_geometries(columns: InventoryColumns, index: int) -> Places:
    """Places of ``48.85, 2.32``, of WKT ``POINT (2.32 48.85)`` or of GeoJSON in a cell."""
    first, second = np.full(columns.n_rows, np.nan), np.full(columns.n_rows, np.nan)
    for row, cell in enumerate(columns.texts(index)):
        is_pair = _LATITUDE_FIRST.fullmatch(cell) is not None
        geometry = _GEOMETRY.search(cell)
        found = _NUMBER.findall(geometry[1] if geometry else cell)
        if len(found) >= 2 and (is_pair or geometry):
            first[row], second[row] = map(float, found[1::-1] if is_pair else found[:2])
        elif cell:
            columns.leave_out(row, 'no place', f"'{cell[:40]}' is no latitude and longitude")
    known = np.abs(first[np.isfinite(first)])
    if len(known) and np.median(known) > 180.0:  # one cell that is wrong does not decide for all
        return _near_origin(columns, first, second)
    return _of_degrees(columns, second, first)


def _of_degrees(columns: InventoryColumns, north: Floats, east: Floats) -> Places:
    """East and north of the first tree, on a sphere."""
    good = (np.abs(north) <= 90.0) & (np.abs(east) <= 360.0)
    if not good.any():
        return Places(np.full(len(north), np.nan), np.full(len(north), np.nan))
    first = int(np.argmax(good))
    columns.note('east and north are counted from the first tree')
    shrink = math.cos(math.radians(north[first]))
    x = _EARTH * shrink * np.radians(np.where(good, east - east[first], np.nan))
    y = _EARTH * np.radians(np.where(good, north - north[first], np.nan))
    west_to_east, border_north = _STATES_NORTH.T
    border = np.interp(east, west_to_east, border_north, left=-90.0, right=-90.0)
    is_in_states = (north > _STATES_SOUTH) & (north < border)
    return Places(x, y, bool(is_in_states[good].all()))


def _near_origin(columns: InventoryColumns, x: Floats, y: Floats) -> Places:
    """Places less a whole number of metres if they are on a map, for single precision."""
    is_known = np.isfinite(x) & np.isfinite(y)
    x, y = np.where(is_known, x, np.nan), np.where(is_known, y, np.nan)
    if np.nanmax(np.abs([x, y]), initial=0.0) <= _FAR:
        return Places(x, y)
    east, north = float(np.floor(np.nanmin(x))), float(np.floor(np.nanmin(y)))
    columns.note(f'moved by {-east:.0f}, {-north:.0f} m to be near the origin')
    return Places(x - east, y - north)
