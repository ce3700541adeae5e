# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Tables of wind as instruments and programs write them: what is read, and what is asked."""

from __future__ import annotations

import json

import numpy as np
import pytest

from tree_sway.errors import FormatError
from tree_sway.files.wind.wind_file import read_wind

SPEEDS = (4.6, 6.0, 5.2)


def rows(head: str, row: str, stamps: list[str]) -> str:
    return head + ''.join(
        row.format(t=stamp, s=speed) for stamp, speed in zip(stamps, SPEEDS, strict=True)
    )


MINUTES = ['2026-06-01 12:00', '2026-06-01 12:10', '2026-06-01 12:20']
SECONDS = ['12:00:00', '12:00:01', '12:00:02']
CLOCKS = ['12:00:00:000', '12:00:00:100', '12:00:00:200']
FORMS = {
    'lidar': rows(
        'HeaderSize=1\n****\n\nTimestamp (end of interval)\t40m Wind Speed (m/s)\t'
        '40m Wind Direction (°)\t60m Wind Speed (m/s)\t60m Wind Direction (°)\n',
        '{t}\t{s}\t240\t9.9\t90\n', MINUTES),
    'index without a name': rows(',wind_speed,wind_dir\n', '{t},{s},240\n', MINUTES),
    'german': rows('Zeit;Wind [m/s];Richtung [Grad]\n', '{t};{s};240\n', MINUTES),
    'milliseconds behind a colon': rows(
        'Date\tTime\tWS (m/s)\tWD (deg)\n', '2026-06-01\t{t}\t{s}\t240\n', CLOCKS),
    'tags': rows('', '2026-06-01 {t} S {s} D 240 U {s} V 0.1\n',
                 ['12:00:00.0', '12:00:00.1', '12:00:00.2']),
    'microseconds': rows(
        'timestamp,timestamp_sample,wind_speed,wind_dir\n', '{t}00,{t}00,{s},240\n',
        ['5000', '6000', '7000']),
    'gill behind a date': rows('', '2026-06-01T{t}Z,\x02Q,240,{s:06.2f},M,00,\x03\n', SECONDS),
    'gill behind a date, without its first sign': rows(
        '', '2026-06-01 {t} Q,240,{s:06.2f},M,00\n', SECONDS),
    'young behind a date': rows('', '2026-06-01 {t} {s:6.2f} 240.0 0.0 345.11 20.10\n', SECONDS),
    'vaisala behind a date': rows(
        '', '2026-06-01T{t}Z 0R1,Dn=200D,Dm=240D,Dx=260D,Sn=0.5M,Sm={s}M,Sx=9.9M\n', SECONDS),
    'masts': rows(
        'Exported Date:\t2026-06-02\nSite:\t2\n\nTimestamp\tCh1_Anem_60.00m_N_Avg_m/s\t'
        'Ch2_Anem_40.00m_N_Avg_m/s\tCh13_Vane_58.00m_N_Avg_deg\n',
        '{t}\t9.9\t{s}\t240\n', MINUTES),
    'heights behind the unit': rows(
        'Time and Date,Wind Direction (deg) at 80m,Horizontal Wind Speed (m/s) at 80m,'
        'Wind Direction (deg) at 39m,Horizontal Wind Speed (m/s) at 39m\n',
        '{t},90,9.9,240,{s}\n', MINUTES),
    'a table above': rows(
        'latitude,longitude,elevation\n52.5,13.4,38.0\n\n'
        'time,wind_speed_100m (m/s),wind_speed_10m (m/s),wind_direction_10m (°)\n',
        '{t},9.9,{s},240\n', MINUTES),
    'a unit on a second line': rows(
        'TIMESTAMP,RECORD,WS_ms_S_WVT,WindDir_D1_WVT\nTS,RN,meters/second,Deg\n,,WVc,WVc\n',
        '{t},1,{s},240\n', MINUTES),
    'tempest': '{"type": "hub_status"}\n' + ''.join(
        json.dumps({'type': 'rapid_wind', 'ob': [1_780_000_000 + k, speed, 240]}) + '\n'
        for k, speed in enumerate(SPEEDS)),
    'signal k': ''.join(
        json.dumps({'updates': [{'timestamp': f'2026-06-01T{at}Z', 'values': [
            {'path': 'environment.wind.directionTrue', 'value': 4.1887902},
            {'path': 'environment.wind.speedTrue', 'value': speed},
            {'path': 'environment.wind.speedApparent', 'value': 9.9},
        ]}]}) + '\n' for at, speed in zip(SECONDS, SPEEDS, strict=True)),
}  # fmt: skip
SPANS = {'milliseconds behind a colon': 0.2, 'tags': 0.2, 'microseconds': 0.2} | dict.fromkeys(
    (
        *('gill behind a date', 'gill behind a date, without its first sign', 'tempest'),
        *('young behind a date', 'vaisala behind a date', 'signal k'),
    ),
    2.0,
)


@pytest.mark.parametrize('name', FORMS)
def test_a_form_is_read_at_its_times(tmp_path, name):
    path = tmp_path / 'wind.txt'
    path.write_text(FORMS[name], encoding='utf-8')
    options = {} if name.startswith(('tags', 'gill')) else {'turbulence': False}
    record = read_wind(path, **options)
    assert np.linalg.norm(record.velocity, axis=1) == pytest.approx(SPEEDS)
    toward = np.degrees(np.arctan2(record.velocity[:, 0], record.velocity[:, 1])) % 360.0
    assert toward == pytest.approx(60.0)
    assert np.ptp(record.time) == pytest.approx(SPANS.get(name, 1200.0))


def test_the_height_of_a_profiler_is_said(tmp_path):
    path = tmp_path / 'wind.sta'
    path.write_text(FORMS['lidar'], encoding='utf-8')
    assert 'the wind at 40 m; there is one at 60 m' in read_wind(path, turbulence=False).notes


def test_a_unit_that_was_chosen_elsewhere_is_asked(tmp_path):
    path = tmp_path / 'synop.csv'
    path.write_text(
        rows('Station,Date,ddd,ff,fx\n', '10000,{t},WSW,{s},9\n', MINUTES), encoding='utf-8'
    )
    with pytest.raises(FormatError, match='does not say the unit of the speed'):
        read_wind(path)
    record = read_wind(path, speed_unit='km/h', turbulence=False)
    assert np.linalg.norm(record.velocity, axis=1) == pytest.approx(np.array(SPEEDS) / 3.6)


def test_a_turbines_wind_is_named(tmp_path):
    path = tmp_path / 'steady.wnd'
    path.write_text('! wind\n0.0 4.6 0.0 0.0 0.0 0.2 0.0 0.0\n', encoding='utf-8')
    with pytest.raises(FormatError, match='OpenFAST'):
        read_wind(path)
