# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Places of the trees of an inventory: on a map in metres, in degrees, or as geometries."""

from __future__ import annotations

import math
import re

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats
from tree_sway.files.scenes.inventory.columns import InventoryColumns
from tree_sway.files.scenes.inventory.geometry_cell import point_of_cell
from tree_sway.files.scenes.inventory.united_states import are_in_states
from tree_sway.files.table_file import Column

_EARTH_RADIUS = 6.371e6
"""Mean radius of the Earth [m]."""

_FAR = 1e5
"""Coordinates beyond which a map's origin is moved to the trees [m]."""

_MOST_LONGITUDE = 180.0
_MOST_LATITUDE = 90.0

_DEGREE_DIGITS = 5
"""Digits after the point of degrees, the fifth of which is a metre; metres have fewer."""

_DMS = re.compile(
    r"([NSEW]?)\s*(-?\d+)\s*°\s*(\d+(?:\.\d+)?)\s*['′’]\s*(?:(\d+(?:\.\d+)?)\s*(?:\"|″|”|''))?\s*([NSEW]?)"
)
"""Degrees, minutes and maybe seconds, and the side of the equator or of Greenwich."""

_LEAST_NORTHING = 3.5e6
_MOST_EASTING = 9e5
"""Places of systems such as UTM in the middle latitudes [m]."""
_FEW_DIGITS = 1
_CLOSEST = 0.1
"""Mean distance of trees below which places of `_FEW_DIGITS` are degrees too [m]."""
_FARTHEST = 1.0
"""Mean distance of trees above which places are no degrees [deg]."""


Places = tuple[Floats, Floats]
"""East and north of each tree [m], (n,) each; NaN without a place."""


def places_of(columns: InventoryColumns) -> Places | None:
    """Return the places of all rows, and note whether they are in the United States; or None."""
    by_degrees = columns.find('latitude', 'longitude')
    by_metres = columns.find('x', 'y')
    if by_degrees is not None:
        latitude, longitude = (_degrees(columns, each.index) for each in by_degrees)
        is_plot = columns.n_rows > 1 and not np.ptp(latitude) + np.ptp(longitude)
        if by_metres is None or not is_plot:
            return _of_degrees(columns, latitude, longitude)
        columns.note('all trees have one latitude and longitude: placed by x and y')
    if by_metres is not None:
        return _of_map(columns, by_metres[0], by_metres[1])
    by_geometry = columns.table.find_all('place')
    if not by_geometry:
        return None
    placed = (each for each in by_geometry if any(map(point_of_cell, columns.texts(each))))
    return _of_geometries(columns, next(placed, by_geometry[0]))


def about_centre(columns: InventoryColumns) -> Places | None:
    """
    Return places by azimuth, clockwise from north, and distance from the centre of a plot.

    Distances without a unit are in feet beside stems in inches. None without such columns; a
    `FormatError` for trees of several plots.
    """
    found = columns.find('azimuth', 'distance')
    if found is None:
        return None
    table = columns.table
    for index in table.find_all('plot'):
        if len({*columns.texts(index)}) > 1:
            raise table.error(
                f'azimuths are about several centres, by {table.columns[index]}',
                cure='keep the trees of one, or give x and y',
            )
    azimuth, distance = found
    turn = table.unit_of(azimuth.index, 'azimuth') or 'deg'
    unit = table.unit_of(distance.index, 'distance') or ('ft' if columns.has_inches else 'm')
    angle = columns.numbers(azimuth.index)[0] * azimuth.factor
    away = columns.numbers(distance.index)[0] * table.known_factor('length', unit)
    columns.note(f'placed from the centre of the plot: azimuths in {turn}, distances in {unit}')
    return away * np.sin(angle), away * np.cos(angle)


def _degrees(columns: InventoryColumns, index: int) -> Floats:
    """Read a column of degrees, decimal or with minutes and seconds: ``52°31'10.5"N``."""
    parts = [_DMS.fullmatch(text.strip()) for text in columns.texts(index)]
    if not any(parts):
        return columns.numbers(index)[0]
    return np.array([each and _decimal(each) for each in parts], dtype=np.float64)


def _decimal(parts: re.Match[str]) -> float:
    """Return degrees, minutes and seconds as degrees, negative in the south and west."""
    degrees, minutes, seconds = (float(part or 0.0) for part in parts.groups()[1:4])
    is_negative = parts[2].startswith('-') or bool({'S', 'W'} & {parts[1], parts[5]})
    sign = -1.0 if is_negative else 1.0
    return sign * (abs(degrees) + minutes / 60.0 + seconds / 3600.0)


