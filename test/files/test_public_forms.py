# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Forms of public loggers, services, inventories and scans, with what a person reads there."""

from __future__ import annotations

from json import dumps
import math
from pathlib import Path

import numpy as np
import pytest

from tree_sway.errors import FormatError
from tree_sway.files.motion import read_motion
from tree_sway.files.trees import open_scene, open_tree
from tree_sway.files.wind import read_wind
from tree_sway.files.wind.sensor_line import checksum_of

ROWS = 12
SPEEDS = [4.0 + 0.5 * row for row in range(ROWS)]
SECONDS = [10.0 * row for row in range(ROWS)]
FROM = 225.0
GRAVITY = 9.80665


def written(folder: Path, text: str, name: str = 'table.csv') -> Path:
    (folder / name).write_text(text, encoding='utf-8')
    return folder / name


def wind_rows(form: str, factor: float = 1.0, comma: bool = False) -> str:
    """Rows of a form with the number, the clock, the speed and its triple."""
    lines = []
    for row, speed in enumerate(SPEEDS):
        cells = {
            'n': row,
            'n1': row + 1,
            'clock': f'14:{row:02d}',
            'speed': f'{speed * factor:.4f}',
            'more': f'{3.0 * speed * factor:.4f}',
        }
        line = form.format(**cells)
        lines.append(line.replace('.', ',') if comma else line)
    return '\n'.join(lines) + '\n'


DWD = (
    'surface observations;Parameter description;maximum_wind;mean_wind;mean_direction\n'
    '10384;Unit;km/h;km/h;Grad\n'
    'Datum;Uhrzeit (UTC);Windboen;Windgeschwindigkeit;Windrichtung\n'
)
HOBO = (
    'Line#,Date,"Wind Speed (S-WSB 1053:1-1), m/s, Mast",'
    '"Wind Direction (S-WDA 1054:2-1), *, Mast"\n'
)
CSIRO = ''.join(
    f'## COLUMN{n}.name {name}\n## COLUMN{n}.units {unit}\n'
    for n, (name, unit) in enumerate(
        [('Time', 'days since 2000-01-01 +8'), ('Speed', 'm s-1'), ('dir', 'Degrees N (FROM)')], 1
    )
)
MAST = 'Timestamp,Spd80mN [m/s],Spd40mN [m/s],Spd40mNMax [m/s],Dir78mS,Dir38mS\n'
STATION = '10-Minute Mean Wind Direction(Compass points),10-Minute Mean Speed(km/hour)'
TOA5 = (
    '"TOA5","38961","CR1000","38961","CR1000.Std.26","CPU:a.CR1","50269","OutCard"\n'
    '"TIMESTAMP","RECORD","wspd_avg","wdir_res","maxws"\n"TS","RN","ms-1","degrees","ms-1"\n'
    '"","","WVc","WVc","Max"\n'
)


