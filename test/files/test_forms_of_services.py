# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Forms of weather services and inventories whose units or names only their makers tell."""

from __future__ import annotations

from collections.abc import Callable
from json import dumps
from pathlib import Path

import numpy as np
import pytest

from tree_sway.errors import FormatError
from tree_sway.files.motion import read_motion
from tree_sway.files.scenes.inventory.inventory_file import inventory_table
from tree_sway.files.scenes.inventory.read_inventory import inventory_of
from tree_sway.files.text_file import read_head
from tree_sway.files.trees import open_tree
from tree_sway.files.wind import read_wind

SPEEDS = [4.0 + 0.5 * row for row in range(6)]
KNOT = 1852.0 / 3600.0
KMH = 1.0 / 3.6
MPH = 0.44704


def minute(row: int) -> str:
    return f'2024-03-05T14:{row:02d}:00Z'


def table(head: str, row: str, unit: float = 1.0) -> str:
    """Lines of a table; a row has its number and speed."""
    lines = [row.format(n=n, speed=speed / unit) for n, speed in enumerate(SPEEDS)]
    return '\n'.join([head, *lines]) + '\n'


def metars() -> str:
    clouds = [{'cover': 'FEW', 'base': 5000}]
    return dumps([
        {'icaoId': 'LEJR', 'obsTime': 1709647200 + 60 * n, 'wdir': 225, 'wspd': speed / KNOT,
         'wgst': None, 'rawOb': None, 'clouds': clouds}
        for n, speed in enumerate(SPEEDS)
    ])  # fmt: skip


def archive() -> str:
    periods = [
        {'ob': {'timestamp': 1709647200 + 60 * n, 'windDir': 'SW', 'windDirDEG': 225,
                'windSpeedKTS': speed / KNOT, 'windSpeedMPH': speed / MPH}}
        for n, speed in enumerate(SPEEDS)
    ]  # fmt: skip
    return dumps({'response': [{'id': 'KJFK', 'periods': periods}]})


def rows_beside_types() -> str:
    rows = [[minute(n), speed / KNOT, 225] for n, speed in enumerate(SPEEDS)]
    return dumps({'table': {
        'columnNames': ['time', 'wind_speed', 'wind_from_direction'],
        'columnTypes': ['String', 'double', 'double'],
        'columnUnits': ['UTC', 'knots', 'degrees'],
        'rows': rows,
    }})  # fmt: skip


def hours(units: str, unit: float) -> str:
    data = [
        {'time': 1709647200 + 3600 * n, 'windSpeed': speed / unit, 'windBearing': 225}
        for n, speed in enumerate(SPEEDS)
    ]
    return dumps({'hourly': {'data': data}, 'flags': {'units': units}})


def synop() -> str:
    return dumps([
        {'stacja': 'Gdynia', 'data_pomiaru': '2024-03-05', 'godzina_pomiaru': str(n),
         'predkosc_wiatru': str(speed), 'kierunek_wiatru': '225'}
        for n, speed in enumerate(SPEEDS)
    ])  # fmt: skip