def _of_map(columns: InventoryColumns, east: Column, north: Column) -> Places:
    """Read columns of x and y, which may be degrees for all that."""
    x, _ = columns.numbers(east.index)
    y, _ = columns.numbers(north.index)
    names = f'{columns.table.columns[east.index]} and {columns.table.columns[north.index]}'
    digits = min(_digits(columns, east.index), _digits(columns, north.index))
    if _in_range(x, _MOST_LONGITUDE) and _in_range(y, _MOST_LATITUDE):
        reason = ''
        if digits >= _DEGREE_DIGITS and _distance(x, y) > _FARTHEST:
            columns.note(f'{names} are taken in m: as degrees the trees would be too far apart')
        elif digits >= _DEGREE_DIGITS:
            reason = 'by their many digits'
        elif digits >= _FEW_DIGITS and _distance(x, y) < _CLOSEST:
            reason = 'as the trees would touch in metres'
        if reason:
            columns.note(f'{names} are taken as longitude and latitude, {reason}')
            return _of_degrees(columns, y, x)
    # No easting in metres is as far as this, and no northing with one is as near.
    if np.nanmedian(x) > _LEAST_NORTHING > _MOST_EASTING > np.nanmedian(y) > 0.0:
        columns.note(f'{names} are taken as north and east, by their size')
        return _near_origin(columns, y * north.factor, x * east.factor)
    return _near_origin(columns, x * east.factor, y * north.factor)


def _in_range(values: Floats, most: float) -> bool:
    """Whether all known values, of which there is one, are at most some size."""
    return 0.0 <= float(np.nanmax(np.abs(values), initial=-1.0)) <= most


def _digits(columns: InventoryColumns, index: int) -> float:
    """Digits after the point of the middle cell of a column; 0 where it has a unit."""
    _, unit_in_cells = columns.numbers(index)
    if unit_in_cells or columns.table.unit_of(index, 'x'):
        return 0.0
    digits = [len(cell.partition('.')[2].strip()) for cell in columns.texts(index) if cell]
    return float(np.median(digits)) if digits else 0.0


def _distance(x: Floats, y: Floats) -> float:
    """Mean distance of places, each of which has its share of their rectangle."""
    known = np.stack([x, y])[:, np.isfinite(x + y)]
    count = known.shape[1]
    return float(np.ptp(known, axis=1).max()) / math.sqrt(count) if count > 1 else math.inf


def _of_geometries(columns: InventoryColumns, index: int) -> Places:
    """Read a column of points, in degrees or in metres by the size of most."""
    cells = columns.texts(index)
    points = [point_of_cell(cell) for cell in cells]
    for row, cell in enumerate(cells):
        if cell and points[row] is None:
            columns.leave_out(row, 'no place', f"'{cell[:40]}' is no latitude and longitude")
    east, north = np.array([point or (math.nan, math.nan) for point in points]).T
    far = np.abs(east[np.isfinite(east)]) > _MOST_LONGITUDE
    if 2 * np.count_nonzero(far) > len(far):
        return _near_origin(columns, east, north)
    return _of_degrees(columns, north, east)


def _of_degrees(columns: InventoryColumns, latitude: Floats, longitude: Floats) -> Places:
    """Turn degrees into metres east and north of the first tree, on a sphere."""
    is_known = (np.abs(latitude) <= 90.0) & (np.abs(longitude) <= 360.0)
    is_known &= _is_fixed(is_known, latitude, longitude, 1.0)
    if not is_known.any():
        nowhere = np.full(len(latitude), np.nan)
        return nowhere, nowhere
    columns.note('east and north are counted from the first tree')
    first = int(np.argmax(is_known))
    parallel_radius = _EARTH_RADIUS * math.cos(math.radians(latitude[first]))
    east = longitude - longitude[first]
    east -= 360.0 * np.round(east / 360.0)  # the short way round
    x = parallel_radius * np.radians(east)
    y = _EARTH_RADIUS * np.radians(latitude - latitude[first])
    columns.is_in_states = bool(are_in_states(latitude, longitude)[is_known].all())
    return np.where(is_known, x, np.nan), np.where(is_known, y, np.nan)


def _is_fixed(known: NDArray[np.bool_], x: Floats, y: Floats, far: float) -> NDArray[np.bool_]:
    """Whether each place is not 0, 0, as phones write it without a fix, where most are far."""
    away = np.abs(x) + np.abs(y)
    are_far = 2 * np.count_nonzero(away[known] > far) > np.count_nonzero(known)
    return (away != 0.0) | (not are_far)


def _near_origin(columns: InventoryColumns, x: Floats, y: Floats) -> Places:
    """Move places on a map by whole metres to near the origin, for single precision."""
    is_known = np.isfinite(x) & np.isfinite(y)
    is_known &= _is_fixed(is_known, x, y, _FAR)
    x = np.where(is_known, x, np.nan)
    y = np.where(is_known, y, np.nan)
    farthest = np.nanmax(np.abs([x, y]), initial=0.0)
    if farthest <= _FAR:
        return x, y
    east = float(np.floor(np.nanmin(x)))
    north = float(np.floor(np.nanmin(y)))
    if east or north:
        columns.note(f'moved by {-east:.0f}, {-north:.0f} m to be near the origin')
    return x - east, y - north