@pytest.mark.parametrize(
    ('head', 'form', 'factor', 'comma'),
    [
        (DWD, '05/03/24;{clock};{more};{speed};225', 3.6, True),
        ('# Wind\n\nTIME, BEARING, SPEEDKNOTS\n', '{clock}, 225, {speed},', 1 / 0.514444, False),
        (TOA5, '"2024-03-05 {clock}:00",{n},{speed},225,{more}', 1.0, False),
        ('YYYY MM DD hh mm  WD WSPD  GST\n', '2024 03 05 14 {n:02d} 225 {speed} 99.0', 1.0, False),
        (HOBO, '{n},03/05/24 {clock}:00,{speed},225', 1.0, False),
        (
            f'Date time,Station,{STATION}\n',
            '2024-03-05 {clock},Pier,Southwest,{speed}',
            3.6,
            False,
        ),
        (CSIRO, '{n}.0 {speed} 225', 1.0, False),
        (
            '# time [s], speed [m/s], angle [rad]\ntime,speed,dir\n',
            '{n},{speed},3.926991',
            1.0,
            False,
        ),
        (MAST, '2016-01-09 {clock}:00,99,{speed},99,9,225', 1.0, False),
        ('time,speed(m/s),windSpeed(m/s),windDirection(°)\n', '{n},11,{speed},225', 1.0, False),
        (
            '#\tDate Time, GMT+01:00\tWind Speed, m/s (S/N: 9)\tWind Direction, ø (S/N: 7)\n',
            '{n}\t03/05/24 {clock}:00\t{speed}\t225',
            1.0,
            False,
        ),
        (
            'Date/Time,Wind Speed (m/s),Wind Direction (°)\n',
            '05 03 2018 {clock},{speed},225',
            1.0,
            False,
        ),
        (
            'Year,DOY,MST,Avg Wind Speed @ 3m [m/s],Avg Wind Direction @ 3m [deg from N]\n',
            '2018,291,14{n:02d},{speed},225',
            1.0,
            False,
        ),
        (
            '# STN,YYYYMMDD,DDVEC,   FG,  FXX\n',
            '  260,202403{n1:02d},  225, {speed}, 300',
            10.0,
            False,
        ),
        (
            'startDateTime,windSpeedMean,windDirMean\n',
            '2024-03-05T{clock}:00Z,{speed},225',
            1.0,
            False,
        ),
        (
            'x,y,UTC_DATE,WIND_SPEED,WIND_DIRECTION,LOCAL_DATE\n',
            '-75.7,45.4,2024-03-05T{clock}:00,{speed},22.5,2024-03-05 09:00',
            3.6,
            False,
        ),
        (
            ' 101 ! (c)\n 4 2024 03 05 00 00 00\n STID STNM TIME WSPD WDIR\n',
            ' NRMN 121 {n} {speed} 225',
            1.0,
            False,
        ),
        (
            ' YYYYMMDD HHMM WSPD[m/s] WDIR\n',
            ' 20240305 14{n:02d} {speed} 225',
            1.0,
            False,
        ),
        (
            'Date,Time (EST),Wind Dir,Wind Speed (kts)\n',
            '05-Mar-24,14{n:02d},225,{speed}',
            1 / 0.514444,
            False,
        ),
        (
            'FORMATTED DATE_TIME,Wind Speed (km/h),Direction - True (°T)\n',
            '2024-03-05 {clock},{speed},225',
            3.6,
            False,
        ),
        (
            '"TOACI1","Mast","T"\n"TMSTAMP","RECNBR","WS_ms_Avg","WindDir"\n',
            '"2024-03-05 {clock}:00",{n},{speed},SW (225°)',
            1.0,
            False,
        ),
        (
            ' Bondville\n 40.05 -88.37 213 m version 1\n',
            ' 2024 65 3 5 14 {n} 14.1 60.1' + ' -9999.9 0' * 17 + ' {speed} 0 225.0 0 998.0 0',
            1.0,
            False,
        ),
        (
            '# SNOTEL 727: Saddle Mtn., MT\nDate,Saddle Mtn. (727) Wind Direction Average (degree)'
            ',Saddle Mtn. (727) Wind Speed Average (mph)\n',
            '2024-03-05 {clock},225,{speed}',
            1 / 0.44704,
            False,
        ),
        (
            'FECHA     HORA  TEMP   HUM   PNM    DD    FF     NOMBRE\n'
            '         [HOA]  [°C]   [%]  [hPa]  [gr] [km/hr]\n',
            '05032024    {n:2d}  19.5   94  1004.3  225   {speed}     AZUL AERO',
            3.6,
            False,
        ),
        (
            'time,wind_speed_mph,wind_avg_km_h,wind_dir_deg\n',
            '2024-03-05 {clock}:00,,{speed},225',
            3.6,
            False,
        ),
        (
            'Datum;Windrichtung;WindgeschwindigkeitInMeterProSekunde\n',
            '05.03.2024 {clock};225;{speed}',
            1.0,
            False,
        ),
        ('', '{clock}:00 -> Wind speed: {speed} km/h, Wind direction: 225 deg', 3.6, False),
    ],
    ids=[
        'units above',
        'bearing',
        'mean behind',
        'old buoys',
        'star is degrees',
        'mean before',
        'head of columns',
        'radians in a comment',
        'mast',
        'not the speed of a drone',
        'tabs before commas',
        'spaces in dates',
        'day of the year',
        'days',
        'unit of the maker',
        'a place and no components',
        'minutes of the maker',
        'clock of digits',
        'months by name',
        'true degrees',
        'degrees behind a point',
        'flags between',
        'a place before names',
        'a name behind the row',
        'the column with values',
        'units as words',
        'pairs with units',
    ],
)
def test_winds_are_read_as_they_say(
    tmp_path: Path, head: str, form: str, factor: float, comma: bool
) -> None:
    path = written(tmp_path, head + wind_rows(form, factor, comma), 'wind.txt')
    record = read_wind(path, turbulence=False)
    speed = np.linalg.norm(record.velocity[:, :2], axis=1)
    np.testing.assert_allclose(speed, SPEEDS, rtol=1e-3)
    blows_from = np.degrees(np.arctan2(*-record.velocity[:, :2].T)) % 360.0
    np.testing.assert_allclose(blows_from, FROM, atol=0.1)
    assert not any('taken in m/s' in note for note in record.notes)


