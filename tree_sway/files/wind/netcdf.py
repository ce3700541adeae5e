# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Wind of a reanalysis or a station in netCDF, such as ERA5 from the Climate Data Store.

The components are ``u10`` and ``v10`` (or others of their usual names), on a grid of latitude and
longitude; the point is the nearest to ``at``, or the first of the grid. Times are those of the CF
conventions (``hours since 1900-01-01``). The extra ``netcdf`` reads them.
"""

from __future__ import annotations

from array import array
from pathlib import Path
from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.errors import FormatError, MissingDependencyError, ParameterError
from tree_sway.extras import cure_of_missing
from tree_sway.files.column_names import rank_of
from tree_sway.files.text_file import reason_of
from tree_sway.files.wind.record import WindRecord, WindRows
from tree_sway.files.wind.station_means import filled_means

_MOST = 20_000_000
"""Largest number of times."""
_WORDS = {'time': 'time', 'wind_x': 'eastward wind', 'wind_y': 'northward wind'}


def read_netcdf_wind(
    path: Path, at: tuple[str, ...] | None = None, turbulence: bool = True, seed: float = 0
) -> WindRecord:
    """
    Read the wind at one point of a netCDF file; ``at`` is its latitude and longitude in degrees.

    Raises
    ------
    FormatError
        Not netCDF, no components of the wind, no time, or no good sample.
    ParameterError
        A point that is none.
    MissingDependencyError
        If netCDF4 is not installed.

    """
    try:
        from netCDF4 import Dataset
    except ModuleNotFoundError:
        cure = cure_of_missing('netCDF4')
        raise MissingDependencyError("No module named 'netCDF4'", cure=cure) from None
    point = _point(at)
    try:
        with Dataset(path) as data:
            return _read(data, str(path), point, turbulence, seed)
    except (OSError, ValueError, RuntimeError, KeyError, IndexError) as error:
        what = f'cannot be read as netCDF: {reason_of(error)}'
        raise FormatError(what, where=str(path), cure='download it again') from None


def _point(at: tuple[str, ...] | None) -> tuple[float, float] | None:
    if at is None:
        return None
    try:
        latitude, longitude = (float(part) for part in at)
    except (TypeError, ValueError):
        latitude = longitude = np.nan
    if not (abs(latitude) <= 90.0 and abs(longitude) <= 360.0):
        raise ParameterError(f"'{at}' is no place", cure='write at=LATITUDE,LONGITUDE in degrees')
    return latitude, longitude


def _read(
    data: Any, source: str, point: tuple[float, float] | None, turbulence: bool, seed: float
) -> WindRecord:
    names = {each: _find(data, each) for each in ('time', 'wind_x', 'wind_y', 'gust')}
    missing = [each for each in ('time', 'wind_x', 'wind_y') if names[each] is None]
    if missing:
        said = [_WORDS[each] for each in missing]
        what = f'no {" and no ".join(said)} among {", ".join([*data.variables][:20])}'
        raise FormatError(what, where=source, cure='choose the 10 m u and v components of wind')
    clock, x, y, gust = (data.variables.get(name) for name in names.values())
    notes, place = _place(data, x, point)
    east = _series(x, clock, place)
    north = _series(y, clock, place)
    seconds, epoch = _seconds(clock)
    rows = WindRows(source, row_name='sample')
    good = np.isfinite(east) & np.isfinite(north)
    for index in np.flatnonzero(~good).tolist():
        rows.refuse(index + 1, 'no value')
    velocity = np.stack([east, north, np.zeros(len(east))], axis=1)[good]
    rows.time = array('d', seconds[good])
    rows.velocity = array('d', velocity.ravel())
    rows.number = array('q', (np.flatnonzero(good) + 1).tolist())
    if gust is not None:
        rows.gust = _series(gust, clock, place)[good]
    return filled_means(rows.record(epoch=epoch, notes=tuple(notes)), turbulence, seed)


def _find(data: Any, quantity: str) -> str | None:
    """Variable of a quantity whose name comes first among the usual ones, or standard name."""
    ranks = list[tuple[bool, int, str]]()
    for name, variable in data.variables.items():
        standard_name = str(getattr(variable, 'standard_name', ''))
        for is_standard, each in ((False, name), (True, standard_name)):
            rank = rank_of(each, quantity)
            if rank is not None:
                ranks.append((is_standard, rank, name))
    return min(ranks)[2] if ranks else None


def _place(
    data: Any, variable: Any, point: tuple[float, float] | None
) -> tuple[list[str], dict[str, int]]:
    """Index of each dimension at a point, and a note of where that is."""
    chosen = dict[str, int]()
    said = list[str]()
    for axis, quantity in enumerate(('latitude', 'longitude')):
        name = next((d for d in variable.dimensions if rank_of(d, quantity) is not None), None)
        if name is None:
            continue
        degrees = np.asarray(data.variables[name][:], dtype=np.float64)
        wanted = degrees[0] if point is None else point[axis]
        apart = np.abs((degrees - wanted + 180.0) % 360.0 - 180.0)
        chosen[name] = int(np.argmin(apart))
        said.append(f'{quantity} {degrees[chosen[name]]:g}')
    grid = f'the point at {", ".join(said)}'
    return ([f'{grid}; at=LATITUDE,LONGITUDE chooses another'] if said else []), chosen


def _series(variable: Any, clock: Any, place: dict[str, int]) -> Floats:
    """Values over time at a place, of the first of all other dimensions; NaN where missing."""
    if len(clock) > _MOST:
        raise ValueError(f'{len(clock)} times')
    index = tuple(
        slice(None) if name in clock.dimensions else place.get(name, 0)
        for name in variable.dimensions
    )
    return np.ma.filled(np.ma.asarray(variable[index], dtype=np.float64), np.nan)


def _seconds(clock: Any) -> tuple[Floats, float]:
    """Seconds after the first time, and that in seconds after 1970-01-01."""
    from netCDF4 import date2num, num2date

    unit = 'seconds since 1970-01-01'
    dates = num2date(clock[:], clock.units, getattr(clock, 'calendar', 'standard'))
    since_1970 = np.asarray(date2num(dates, unit), dtype=np.float64)
    return since_1970 - since_1970[0], float(since_1970[0])
