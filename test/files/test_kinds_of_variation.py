# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What varies from file to file: languages, layouts, units told elsewhere, swapped columns."""

from __future__ import annotations

from json import dumps
from pathlib import Path

import numpy as np
import pytest

from tree_sway.errors import FormatError
from tree_sway.files.motion import read_motion
from tree_sway.files.scenes import inventory_of, inventory_table
from tree_sway.files.text_file import read_head
from tree_sway.files.trees import open_scene
from tree_sway.files.wind import read_wind

ROWS = range(8)
SPEED = [4.0 + 0.5 * row for row in ROWS]
STAMPS = [f'2024-03-05T14:{row:02d}:00Z' for row in ROWS]


def table(head: str, form: str, factor: float = 1.0) -> str:
    """Return a table of a wind from 225 degrees; a form has the cells {day}, {clock}, {v}."""
    cells = [
        {'day': '2024-03-05', 'clock': f'14:{row:02d}', 'v': f'{speed * factor:.3f}'}
        for row, speed in zip(ROWS, SPEED, strict=True)
    ]
    return '\n'.join([head, *(form.format(**each) for each in cells)]) + '\n'


def long(head: str, names: tuple[str, str], unit: str = '') -> str:
    lines = [
        f'{stamp},{name},{value}{unit}'
        for stamp, speed in zip(STAMPS, SPEED, strict=True)
        for name, value in zip(names, (speed, 225), strict=True)
    ]
    return '\n'.join([head, *lines]) + '\n'


def pairs(values: list[float]) -> list[list[object]]:
    return [list(each) for each in zip(STAMPS, values, strict=True)]


FROM = [225.0] * len(ROWS)
KMH = [3.6 * each for each in SPEED]
SENSOR_THINGS = [
    {
        'name': name,
        'unitOfMeasurement': {'name': unit, 'symbol': unit},
        'Observations': [
            {'phenomenonTime': time, 'result': value} for time, value in pairs(values)
        ],
    }
    for name, unit, values in (('wind speed', 'km/h', KMH), ('wind direction', 'deg', FROM))
]
GRAFANA = [
    {'target': name, 'datapoints': [[value, time] for time, value in pairs(values)]}
    for name, values in (('wind_speed', SPEED), ('wind_dir', FROM))
]
UNITS_FAR = {
    'meta': {'UNITS': {'wind_speed': 'km/h'}},
    'columns': ['time', 'wind_speed_set_1', 'direction'],
    'data': [[*row, 225] for row in pairs(KMH)],
}
PANDAS = {
    'columns': ['ws', 'wd'],
    'index': [1709647200000 + 60000 * row for row in ROWS],
    'data': [[speed, 225] for speed in SPEED],
}
WXT = ''.join(
    f'{1709647200 + 60 * row}\t0R1,Dn=223D,Dm=225D,Dx=227D,Sn=0.5M,Sm={speed}M,Sx=9.9M\n'
    f'{1709647200 + 60 * row}\t0R2,Ta=13.9C,Ua=28.5P,Pa=889.9H\n'
    for row, speed in zip(ROWS, SPEED, strict=True)
)
"""With the weather of the same transmitter between the winds."""
BY_TIME = {stamp: {'ws': speed, 'wd': 225} for stamp, speed in zip(STAMPS, SPEED, strict=True)}