@pytest.mark.parametrize('name', ['station', 'Station Name', 'NUM_POSTE', 'fields.Reference'])
def test_stations_are_not_mixed(tmp_path: Path, name: str) -> None:
    rows = [f'{"AB"[row % 2]},2024-03-05 14:{row:02d},{row + 1},90' for row in range(ROWS)]
    path = written(tmp_path, f'{name},time,speed [m/s],direction\n' + '\n'.join(rows))
    with pytest.raises(FormatError, match='rows of 2 instruments: A, B'):
        read_wind(path)


def test_stations_behind_the_rows_are_not_mixed(tmp_path: Path) -> None:
    rows = ''.join(
        f'05032024    {hour:2d}  19.5   94  1004.3  225   13     {name}\n'
        for name in ('AZUL AERO', 'EZEIZA AERO')
        for hour in range(12)
    )
    path = written(tmp_path, f'FECHA HORA TEMP HUM PNM DD FF NOMBRE\n [HOA]\n{rows}', 'a.txt')
    with pytest.raises(FormatError, match='rows of 2 instruments: AZUL AERO, EZEIZA AERO'):
        read_wind(path)


def logged(body: str, begin: str, end: str) -> str:
    return f'{begin}{body}*{checksum_of(body)}{end}'


@pytest.mark.parametrize(
    ('before', 'begin', 'body', 'end'),
    [
        ('2024-03-05 14:{n:02d}:00 ', '\x02', '{speed:04.1f} 225 +12.3 00', '\x03'),
        ('met  2024-03-05T14:{n:02d}:00.00Z  ', '$', 'WIMWV,225.0,R,{speed:.1f},M,A', ''),
    ],
    ids=['Thies', 'a name before the time'],
)
def test_lines_of_instruments_have_the_times_before_them(
    tmp_path: Path, before: str, begin: str, body: str, end: str
) -> None:
    lines = [
        before.format(n=n) + logged(body.format(speed=speed), begin, end)
        for n, speed in enumerate(SPEEDS)
    ]
    record = read_wind(written(tmp_path, '\n'.join(lines), 'a.log'))
    assert (record.refused, record.epoch) == (0, 1709647200.0)
    np.testing.assert_allclose(record.time, 60.0 * np.arange(ROWS))
    np.testing.assert_allclose(np.hypot(*record.velocity[:, :2].T), SPEEDS)
    np.testing.assert_allclose(record.velocity[:, 0], record.velocity[:, 1])
    faulty = [line.replace('00*', '01*').replace(',A*', ',V*') for line in lines]
    with pytest.raises(FormatError, match='no good row of wind, 12 refused'):
        read_wind(written(tmp_path, '\n'.join(faulty), 'b.log'))


def test_knots_of_a_boat_are_asked(tmp_path: Path) -> None:
    text = 'TIMESTAMP,TWS,TWD\n' + wind_rows('2024-03-05T{clock}:00Z,{speed},225')
    with pytest.raises(FormatError, match='does not say the unit of the speed'):
        read_wind(written(tmp_path, text))
    record = read_wind(tmp_path / 'table.csv', speed_unit='kn', turbulence=False)
    assert np.linalg.norm(record.velocity[0]) == pytest.approx(4.0 * 0.514444, rel=1e-4)


@pytest.mark.parametrize(('degrees', 'is_said'), [('3.93', True), ('225.5', False), ('3', False)])
def test_directions_that_may_be_radians_are_said(
    tmp_path: Path, degrees: str, is_said: bool
) -> None:
    text = 'time,wind_speed,wind_direction\n' + wind_rows('{n},{speed},' + degrees)
    notes = ' '.join(read_wind(written(tmp_path, text)).notes)
    assert ('call it wind_direction [rad]' in notes) == is_said


def json_rows(form: str) -> str:
    return ','.join(
        form.replace('N', f'{row:02d}').replace('S', str(s)) for row, s in enumerate(SPEEDS)
    )


