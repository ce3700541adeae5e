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


def timelines() -> str:
    hours = [
        {'startTime': f'2024-03-05T{n:02d}:00:00Z',
         'values': {'temperature': 5.1, 'windSpeed': speed, 'windDirection': 225}}
        for n, speed in enumerate(SPEEDS)
    ]  # fmt: skip
    return dumps({'data': {'timelines': [{'timestep': '1h', 'intervals': hours}]}})


def forecast() -> str:
    hours = [
        {'interval': {'startTime': f'2024-03-05T{n:02d}:00:00Z',
                      'endTime': f'2024-03-05T{n + 1:02d}:00:00Z'},
         'wind': {'direction': {'degrees': 225, 'cardinal': 'SOUTHWEST'},
                  'speed': {'value': speed / KMH, 'unit': 'KILOMETERS_PER_HOUR'}}}
        for n, speed in enumerate(SPEEDS)
    ]  # fmt: skip
    return dumps({'forecastHours': hours})


def coverage() -> str:
    times = [minute(n) for n in range(len(SPEEDS))]
    axes = {'x': {'values': [5.18]}, 'y': {'values': [52.1]}, 't': {'values': times}}
    values = {'ff': [speed / KNOT for speed in SPEEDS], 'dd': [225.0] * len(SPEEDS)}
    units = {'ff': 'kn', 'dd': 'degree'}
    return dumps({
        'type': 'Coverage', 'domain': {'type': 'Domain', 'axes': axes},
        'parameters': {
            name: {'type': 'Parameter', 'unit': {'symbol': {'value': unit}}}
            for name, unit in units.items()
        },
        'ranges': {
            name: {'axisNames': ['t'], 'shape': [len(each)], 'values': each}
            for name, each in values.items()
        },
    })  # fmt: skip


def series_of_a_station() -> str:
    parameters = {
        'FF': {'name': 'Windgeschwindigkeit', 'unit': 'km/h', 'data': [v / KMH for v in SPEEDS]},
        'DD': {'name': 'Windrichtung', 'unit': '°', 'data': [225.0] * len(SPEEDS)},
    }
    properties = {'parameters': parameters, 'station': '11035'}
    return dumps({
        'type': 'FeatureCollection', 'timestamps': [minute(n) for n in range(len(SPEEDS))],
        'features': [{'type': 'Feature', 'properties': properties}],
    })  # fmt: skip


def values_as_features(station: str = '06180') -> str:
    values = [
        {'observed': minute(n), 'parameterId': name, 'stationId': where, 'value': value}
        for n, speed in enumerate(SPEEDS)
        for name, value in (('wind_speed', speed), ('wind_dir', 225.0))
        for where in ('06180', station)
    ]
    features = [{'type': 'Feature', 'properties': each} for each in values]
    return dumps({'type': 'FeatureCollection', 'features': features})


def values_as_rows(second: str = '01048') -> str:
    rows = [
        f'{station},10_minutes,wind,{name},2024-03-05T14:{n:02d}:00+00:00,{value},3'
        for station in dict.fromkeys(['01048', second])
        for name in ('wind_speed', 'wind_direction')
        for n, value in enumerate(SPEEDS if name == 'wind_speed' else [225.0] * len(SPEEDS))
    ]
    head = 'station_id,resolution,dataset,parameter,date,value,quality'
    return '\n'.join([head, *rows]) + '\n'


def values_of_two_sensors() -> str:
    rows = [
        f'{minute(n)},{value},51.9,7.6,{unit},{sensor},{name}'
        for n, speed in enumerate(SPEEDS)
        for value, unit, sensor, name in (
            (speed / KMH, 'km/h', 'a1', 'Windgeschwindigkeit'),
            (225, '°', 'a2', 'Windrichtung'),
        )
    ]
    return '\n'.join(['createdAt,value,lat,lon,unit,sensorId,phenomenon', *rows]) + '\n'


def uplinks() -> str:
    return '\n'.join(
        dumps({'received_at': minute(n), 'uplink_message': {
            'f_port': 1, 'decoded_payload': {'windDirection': 225, 'windSpeed': speed}}})
        for n, speed in enumerate(SPEEDS)
    ) + '\n'  # fmt: skip


