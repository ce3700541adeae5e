# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Forms of services that send a list of times and values for each quantity, and years in names."""

from __future__ import annotations

from json import dumps
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tree_sway.errors import FormatError
from tree_sway.files.motion import read_motion
from tree_sway.files.trees import open_scene
from tree_sway.files.wind import read_wind

BEGIN = 1_709_647_200  # 2024-03-05 14:00 UTC
STEP = 3600.0
FROM = 237.0
SPEEDS = [4.0 + 0.5 * row for row in range(10)]
GUSTS = [1.5 * speed for speed in SPEEDS]
DIRECTIONS = [FROM] * len(SPEEDS)
EPOCHS = [BEGIN + 3600 * row for row in range(len(SPEEDS))]
DATES = [f'2024-03-05T{14 + row}:00:00+00:00' for row in range(len(SPEEDS))]


def written(folder: Path, content: Any, name: str = 'a.json') -> Path:
    text = content if isinstance(content, str) else dumps(content)
    (folder / name).write_text(text, encoding='utf-8')
    return folder / name


def metrics(*instances: str) -> dict[str, Any]:
    """Answer of Prometheus to query_range."""
    result = [
        {
            'metric': {'__name__': name, 'instance': instance},
            'values': [[time, str(each)] for time, each in zip(EPOCHS, values, strict=True)],
        }
        for instance in instances
        for name, values in (('wind_speed_ms', SPEEDS), ('wind_direction_deg', DIRECTIONS))
    ]
    return {'status': 'success', 'data': {'resultType': 'matrix', 'result': result}}


def grid(name: str, unit: str, values: list[float]) -> dict[str, Any]:
    """Layer of the grid of api.weather.gov."""
    rows = zip(DATES, values, strict=True)
    return {
        name: {'uom': unit, 'values': [{'validTime': f'{t}/PT1H', 'value': v} for t, v in rows]}
    }


def telemetry(values: list[float]) -> list[dict[str, Any]]:
    """Values of ThingsBoard, the newest first."""
    rows = [{'ts': 1000 * t, 'value': str(v)} for t, v in zip(EPOCHS, values, strict=True)]
    return rows[::-1]


def trafikverket(date: str, speed: float) -> dict[str, Any]:
    wind = {'Height': 6, 'Speed': {'Value': speed}, 'Direction': {'Value': FROM}}
    return {'Sample': date, 'Measurepoint': {'Id': 1523}, 'Wind': [wind]}


ROWS = [
    ['11406', element, date, value]
    for date, speed in zip(DATES, SPEEDS, strict=True)
    for element, value in (('F', speed), ('D', FROM))
]
ICELAND = [
    {'station': 1, 'time': date, 'f': speed, 'fg': gust, 'fx': 1.1 * speed, 'd': FROM}
    for date, speed, gust in zip(DATES, SPEEDS, GUSTS, strict=True)
]


@pytest.mark.parametrize(
    'content',
    [
        metrics('mast'),
        {
            'properties': {
                **grid('windSpeed', 'wmoUnit:km_h-1', [3.6 * speed for speed in SPEEDS]),
                **grid('windDirection', 'wmoUnit:degree_(angle)', DIRECTIONS),
            }
        },
        {'windSpeed': telemetry(SPEEDS), 'windDirection': telemetry(DIRECTIONS)},
        {'RESPONSE': {'RESULT': [{'WeatherObservation': [*map(trafikverket, DATES, SPEEDS)]}]}},
        {'data': {'header': 'STATION,ELEMENT,DT,VAL', 'values': ROWS}},
        {
            'units': {'windspeed': 'kmh', 'winddirection': 'degree'},
            'data_1h': {
                'time': DATES,
                'windspeed': [3.6 * speed for speed in SPEEDS],
                'winddirection': DIRECTIONS,
            },
        },
        ICELAND,
    ],
    ids=[
        *('Prometheus', 'weather.gov', 'ThingsBoard', 'Trafikverket', 'CHMI', 'meteoblue'),
        'Iceland',
    ],
)
def test_series_are_read_at_their_times(tmp_path: Path, content: Any) -> None:
    record = read_wind(written(tmp_path, content), turbulence=False)
    np.testing.assert_allclose(np.hypot(*record.velocity[:, :2].T), SPEEDS, rtol=1e-6)
    blows_from = np.degrees(np.arctan2(*-record.velocity[:, :2].T)) % 360.0
    np.testing.assert_allclose(blows_from, FROM)
    assert record.epoch == BEGIN
    np.testing.assert_allclose(np.diff(record.time), STEP)
    if content is ICELAND:
        np.testing.assert_allclose(record.gust, GUSTS)


def test_metrics_of_two_instruments_are_not_mixed(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match='rows of several instruments: wind_speed_ms'):
        read_wind(written(tmp_path, metrics('mast', 'roof')))


def test_the_mean_and_the_words_of_rp5(tmp_path: Path) -> None:
    head = '"Local time in London";"T";"DD";"Ff";"ff10"\n'
    cells = '"{:02d}.03.2024 12:00";"9.0";"Wind blowing from the west-southwest";"{}";"{}"\n'
    days = zip(range(1, 11), SPEEDS, GUSTS, strict=True)
    record = read_wind(
        written(tmp_path, head + ''.join(cells.format(*each) for each in days), 'a.csv'),
        turbulence=False,
    )
    np.testing.assert_allclose(np.hypot(*record.velocity[:, :2].T), SPEEDS)
    assert record.duration == 9 * 86400.0
    assert any('is taken as the time, by its dates' in note for note in record.notes)


def test_hours_and_minutes_without_a_sign_are_asked(tmp_path: Path) -> None:
    hours = [
        {'time': str(100 * hour), 'windspeedKmph': '14', 'winddirDegree': '237'}
        for hour in range(12)
    ]
    content = {'weather': [{'date': '2024-03-05', 'hourly': hours}]}
    with pytest.raises(FormatError, match='goes by 100 up to 1100: hours and minutes, or seconds'):
        read_wind(written(tmp_path, content))


def test_edge_impulse_has_names_units_and_a_step(tmp_path: Path) -> None:
    x = [0.3 * math.sin(0.1 * row) for row in range(200)]
    sensors = [{'name': f'acc{axis}', 'units': 'm/s2'} for axis in 'XYZ']
    payload = {'interval_ms': 20, 'sensors': sensors, 'values': [[each, 0.0, 9.81] for each in x]}
    record = read_motion(written(tmp_path, {'signature': '0', 'payload': payload}))
    assert record.acceleration is not None
    np.testing.assert_allclose(record.acceleration[:, 0], x)
    np.testing.assert_allclose(np.diff(record.time), 0.02)


@pytest.mark.parametrize(
    ('head', 'tail'),
    [
        ('lat,lon,species,DBH_2014,DBH_2019,HT_2014,HT_2019', '20,30,10,12'),
        ('lat,lon,species,dbh_cm,height_m,LOCATION,Point', '30,12,12 Main Street,POINT (16 48)'),
    ],
)
def test_the_newest_year_counts_and_an_address_is_no_place(
    tmp_path: Path, head: str, tail: str
) -> None:
    text = f'{head}\n48.0,16.0,Tilia cordata,{tail}\n'
    if 'Point' in head:
        text = text.replace('lat,lon,', '').replace('48.0,16.0,', '')
    (tree,) = open_scene(written(tmp_path, text, 'a.csv'), warn=False).trees
    assert tree.tree.height * tree.scale == pytest.approx(12.0)