@pytest.mark.parametrize(
    ('head', 'form', 'tail'),
    [
        (
            '{"legend":["time","wind_speed_avg","wind_speed_max","wind_heading"],'
            '"units":["utc","m/s","m/s","degrees"],"data":[',
            '["2015-05-01T00:N:00.000Z",S,30,225]',
            ']}',
        ),
        (
            '{"channel":{"field1":"Wind Direction (North = 0 degrees)","field2":'
            '"Wind Speed (m/s)"},"feeds":[',
            '{"created_at":"2024-03-01T00:N:00Z","field1":"225","field2":"S"}',
            ']}',
        ),
        ('[', '{"fecha":"20N-01-01","dir":"22.5","velmedia":"S"}', ']'),
        (
            '[',
            '{"dateTime":"2024-03-05 14:N:00","wind":{"speed":S,"unit":"m/s","direction":225}}',
            ']',
        ),
        ('{"type":"obs_st","obs":[', '[17096472N,0,S,30,225]', ']}'),
    ],
    ids=['legend', 'titles', 'tens of degrees', 'unit of the group', 'many in one message'],
)
def test_json_with_names_beside_its_rows(tmp_path: Path, head: str, form: str, tail: str) -> None:
    rows = json_rows(form)
    if 'velmedia' in form:
        rows = rows.replace('.', ',')
    record = read_wind(written(tmp_path, head + rows + tail, 'a.json'), turbulence=False)
    assert not record.refused
    np.testing.assert_allclose(np.hypot(*record.velocity[:, :2].T).mean(), np.mean(SPEEDS))
    blows_from = np.degrees(np.arctan2(*-record.velocity[:, :2].T)) % 360.0
    np.testing.assert_allclose(blows_from, FROM, atol=0.1)


def test_the_first_of_columns_of_one_name_is_said(tmp_path: Path) -> None:
    text = 'time,u,v,u,v\n0,1,1,2,2\n1,1,1,2,2\n'
    assert 'of 2 columns u the first is read' in read_wind(written(tmp_path, text)).notes


@pytest.mark.parametrize(
    ('text', 'name', 'match'),
    [
        ('"TOB1","1","CR1000"\r\n\x00\xff', 'a.dat', 'a binary table of a Campbell logger'),
        ('53131 20190101 1610 4.4 C 0\n' * 3, 'a.txt', 'no header: the first line'),
        ('time,speed,direction\nnow,3,90\n', 'a.csv', 'no time in it'),
        ('date,clock,speed,dir\n' + '2024-03-05,14:00,3,9\n' * 9, 'a.csv', 'stands or goes back'),
        ('{"SiteRep": {"Wx": {}}}', 'a.json', 'DataPoint'),
        ('[{"_id":1789812000,"w-dir":244,"w-avg":12.1}]', 'a.json', 'of winds.mobi'),
        ('{"20261009060000":{"prefNumber":44,"wind":[3.5,0]}}', 'a.json', 'of AMeDAS'),
        ('netcdf a {\nvariables:\n}\n', 'a.txt', 'netCDF file as text'),
        ('Mast 1\n 50.0 8.0 10.0\n 12 1.00 0\n', 'a.tab', 'a table of frequencies'),
        ('M:x =   335 y =   218 z =     5 t =  2203\n' * 3, 'a.csv', 'axes are left-handed'),
    ],
)
def test_what_is_no_table_of_wind_is_told(
    tmp_path: Path, text: str, name: str, match: str
) -> None:
    (tmp_path / name).write_bytes(text.encode('latin-1'))
    with pytest.raises(FormatError, match=match):
        read_wind(tmp_path / name)


def test_the_unit_that_was_asked_for_is_asked_and_flags_are_no_speed(tmp_path: Path) -> None:
    form = '{"t":"2024-03-05 14:N","s":"S","d":"225.00","dr":"SW","g":"30","f":"0,0"}'
    path = written(tmp_path, f'{{"data":[{json_rows(form)}]}}', 'a.json')
    with pytest.raises(FormatError, match='does not say the unit of the speed'):
        read_wind(path)
    record = read_wind(path, turbulence=False, speed_unit='m/s')
    np.testing.assert_allclose(np.hypot(*record.velocity[:, :2].T), SPEEDS)


def test_reports_of_airports_have_the_date_before_them(tmp_path: Path) -> None:
    rows = [f'20240305{h}20 METAR EDDF 05{h}20Z 24010KT 9999 NOSIG=' for h in (14, 15, 16)]
    record = read_wind(written(tmp_path, '\n'.join(rows), 'a.txt'), turbulence=False)
    assert record.epoch == 1709648400.0


@pytest.mark.parametrize('years', [(1998, 1986), (1999, 2003)])
def test_months_of_a_typical_year_are_of_one_year(tmp_path: Path, years: tuple[int, int]) -> None:
    rows = [f'01/31/{years[0]},{hour}:00,5,225' for hour in range(12, 24)]
    rows += [f'02/01/{years[1]},{hour}:00,5,225' for hour in range(12)]
    rows += [f'03/01/{years[0] + 2},{hour}:00,5,225' for hour in range(12)]
    path = written(tmp_path, 'Date (MM/DD/YYYY),Time,Wspd (m/s),Wdir\n' + '\n'.join(rows))
    record = read_wind(path, turbulence=False)
    assert not record.refused
    assert record.duration == pytest.approx(86400.0 * 29 - 3600.0)
    assert f'months of several years are taken as those of {years[0]}' in record.notes


