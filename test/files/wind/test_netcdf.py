# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Reanalyses in netCDF, written here as the Climate Data Store has them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tree_sway.errors import FormatError, MissingDependencyError, ParameterError
from tree_sway.files.wind import wind_file
from tree_sway.files.wind.wind_file import read_wind

netcdf = pytest.importorskip('netCDF4', reason='the extra netcdf is not installed')

HOURS = 4
GRID = {'latitude': [52.75, 52.5], 'longitude': [13.25, 13.5, 13.75]}


def written(path: Path, kind: str = 'NETCDF4', names: tuple[str, ...] = ('u10', 'v10')) -> Path:
    """Write hours of wind: east is the hour + 10 of latitude + longitude index, north is 1."""
    with netcdf.Dataset(path, 'w', format=kind) as data:
        data.createDimension('valid_time', HOURS)
        clock = data.createVariable('valid_time', 'i4', ('valid_time',))
        clock.units = 'seconds since 1970-01-01'
        clock[:] = 1709251200 + 3600 * np.arange(HOURS)
        for name, degrees in GRID.items():
            data.createDimension(name, len(degrees))
            data.createVariable(name, 'f8', (name,))[:] = degrees
        shape = ('valid_time', *GRID)
        hour, lat, lon = np.meshgrid(range(HOURS), range(2), range(3), indexing='ij')
        for name, values in zip(names, (hour + 10.0 * lat + lon, 1.0 + 0.0 * hour), strict=True):
            variable: Any = data.createVariable(name, 'f4', shape, fill_value=-32767.0)
            variable.units = 'm s**-1'
            variable[:] = values
    return path


@pytest.mark.parametrize('kind', ['NETCDF4', 'NETCDF3_CLASSIC', 'NETCDF3_64BIT_OFFSET'])
def test_the_nearest_point_is_read(kind: str, tmp_path: Path) -> None:
    path = written(tmp_path / 'era5.nc', kind)
    record = read_wind(path, at=('52.4', '13.6'), turbulence=False)
    np.testing.assert_allclose(record.velocity[:, 0], 11.0 + np.arange(HOURS))
    np.testing.assert_allclose(record.velocity[:, 1], 1.0)
    assert record.time.tolist() == [0.0, 3600.0, 7200.0, 10800.0]
    assert record.epoch == 1709251200.0
    assert record.notes[0].startswith('the point at latitude 52.5, longitude 13.5')
    first = read_wind(path, turbulence=False)
    np.testing.assert_allclose(first.velocity[:, 0], np.arange(HOURS))


def test_a_missing_hour_is_refused(tmp_path: Path) -> None:
    path = written(tmp_path / 'era5.nc')
    with netcdf.Dataset(path, 'a') as data:
        data.variables['u10'][1] = -32767.0
    record = read_wind(path, turbulence=False)
    assert (len(record.time), record.refused) == (HOURS - 1, 1)
    assert record.first_refused == 'sample 2: no value'


def test_errors_name_what_is_missing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = written(tmp_path / 't2m.nc', names=('t2m', 'd2m'))
    with pytest.raises(FormatError, match='no eastward wind and no northward wind among'):
        read_wind(path)
    with pytest.raises(ParameterError, match='write at=LATITUDE,LONGITUDE in degrees'):
        read_wind(path, at=('north', 'east'))
    whole = written(tmp_path / 'whole.nc').read_bytes()
    (tmp_path / 'cut.nc').write_bytes(whole[: len(whole) // 2])
    with pytest.raises(FormatError, match='not a netCDF file that can be read'):
        read_wind(tmp_path / 'cut.nc')
    (tmp_path / 'netCDF4.py').write_text("raise ModuleNotFoundError(name='netCDF4')")
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(MissingDependencyError, match=r'netCDF4.*'):
        read_wind(tmp_path / 'whole.nc')
    assert 'netcdf' in {known.name for known in wind_file.WIND_FORMATS}


def test_components_are_found_by_their_standard_names(tmp_path: Path) -> None:
    path = written(tmp_path / 'mast.nc', names=('mast_a', 'mast_b'))
    with pytest.raises(FormatError, match='no eastward wind and no northward wind among'):
        read_wind(path, turbulence=False)
    with netcdf.Dataset(path, 'a') as data:
        data['mast_a'].standard_name = 'eastward_wind'
        data['mast_b'].standard_name = 'northward_wind'
    assert read_wind(path, turbulence=False).velocity[0].tolist() == [0.0, 1.0, 0.0]


def station(path: Path, speed_unit: str, direction_unit: str = 'degree') -> Path:
    """Write three samples of a station: from the east, from the north, and a broken vane."""
    with netcdf.Dataset(path, 'w') as data:
        data.createDimension('time', 3)
        columns = {
            'time': ('minutes since 2024-03-01 00:00', [0.0, 10.0, 20.0]),
            'wspd': (speed_unit, [2.0, 4.0, 6.0]),
            'wdir': (direction_unit, [90.0, 0.0, 999.0]),
        }
        for name, (unit, values) in columns.items():
            variable: Any = data.createVariable(name, 'f8', ('time',))
            variable.units = unit
            variable[:] = values
        data['wspd'].standard_name = 'wind_speed'
        data['wdir'].standard_name = 'wind_from_direction'
    return path


@pytest.mark.parametrize(('unit', 'factor'), [('m s-1', 1.0), ('knots', 1852.0 / 3600.0)])
def test_speed_and_direction_are_read_in_their_units(
    unit: str, factor: float, tmp_path: Path
) -> None:
    record = read_wind(station(tmp_path / 'mast.nc', unit), turbulence=False)
    wanted = factor * np.array([[-2.0, 0.0, 0.0], [0.0, -4.0, 0.0]])
    np.testing.assert_allclose(record.velocity, wanted, atol=1e-12)
    assert record.refused == 1


def test_an_unknown_unit_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match=r"mast\.nc: wspd: unknown unit 'furlongs'"):
        read_wind(station(tmp_path / 'mast.nc', 'furlongs'))