@pytest.mark.parametrize(
    ('text', 'step'),
    [
        (metars(), 60.0),
        (archive(), 60.0),
        (rows_beside_types(), 60.0),
        (hours('us', MPH), 3600.0),
        (hours('ca', KMH), 3600.0),
        (hours('si', 1.0), 3600.0),
        (synop(), 3600.0),
        (
            table(
                'Station/Location;Date;tre200s0;dkl010z0;fu3010z0;fu3010z1',
                'TAE;20240305140{n};16.5;225;{speed};99',
                KMH,
            ),
            60.0,
        ),
        (
            table(
                'time,wspd_arith_mean,wspd_vec_mean,wdir_vec_mean,wdir_vec_std',
                '2024-03-05 14:0{n}:00,{speed},1,225,3',
            ),
            60.0,
        ),
        (
            table(
                'TIMESTAMP_1,WS_1_1_1,WD_1_1_1\nyyyy-mm-dd HHMM,km h-1,degrees',
                '2024-03-05 140{n},{speed},225',
                KMH,
            ),
            60.0,
        ),
        (
            table(
                'time,Mast Wind speed [m⋅s⁻¹],Mast Wind direction [°],Mast Wind east [m⋅s⁻¹]',
                '2024-03-05T14:0{n}:00Z,{speed},225,1',
            ),
            60.0,
        ),
    ],
    ids='airports archive typed-rows us ca si synop vqha80 arm biomet decentlab'.split(),
)
def test_a_service_has_its_names_and_units(tmp_path: Path, text: str, step: float) -> None:
    path = tmp_path / f'wind.{"json" if text[0] in "[{" else "csv"}'
    path.write_text(text, encoding='utf-8')
    record = read_wind(path, turbulence=False)
    np.testing.assert_allclose(record.velocity[:, 0], np.array(SPEEDS) * np.sqrt(0.5), atol=1e-3)
    np.testing.assert_allclose(record.velocity[:, 1], np.array(SPEEDS) * np.sqrt(0.5), atol=1e-3)
    np.testing.assert_allclose(np.diff(record.time), step)


@pytest.mark.parametrize(
    ('text', 'column'),
    [
        (metars().replace('LEJR', 'KJFK', 1), 'KJFK'),
        (synop().replace('Gdynia', 'Sopot', 1), 'Sopot'),
    ],
)
def test_several_stations_are_not_one(tmp_path: Path, text: str, column: str) -> None:
    path = tmp_path / 'wind.json'
    path.write_text(text, encoding='utf-8')
    with pytest.raises(FormatError, match=f'rows of 2 instruments: .*{column}'):
        read_wind(path)


@pytest.mark.parametrize(
    ('head', 'row', 'diameters', 'wide'),
    [
        (
            'decimalLatitude,decimalLongitude,scientificName,stemDiameter,height,plantStatus',
            '42.5{n},-72.1,Acer rubrum L.,2{n},12,Live',
            [0.2, 0.21, 0.22],
            2224.0,
        ),
        (
            'Tree Id,Point X,Point Y,Diameter,Scientific Name',
            '{n},-75.1{n},39.9,1{n},Acer rubrum',
            [0.254, 0.2794, 0.3048],
            1706.0,
        ),
    ],
)
def test_an_inventory_has_its_units(
    tmp_path: Path, head: str, row: str, diameters: list[float], wide: float
) -> None:
    path = tmp_path / 'trees.csv'
    path.write_text('\n'.join([head, *(row.format(n=n) for n in range(3))]) + '\n')
    found = inventory_of(inventory_table(path, read_head(path)))
    np.testing.assert_allclose(found.diameter, diameters)
    assert np.ptp(found.x) + np.ptp(found.y) == pytest.approx(wide, rel=0.01)


@pytest.mark.parametrize(
    ('read', 'name', 'data', 'what'),
    [
        (read_motion, 'imu.txt', b'$VNIMU,-0.1,0.4,-0.6,0.1,0.2,9.8,0,0,0,20.7,84.3*66\n' * 9,
         'lines of a VectorNav'),
        (open_tree, 'trees.gpx', b'<?xml version="1.0"?>\n<gpx></gpx>\n', 'a layer of a map'),
        (open_tree, 'tree.txt', b'# vtk DataFile Version 3.0\na\nASCII\n', 'a mesh for drawing'),
        (open_tree, 'tree.dxf', b'0\nSECTION\n2\nENTITIES\n0\nENDSEC\n', 'a mesh for drawing'),
    ],
)  # fmt: skip
def test_a_foreign_file_is_refused_for_what_it_is(
    tmp_path: Path, read: Callable[[Path], object], name: str, data: bytes, what: str
) -> None:
    (tmp_path / name).write_bytes(data)
    with pytest.raises(FormatError, match=what):
        read(tmp_path / name)