def motion_rows(form: str) -> str:
    lines = []
    for row in range(200):
        x = 0.3 * math.sin(0.1 * row)
        time = {'s': 0.02 * row, 'cs': 2 * row, 'ms': 20 * row, 'ns': 20_000_000 * row}
        lines.append(form.format(**time, x=x, z=GRAVITY))
    return '\n'.join(lines) + '\n'


GROUP = 'Data Set 1:'
LABVIEW = (
    'LabVIEW Measurement\nSeparator\tTab\n***End_of_Header***\n\nChannels\t3\n'
    'Delta_X\t0.020000\t0.020000\t0.020000\n***End_of_Header***\n'
)
AXES = ','.join(f'{GROUP}{axis}-axis acceleration(m/s²)' for axis in 'XYZ')


@pytest.mark.parametrize(
    ('head', 'form'),
    [
        (f'{GROUP}Time(s),{AXES}\n', '{s:.3f},{x:.5f},0,{z}'),
        ('relative_time,AccX,AccY,AccZ\n', '{ms},{x:.5f},0,{z}'),
        ('a log\n\ntime,X_value,Y_value,Z_value\n', '{s:.3f},{x:.5f},0,{z}'),
        (
            'Arrival_Time,Creation_Time,x,y,z\n',
            '14246966{ms:05d},1424696631{ns:09d},{x:.5f},0,{z}',
        ),
        ('Time (s),ax (m/s^2),ay (m/s^2),az (m/s^2)\nNaN,NaN,NaN,NaN\n', '{s},{x:.5f},0,{z}'),
        (
            '#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],'
            'a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n',
            '{ns},0,0,0,{x:.5f},0,{z}',
        ),
        ('#time,accel_x,accel_y,accel_z\n', '{s},{x:.5f},0,9806.65'),
        ('stamp,accX,accY,accZ\n', '{ms}000,{x:.5f},0,{z}'),
        ('HH:MM:SS.mmm,RawData,AccX[mg],AccY[mg],AccZ[mg]\n', '12:00:0{s:.3f},0,{x:.5f},0,1000'),
        ('Time [10ms],AccX [mg],AccY [mg],AccZ [mg]\n', '{cs},{x:.5f},0,1000'),
        ('TimeStartup,Accel[X],Accel[Y],Accel[Z]\n', '{ns},{x:.5f},0,{z}'),
        (
            'cts,date,Accel (z) [m/s2],Accel (x) [m/s2],Accel (y) [m/s2]\n',
            '{ms},2024-03-05T14:00:0{s:.3f}Z,{z},{x:.5f},0',
        ),
        (
            'Tempo (s),Accelerazione x (m/s^2),Accelerazione y (m/s^2),Accelerazione z (m/s^2)\n',
            '{s:.3f},{x:.5f},0,{z}',
        ),
        ('时间,加速度X(g),加速度Y(g),加速度Z(g)\n', '{s:.3f},{x:.5f},0,1'),
        ('Time,Acceleration_1,Acceleration_2,Acceleration_3\n', '{s:.2f} sec,{x:.5f},0,{z}'),
        (f'{LABVIEW}X_Value\tAcc_X\tAcc_Y\tAcc_Z\tComment\n', '{s:.3f}\t{x:.5f}\t0\t{z}'),
        (f'{LABVIEW}X_Value\tAcc_X\tAcc_Y\tAcc_Z\tComment\n', '\t{x:.5f}\t0\t{z}'),
        ('', '12:00:0{s:.3f} -> ax: {x:.5f} | ay: 0.0 | az: {z}'),
        (
            '',
            '1709647200,{ns},imu,0,0,0,1'
            + ',0' * 9
            + ',0,0,0'
            + ',0' * 9
            + ',{x:.5f},0,{z}'
            + ',0' * 9,
        ),
    ],
    ids=[
        'groups',
        'milliseconds',
        'values',
        'two clocks',
        'first row',
        'frames in the name',
        'millimetres',
        'times by their step',
        'clock as a name',
        'tens of milliseconds',
        'axes in brackets and nanoseconds',
        'axes in brackets and units',
        'Italian',
        'Chinese',
        'durations',
        'LabVIEW',
        'LabVIEW without times',
        'pairs',
        'a message of ROS',
    ],
)
def test_motions_are_read_as_they_are(tmp_path: Path, head: str, form: str) -> None:
    rows = motion_rows(form)
    if 'Creation' in head or not head:
        rows = '\n'.join(rows.splitlines()[:50])
    record = read_motion(written(tmp_path, head + rows, 'motion.csv'))
    assert np.nanmedian(np.diff(record.time)) == pytest.approx(0.02)
    assert record.acceleration is not None
    assert np.nanmedian(record.acceleration, axis=0)[2] == pytest.approx(GRAVITY, abs=1e-4)