@pytest.mark.parametrize(
    ('text', 'step'),
    [
        (timelines(), 3600.0),
        (forecast(), 3600.0),
        (coverage(), 60.0),
        (series_of_a_station(), 60.0),
        (values_as_features(), 60.0),
        (values_as_rows(), 60.0),
        (values_of_two_sensors(), 60.0),
        (uplinks(), 60.0),
        (
            table(
                'FAWN Station,Period,2m T avg (F),10m Wind avg (mph),WDir avg (deg)',
                'Alachua,5 Mar 2024 {n}:00,70.1,{speed},225',
                MPH,
            ),
            3600.0,
        ),
        (
            table(
                'SiteID,21423,Site Timezone,-6,Data Timezone,0,Longitude,-98.1,Latitude,41.2\n'
                'Year,Month,Day,Hour,Minute,wind speed at 100m (m/s),'
                'wind direction at 100m (deg),air temperature at 100m (C)',
                '2012,1,1,{n},0,{speed},225,4.1',
            ),
            3600.0,
        ),
        (
            table(
                'BEGIN DATA\nDATE      TIME ,   BOII WS    ,   BOII WD    ',
                '03/15/2024 0{n}:00,     {speed},     225.00',
                MPH,
            )
            + 'END DATA\n',
            3600.0,
        ),
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
    ids='tomorrow google coverage geosphere dmi wetterdienst opensensemap uplinks fawn nrel '
    'agrimet airports archive typed-rows us ca si synop vqha80 arm biomet decentlab'.split(),
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
        (values_as_rows('01050'), '01050'),
        (values_as_features('06186'), '06186'),
    ],
)
def test_several_stations_are_not_one(tmp_path: Path, text: str, column: str) -> None:
    path = tmp_path / 'wind.json'
    path.write_text(text, encoding='utf-8')
    with pytest.raises(FormatError, match=f'rows of 2 instruments: .*{column}'):
        read_wind(path)


def test_units_that_were_chosen_in_weather_display_are_asked(tmp_path: Path) -> None:
    head = 'day month year hour minute temperature windspeed   gustspeed  direction'
    path = tmp_path / '32024lg.txt'
    path.write_text(table(head, ' 5  3 2024 14 {n:2d}   8.4   {speed}   9  225'))
    with pytest.raises(FormatError, match='Weather Display does not say the unit'):
        read_wind(path)


@pytest.mark.parametrize(
    ('head', 'row', 'gravity'),
    [
        ('Time,"X (100g)","Y (100g)","Z (100g)"', '{s},0,0,1', 9.80665),
        ('utime (s),X (G),Y (G),Z (G)', '{s},0,0,1', 9.80665),
        ('timestamp,UTC time,accuracy,x,y,z', '{ms},2024-03-05,unknown,0,0,-1', 9.80665),
        ('timestamp,UTC time,accuracy,x,y,z', '{ms},2024-03-05,3,0,0,9.8', 9.8),
    ],
    ids='endaq seconds iphone android'.split(),
)
def test_a_logger_has_its_unit_and_sign(
    tmp_path: Path, head: str, row: str, gravity: float
) -> None:
    path = tmp_path / 'log.csv'
    rows = (row.format(s=0.02 * n, ms=1709647200000 + 20 * n) for n in range(100))
    path.write_text('\n'.join([head, *rows]) + '\n')
    record = read_motion(path)
    assert record.acceleration is not None
    np.testing.assert_allclose(record.acceleration, [[0.0, 0.0, gravity]] * 100)
    np.testing.assert_allclose(np.diff(record.time), 0.02, atol=1e-9)


@pytest.mark.parametrize(
    ('columns', 'rows'),
    [
        ('X,Y', '7640000,680000,95 7641000,681000,120'),
        ('longitude,latitude', '-79.99,40.45,40 -79.98,40.46,52'),
    ],
    ids='size place'.split(),
)
def test_heights_that_no_trees_have_are_in_feet(tmp_path: Path, columns: str, rows: str) -> None:
    path = tmp_path / 'trees.csv'
    path.write_text('\n'.join([f'{columns},HEIGHT,SCIENTIFIC', *(
        f'{row},Quercus garryana' for row in rows.split()
    )]) + '\n')  # fmt: skip
    found = inventory_of(inventory_table(path, read_head(path)))
    heights = [0.3048 * float(row.rpartition(',')[2]) for row in rows.split()]
    np.testing.assert_allclose(found.height, heights)
    assert any('HEIGHT is taken as feet' in note for note in found.notes)


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
        (
            'codice,genere,specie,diam_tronc,h_m,LONG_X_4326,LAT_Y_4326',
            '5,Tilia,cordata,2{n},12,9.1{n},45.46',
            [0.2, 0.21, 0.22],
            1560.0,
        ),
        (
            'id,scientific_name,height,diameter_base_height,latitude,longitude',
            '{n},Acer rubrum,22,1{n},40.45,-79.9{n}',
            [0.254, 0.2794, 0.3048],
            1694.0,
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
        (read_motion, 'log.txt', b'# OpenSignals Text File Format\n0\t0\t32768\t40000\n' * 9,
         'counts of a log of OpenSignals'),
        (read_wind, 'array.dat', b'101,2024,65,1400,4.0,225,12.5\n' * 9, 'no header: the first'),
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
