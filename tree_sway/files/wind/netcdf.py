# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Wind of a reanalysis or a station in netCDF, such as ERA5 from the Climate Data Store.

The components are ``u10`` and ``v10`` (or others of their usual names), or the wind is a speed and
the direction it comes from, as stations have it; on a grid of latitude and longitude the point is
the nearest to ``at``, or the first of the grid. Times are those of the CF conventions (``hours
since 1900-01-01``). The extra ``netcdf`` reads them.
"""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.errors import FormatError, ParameterError
from tree_sway.files.bounded import Arrays, bounded_arrays
from tree_sway.files.column_names import is_named, rank_of
from tree_sway.files.table_file import known_factor
from tree_sway.files.wind.compass import velocity_from
from tree_sway.files.wind.record import WindRecord, WindRows
from tree_sway.files.wind.station_means import filled_means

_MOST = 20_000_000
"""Largest number of times."""
_COMPONENTS = ('wind_x', 'wind_y')
_POLAR = ('wind_speed', 'wind_direction')
_USUAL_UNITS = {'speed': 'm/s', 'angle': 'deg'}
_WORDS = {'time': 'time', 'wind_x': 'eastward wind', 'wind_y': 'northward wind'}


def read_netcdf_wind(
    path: Path, at: tuple[str, ...] | None = None, turbulence: bool = True, seed: float = 0
) -> WindRecord:
    """
    Read the wind at one point of a netCDF file; ``at`` is its latitude and longitude in degrees.

    Raises
    ------
    FormatError
        Not netCDF, no wind, no time, an unknown unit, or no good sample.
    ParameterError
        A point that is none.
    MissingDependencyError
        If netCDF4 is not installed.

    """
    point = map(repr, _point(at))
    cure = 'download it again'
    found = bounded_arrays(_winds_of_netcdf, path, *point, kind='a netCDF file', cure=cure)
    rows = WindRows(str(path), row_name='sample', gust=found.get('gust'))
    rows.time = array('d', found['seconds'])
    rows.velocity = array('d', found['velocity'].ravel())
    rows.number = array('q', range(1, len(rows.time) + 1))
    record = rows.record(epoch=float(found['epoch']), notes=(str(found['note']),))
    return filled_means(record, turbulence, seed)


def _winds_of_netcdf(path: str, *at: str) -> Arrays:
    """Yield velocity, seconds after the first, gust where there is one, epoch and a note."""
    from netCDF4 import Dataset

    with Dataset(path) as data:
        found = {each: _find(data, each) for each in ('time', *_COMPONENTS, *_POLAR, 'gust')}
        clock = found['time']
        is_polar = None in [found[each] for each in _COMPONENTS]
        first, second = (found[each] for each in (_POLAR if is_polar else _COMPONENTS))
        if None in (clock, first, second):
            said = [word for each, word in _WORDS.items() if found[each] is None]
            raise FormatError(
                f'no {" and no ".join(said)} among {", ".join([*data.variables][:20])}',
                cure='choose the 10 m u and v components of wind, or its speed and direction',
            )
        note, place = _place(data, first, at)
        one = _series(first, 'speed', clock, place)
        other = _series(second, 'angle' if is_polar else 'speed', clock, place)
        components = np.column_stack([one, other, np.zeros(len(one))])
        yield 'velocity', velocity_from(one, np.degrees(other)) if is_polar else components
        seconds, epoch = _seconds(clock)
        yield 'seconds', seconds
        yield 'epoch', epoch
        yield 'note', note
        if found['gust'] is not None:
            yield 'gust', _series(found['gust'], 'speed', clock, place)


def _point(at: tuple[str, ...] | None) -> tuple[float, ...]:
    """Return a latitude and a longitude, or nothing."""
    if at is None:
        return ()
    try:
        latitude, longitude = (float(part) for part in at)
    except (TypeError, ValueError):
        latitude = longitude = np.nan
    if not (abs(latitude) <= 90.0 and abs(longitude) <= 360.0):
        raise ParameterError(f"'{at}' is no place", cure='write at=LATITUDE,LONGITUDE in degrees')
    return latitude, longitude


def _find(data: Any, quantity: str) -> Any:
    """Variable of a quantity whose name comes first among the usual ones, or standard name."""
    ranks = [
        (is_standard, rank, name)
        for name, variable in data.variables.items()
        for is_standard, each in enumerate((name, str(getattr(variable, 'standard_name', ''))))
        if (rank := rank_of(each, quantity)) is not None
    ]
    return data.variables[min(ranks)[2]] if ranks else None


def _place(data: Any, variable: Any, point: Sequence[str]) -> tuple[str, dict[str, int]]:
    """Note of where a point is, empty without a grid, and index of each dimension there."""
    chosen = dict[str, int]()
    said = list[str]()
    for axis, quantity in enumerate(('latitude', 'longitude')):
        for name in [d for d in variable.dimensions if is_named(d, quantity)][:1]:
            degrees = np.asarray(data.variables[name][:], dtype=np.float64)
            wanted = float(point[axis]) if point else degrees[0]
            apart = np.abs((degrees - wanted + 180.0) % 360.0 - 180.0)
            chosen[name] = int(np.argmin(apart))
            said.append(f'{quantity} {degrees[chosen[name]]:g}')
    note = f'the point at {", ".join(said)}; at=LATITUDE,LONGITUDE chooses another'
    return note * bool(said), chosen


def _series(variable: Any, kind: str, clock: Any, place: dict[str, int]) -> Floats:
    """
    Values over time at a place in SI, of the first of all other dimensions; NaN where missing.

    Raises a `FormatError` for a unit that is not one of the kind; without one, it is the usual one
    of the kind, m/s or degrees.
    """
    if len(clock) > _MOST:
        raise ValueError(f'{len(clock)} times')
    unit = str(getattr(variable, 'units', _USUAL_UNITS[kind]))
    factor = known_factor(kind, unit, variable.name)
    index = tuple(
        slice(None) if name in clock.dimensions else place.get(name, 0)
        for name in variable.dimensions
    )
    values = np.ma.asarray(variable[index], dtype=np.float64)
    return factor * np.ma.filled(values, np.nan)


def _seconds(clock: Any) -> tuple[Floats, float]:
    """Seconds after the first time, and that in seconds after 1970-01-01."""
    from netCDF4 import date2num, num2date

    unit = 'seconds since 1970-01-01'
    dates = num2date(clock[:], clock.units, getattr(clock, 'calendar', 'standard'))
    since_1970 = np.asarray(date2num(dates, unit), dtype=np.float64)
    return since_1970 - since_1970[0], float(since_1970[0])