@pytest.mark.parametrize(
    'text',
    [
        table('mast1_ts,mast1_ws_60m_mean,mast1_wd_58m_mean', '{day} {clock},{v},225'),
        table(
            'Date;Heure;Vitesse moyenne du vent (km/h);Direction du vent (°)',
            '{day};{clock};{v};225',
            3.6,
        ),
        table('Data;Ora;Velocità del vento [m/s];Direzione [°]', '{day};{clock};{v};225'),
        table('datum;tijd;windsnelheid (m/s);windrichting (graden)', '{day};{clock};{v};225'),
        table('Data;Godzina;Prędkość wiatru [m/s];Kierunek wiatru', '{day};{clock};{v};225'),
        table('Дата;Время;Скорость ветра (м/с);Направление ветра', '{day};{clock};{v};225'),
        table('Tarih,Rüzgar Hızı (m/s),Rüzgar Yönü (°)', '{day} {clock},{v},225'),
        table('Időpont;Szélsebesség (m/s);Szélirány (fok)', '{day} {clock};{v};225'),
        table('Year,m,d,Time,Wind speed,Wind direction', '2024,3,5,{clock},{v},225'),
        table('time,wind_speed (m/s),wind_to_direction (deg)', '{day} {clock},{v},45'),
        table(
            '# WSPD: wind speed (km/h)\n# WDIR: degrees\ndatetime,WSPD,WDIR',
            '{day} {clock},{v},225',
            3.6,
        ),
        table(
            'Date/Time (LST),Year,Month,Day,Time (LST),Wind Spd (m/s),Wind Dir (deg)',
            '{day} {clock},2024,03,05,{clock},{v},225',
        ),
        WXT,
        long('timestamp,variable,value', ('wind_speed', 'wind_direction')),
        long('DateTime,Parameter,Measurement', ('Wind speed (m/s)', 'Wind direction (deg)')),
        long('time,measurement_type,reading', ('windSpeed', 'windDirection')),
        dumps({'value': SENSOR_THINGS}),
        dumps(GRAFANA),
        dumps(UNITS_FAR),
        dumps(PANDAS),
        dumps(BY_TIME),
    ],
)
def test_a_wind_is_read_in_any_words_and_layout(tmp_path: Path, text: str) -> None:
    path = tmp_path / 'wind.txt'
    path.write_text(text, encoding='utf-8')
    record = read_wind(path, turbulence=False)
    assert np.diff(record.time) == pytest.approx(60.0)
    assert record.epoch == pytest.approx(1709647200.0)
    sides = np.array(SPEED) / np.sqrt(2.0)
    assert record.velocity[:, 0] == pytest.approx(sides, abs=1e-3)
    assert record.velocity[:, 1] == pytest.approx(sides, abs=1e-3)


CHANNELS = [
    {
        'datetime': stamp,
        'channels': [
            {'id': 1, 'name': name, 'value': value}
            for name, value in (('Rain', 0.0), ('WS', speed), ('WD', 225.0))
        ],
    }
    for stamp, speed in zip(STAMPS, SPEED, strict=True)
]
"""As the service of Israel's meteorologists answers."""


def test_channels_of_each_record_are_its_columns(tmp_path: Path) -> None:
    path = tmp_path / 'wind.json'
    path.write_text(dumps({'stationId': 178, 'data': CHANNELS}), encoding='utf-8')
    read = read_wind(path, turbulence=False)
    np.testing.assert_allclose(np.hypot(*read.velocity[:, :2].T), SPEED)


def test_one_of_several_tables_alike_is_not_read_alone(tmp_path: Path) -> None:
    rows = [
        {'time': stamp, 'speed [m/s]': speed, 'direction [deg]': 225}
        for stamp, speed in zip(STAMPS, SPEED, strict=True)
    ]
    path = tmp_path / 'wind.json'
    path.write_text(dumps({'days': [{'hour': rows[:5]}, {'hour': rows[5:]}]}))
    read = read_wind(path, turbulence=False)
    np.testing.assert_allclose(np.hypot(*read.velocity[:, :2].T), SPEED)
    assert '2 lists of following times are read as one' in read.notes
    path.write_text(dumps([{'hour': rows[1:]}, {'hour': rows[:-1]}]))
    with pytest.raises(FormatError, match='2 tables of the same columns'):
        read_wind(path)
    path.write_text(dumps({'north': {'rows': rows[:5]}, 'south': {'rows': rows[5:]}}))
    with pytest.raises(FormatError, match='2 tables of the same columns'):
        read_wind(path)


@pytest.mark.parametrize('name', ['wind_speed_std', 'apparent wind speed', 'wind chill'])
def test_other_words_are_no_speed_of_the_wind(tmp_path: Path, name: str) -> None:
    path = tmp_path / 'wind.csv'
    path.write_text(table(f'time,{name},wind_direction', '{day} {clock},{v},225'))
    with pytest.raises(FormatError, match='no column for the speed'):
        read_wind(path)