@pytest.mark.parametrize(
    ('text', 'match'),
    [
        ('GYROFLOW IMU LOG\nid,a\nt,gx,gy,gz,ax,ay,az\n0,0,0,0,0,0,98\n', 'which is no m/s'),
        ('sensor,timestamp,x,y,z\nACC,0,0,0,9.8\nGYRO,1,0,0,0\n', 'rows of 2 instruments'),
    ],
)
def test_what_is_no_motion_is_told(tmp_path: Path, text: str, match: str) -> None:
    with pytest.raises(FormatError, match=match):
        read_motion(written(tmp_path, text))


@pytest.mark.parametrize('form', ['{{"data": [{}]}}', '{}'])
def test_messages_with_several_samples_are_spread_over_their_time(
    tmp_path: Path, form: str
) -> None:
    samples = [{'x': 1e-3 * number, 'y': 0, 'z': 9.8} for number in range(200)]
    messages = [
        {'acc': {'Timestamp': 599025762 + 20 * first, 'ArrayAcc': samples[first : first + 4]}}
        for first in range(0, 200, 4)
    ]
    between = ',' if 'data' in form else '\n'
    record = read_motion(
        written(tmp_path, form.format(between.join(map(dumps, messages))), 'a.json')
    )
    assert record.acceleration is not None
    np.testing.assert_allclose(record.acceleration[:, 0], 1e-3 * np.arange(200), atol=1e-12)
    np.testing.assert_allclose(np.diff(record.time), 0.02, atol=1e-6)


def scene_of(folder: Path, text: str) -> tuple[list[tuple[str, float]], float, str]:
    """Species and height of each tree, the widest distance, and the notes."""
    scene = open_scene(written(folder, text), warn=False)
    place = np.array([(each.x, each.y) for each in scene.trees])
    trees = [(each.species.key, round(each.tree.height * each.scale, 2)) for each in scene.trees]
    return trees, float(np.hypot(*np.ptp(place, axis=0))), ' '.join(scene.notes)


@pytest.mark.parametrize(
    ('head', 'rows', 'wide'),
    [
        (
            'lat,lon,species,dbh,height',
            ['48.137,11.575,Tilia,30,12', '0,0,Tilia,28,11', '48.137,11.576,Tilia,30,12'],
            74.0,
        ),
        (
            'x,y,species,dbh,height',
            ['612512.3,5345678,Tilia,30,12', '0,0,Tilia,28,11', '612522.3,5345678,Tilia,30,12'],
            10.0,
        ),
    ],
)
def test_a_tree_without_a_fix_does_not_stand_at_zero(
    tmp_path: Path, head: str, rows: list[str], wide: float
) -> None:
    trees, width, notes = scene_of(tmp_path, '\n'.join([head, *rows, '']))
    assert trees == [('lime', 12.0)] * 2
    assert width == pytest.approx(wide, abs=0.5)
    assert '1 no place; line 3:' in notes
    assert "is '0'" in notes


def test_trees_of_a_plot_stand_by_their_field_coordinates(tmp_path: Path) -> None:
    rows = [f'5.27,-52.92,{10 * n},{20 * n},Quercus,30,TRUE' for n in (1, 2, 3)]
    rows.append('5.27,-52.92,70,70,Quercus,30,FALSE')
    head = 'Lat,Lon,Xfield,Yfield,Genus,dbh_cm,CodeAlive'
    trees, width, notes = scene_of(tmp_path, '\n'.join([head, *rows, '']))
    assert len(trees) == 3
    assert width == pytest.approx(math.hypot(20.0, 40.0))
    assert 'one latitude and longitude' in notes


@pytest.mark.parametrize(
    ('head', 'dead'),
    [
        ('LAT,LON,STATUSCD,SPCD,DBH_CM,HEIGHT_M', '45.0001,-93,2,833,40,15'),
        ('x,y,dead,species,dbh_cm,Htot', '9,0,TRUE,Tilia,40,15'),
        ('Field_X,Field_Y,Status,Species,dbh_cm,TH', '9,0,D,Tilia,40,15'),
    ],
)
def test_the_dead_are_told_by_codes(tmp_path: Path, head: str, dead: str) -> None:
    alive = dead.replace('0001', '0002').replace(',2,8', ',1,8')
    alive = alive.replace('TRUE', 'FALSE').replace('D,', 'L,').replace('9,0', '0,0')
    trees, _, notes = scene_of(tmp_path, f'{head}\n{alive}\n{dead}\n')
    assert [height for _, height in trees] == [15.0]
    assert '1 row is left out: 1 dead or gone; line 3' in notes


def test_a_name_that_is_another_tree_elsewhere_is_said(tmp_path: Path) -> None:
    notes = scene_of(tmp_path, 'x,y,species,dbh_cm\n0,0,Mountain Ash,60\n')[2]
    assert 'in Australia it is Eucalyptus regnans' in notes


def test_digitised_trees_with_vertices_left_out(tmp_path: Path) -> None:
    head = (
        'CODE:\tFORM-A\nCLASSES:\nSYMBOL\tSCALE\n$\t0\nP\t1\nB\t2\nS\t3\nMTG:\n'
        'ENTITY-CODE\t\t\tXX\tYY\tZZ\tTopDia\n'
    )
    body = (
        '/P1/B1\t\t\t0\t0\t0\t90\n# pommier à ébourgeonner\n^/S1<<S9\t\t\t0\t0\t200\t80\n'
        '^<S10\t\t\t0\t0\t300\t60\n^+B2\n\t/S1\t\t50\t0\t350\t20\n^<S11\t\t\t0\t0\t400\t30\n'
    )
    (tmp_path / 'a.mtg').write_bytes((head + body).encode('cp1252'))
    tree = open_tree(tmp_path / 'a.mtg', warn=False).tree
    assert tree.height == pytest.approx(4.0)
    assert tree.n_segments == 4


def test_exchanged_degrees_are_told_with_their_cells(tmp_path: Path) -> None:
    text = 'latitude,longitude,species,dbh\n-118.25,34.05,Tilia,30\n'
    with pytest.raises(FormatError, match=r"latitude is '-118.25' and longitude is '34.05'"):
        open_scene(written(tmp_path, text), warn=False)


@pytest.mark.parametrize('numbers', [('3.456.789,12', '3.456.799,12'), ('3.456.789', '3.456.799')])
def test_points_between_thousands(tmp_path: Path, numbers: tuple[str, str]) -> None:
    rows = ''.join(f'Linde;30,5;12,5;{each};5.345.678,90\n' for each in numbers)
    trees, width, _ = scene_of(tmp_path, f'Baumart;BHD (cm);Höhe (m);Rechtswert;Hochwert\n{rows}')
    assert trees == [('lime', 12.5)] * 2
    assert width == pytest.approx(10.0)


def test_nines_are_missing_values(tmp_path: Path) -> None:
    rows = ['0,0,Tilia,30,12', '9,0,Tilia,999,99', '0,9,Tilia,31,13', '9,9,Tilia,99,14', '']
    trees, _, notes = scene_of(tmp_path, '\n'.join(['x,y,species,dbh_cm,height_m', *rows]))
    assert [height for _, height in trees] == [12.0, 13.0, 14.0]  # a stem of 99 cm is one
    assert "1 cells of dbh_cm such as '999' are taken as missing" in notes
    assert "1 cells of height_m such as '99' are taken as missing" in notes


def test_codes_of_two_letters_each(tmp_path: Path) -> None:
    rows = 'x,y,species,dbh_cm,height_m\n0,0,PIAB,30,12\n9,0,FASY,30,12\n0,9,ACSA,30,12\n'
    trees, _, notes = scene_of(tmp_path, rows)
    assert [key for key, _ in trees] == ['spruce', 'beech', 'maple']
    assert 'species is taken as letters of genus and epithet' in notes


def test_stems_at_a_size_and_abbreviations(tmp_path: Path) -> None:
    text = 'x,y,Species,Stem Dia. (mm),Height (m)\n0,0,Tilia,3 @ 150,12\n'
    _, _, notes = scene_of(tmp_path, text)
    assert 'cannot be read' not in notes
    assert scene_of(tmp_path, 'x;y;Art;StU (cm);Höhe ca.\n0;0;Linde;125;14\n')[0] == [
        ('lime', 14.0)
    ]
    cyrillic = 'Порода;Диаметр (см);Высота (м);Широта;Долгота\nЛипа;32;14;55,75;37,61\n'
    assert scene_of(tmp_path, cyrillic)[0] == [('broadleaf', 14.0)]