def test_nines_are_no_speed_where_no_other_is_nearly_as_large(tmp_path: Path) -> None:
    path = tmp_path / 'wind.csv'
    text = table('time,wind_speed (m/s),wind_direction', '{day} {clock},{v},225')
    path.write_text(text.replace('4.500', '99.9'))
    record = read_wind(path, turbulence=False)
    assert record.refused == 1
    assert record.first_refused == "line 3: speed is '99.9', taken as missing"


def test_rows_of_each_sensor_in_turn_are_joined(tmp_path: Path) -> None:
    lines = ['sensor,seconds_elapsed,x,y,z']
    for row in range(400):
        lines += [f'accelerometer,{row / 50:.3f},0.1,0.2,9.81']
        lines += [f'gyroscope,{row / 50:.3f},0.01,0.02,{row / 1000}']
    path = tmp_path / 'log.csv'
    path.write_text('\n'.join(lines) + '\n')
    record = read_motion(path)
    assert record.acceleration is not None
    assert record.rate is not None
    assert record.acceleration[7] == pytest.approx([0.1, 0.2, 9.81])
    assert record.rate[7] == pytest.approx([0.01, 0.02, 0.007])


@pytest.mark.parametrize(
    'text',
    [
        'No;Tür;Boy (m);Çap (cm);Enlem;Boylam\n1;{};{};48.2082;16.3738\n2;{};{};48.2082;16.3752\n',
        'Vrsta;Visina (m);Prsni promjer (cm);Zemljopisna širina;Zemljopisna dužina\n'
        '{};{};48.2082;16.3738\n{};{};48.2082;16.3752\n',
        'Είδος;Ύψος (m);Διάμετρος (cm);Γεωγραφικό πλάτος;Γεωγραφικό μήκος\n'
        '{};{};48.2082;16.3738\n{};{};48.2082;16.3752\n',
        "species;height_m;dbh_cm;latitude;longitude\n{};{};N48°12.492';E16°22.428'\n"
        "{};{};N48°12.492';E16°22.512'\n",
        'species;height_m;dbh_cm;easting;northing\n{};{};5340000;600000\n{};{};5340000;600103.8\n',
    ],
)
def test_an_inventory_is_read_in_any_words_and_places(tmp_path: Path, text: str) -> None:
    path = tmp_path / 'trees.csv'
    cells = ('Quercus robur', '12;30', 'Tilia cordata', '18;45')
    path.write_text(text.format(*cells), encoding='utf-8')
    scene = open_scene(path, warn=False)
    assert [each.species.key for each in scene.trees] == ['oak', 'lime']
    assert [each.tree.height * each.scale for each in scene.trees] == pytest.approx([12.0, 18.0])
    x = [each.x for each in scene.trees]
    y = [each.y for each in scene.trees]
    assert np.ptp(x) == pytest.approx(103.8, abs=0.1)
    assert np.ptp(y) == pytest.approx(0.0, abs=1e-6)


def test_a_point_within_a_record_is_a_place(tmp_path: Path) -> None:
    path = tmp_path / 'trees.json'
    records = [
        {'species': 'oak', 'height': 12, 'location': {'type': 'Point', 'coordinates': [x, 48.2]}}
        for x in (16.3738, 16.3752)
    ]
    path.write_text(dumps(records))
    scene = open_scene(path, warn=False)
    assert np.ptp([each.x for each in scene.trees]) == pytest.approx(103.8, abs=0.1)


def test_stems_of_vancouver_are_in_inches(tmp_path: Path) -> None:
    path = tmp_path / 'trees.csv'
    path.write_text(
        'CIVIC_NUMBER,COMMON_NAME,HEIGHT_RANGE_ID,DIAMETER,LATITUDE,LONGITUDE\n'
        '494,ENGLISH OAK,3,11.8,49.2178,-123.1161\n'
    )
    inventory = inventory_of(inventory_table(path, read_head(path)))
    assert inventory.diameter == pytest.approx([0.2997], abs=1e-4)


def test_swapped_heights_and_diameters_are_refused(tmp_path: Path) -> None:
    path = tmp_path / 'trees.csv'
    path.write_text('species,height_m,dbh_cm,x,y\noak,30,12,0,0\nlime,45,18,9,0\nash,60,20,3,3\n')
    with pytest.raises(FormatError, match='250 times as high as they are thick'):
        open_scene(path)