def test_cylinders_above_other_tables(tmp_path: Path) -> None:
    rows = [
        f'0.0{9 - row} 0.5 0 0 {0.5 * row} 0 0 1 {row} {row + 2} 1 0 {row + 1} 0'
        for row in range(5)
    ]
    text = '\n'.join(
        ['# Cylinder data', *rows, '# Branch data', '0 0 491.8 3.4 0 1.3', '# Tree', '']
    )
    tree = open_tree(written(tmp_path, text, 'qsm.txt'), warn=False).tree
    assert tree.height == pytest.approx(2.5)


@pytest.mark.parametrize(
    'form',
    [
        '1,1,0,0,0,.1,-1\n2,1,0,0,4,.08,1\n',
        'id type x y z radius parent\n1 1 0 0 0 .1 -1\n2 1 0 0 4 .08 1\n',
        '1 1 0 0 0 .1 -1 0 1 0 10000 0\n2 1 0 0 4 .08 1 0 1 0 10000 0\n',
    ],
    ids=['commas', 'names', 'further columns'],
)
def test_forms_of_swc(tmp_path: Path, form: str) -> None:
    for name in ('a.swc', 'a.txt'):
        assert open_tree(written(tmp_path, form, name), warn=False).tree.height == 4.0


@pytest.mark.parametrize(
    ('name', 'text', 'match'),
    [
        ('a.lpy', 'Axiom: A(0.1)\n', 'rules that grow a tree'),
        ('a.rds', 'X\n', 'a file of R, not a tree'),
        ('a.geom', 'Shape { Id 1 }\n', 'a mesh for drawing'),
        ('a.csv', 'node,x [cm],diameter [cm]\n1,0,20\n', 'segment, parent, x0, y0, z0, x1'),
    ],
)
def test_other_files_are_named(tmp_path: Path, name: str, text: str, match: str) -> None:
    with pytest.raises(FormatError, match=match):
        open_tree(written(tmp_path, text, name))


TREES = [('Quercus robur', 40.0, 14.0), ('Fagus sylvatica', 52.0, 20.0)]


def lines_of_json(form: str) -> str:
    return ''.join(
        form % (13.4 + 1e-4 * row, name, stem, height) + '\n'
        for row, (name, stem, height) in enumerate(TREES)
    )


@pytest.mark.parametrize(
    'text',
    [
        lines_of_json('{"lat": 52.5, "lon": %s, "species": "%s", "dbh_cm": %s, "height": %s}'),
        lines_of_json(
            '{"type": "Feature", "geometry": {"type": "Point", "coordinates": [%s, 52.5]}, '
            '"properties": {"species": "%s", "dbh_cm": %s, "height": %s}}'
        ),
        'x,y,d,h,n,s\n0,0,40,14,1,QURO\n6.8,0,52,20,2,FASY\n',
        'plot,sps,coordinates_x_metres,coordinates_y_metres,dbh_centimetres,height_metres\n'
        'a,QURO,0,0,40,14\na,FASY,6.8,0,52,20\n',
    ],
    ids=['records', 'features', 'letters', 'units as words'],
)
def test_inventories_are_read_as_they_are(tmp_path: Path, text: str) -> None:
    trees, width, _ = scene_of(tmp_path, text)
    assert trees == [('oak', 14.0), ('beech', 20.0)]
    assert width == pytest.approx(6.8, abs=0.1)


def test_a_beginning_of_most_names_does_not_hide_a_known_one(tmp_path: Path) -> None:
    header = 'time,avg_wind_speed,max_wind_speed,wind_direction,max_temp,max_hum,max_pres,battery'
    rows = ''.join(f'2024-03-05 14:{row:02d},3,9,270,8,60,990,12\n' for row in range(20))
    record = read_wind(written(tmp_path, f'{header}\n{rows}'), turbulence=False)
    np.testing.assert_allclose(record.velocity[:, 0], 3.0)


def test_a_remark_above_a_header_is_no_line_of_a_sketch(tmp_path: Path) -> None:
    rows = ''.join(f'2024-03-05 14:{row:02d},3,270\n' for row in range(20))
    text = f'# Mast position X: 3.5, Y: 2.0, Z: 10.0 m\ntime,speed [m/s],direction\n{rows}'
    record = read_wind(written(tmp_path, text), turbulence=False)
    np.testing.assert_allclose(record.velocity[:, 0], 3.0)
