# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Laws by which files of makers that nobody knew are read or refused."""

from __future__ import annotations

from datetime import datetime, UTC
from json import dumps
from pathlib import Path
from typing import Any
from zipfile import ZipFile

import numpy as np
import pytest

from tree_sway.errors import FormatError, ParameterError
from tree_sway.files.kinds import kind_of
from tree_sway.files.layouts.known import table_of
from tree_sway.files.motion import read_motion, read_strain
from tree_sway.files.scenes import Inventory, inventory_of, inventory_table
from tree_sway.files.text_file import read_head
from tree_sway.files.trees import open_scene, open_tree
from tree_sway.files.wind import read_csv_sway, read_wind
from tree_sway.files.wind.sensor_line import checksum_of

BEGIN = 1_709_647_199  # 2024-03-05 13:59:59 UTC


def written(folder: Path, text: str, name: str = 'table.csv') -> Path:
    (folder / name).write_text(text, encoding='utf-8')
    return folder / name


def inventory(folder: Path, text: str, name: str = 'table.csv') -> Inventory:
    path = written(folder, text, name)
    return inventory_of(inventory_table(path, read_head(path)))


@pytest.mark.parametrize('other', ['mastTyp', 'LampenNr', 'Lampadaire', 'pole_height'])
def test_heights_of_other_things_are_no_trees(tmp_path: Path, other: str) -> None:
    with pytest.raises(FormatError, match='no column for the species among'):
        inventory(tmp_path, f'x,y,height,{other}\n0,0,8,A\n9,0,6,B\n')
    assert inventory(tmp_path, 'x,y,height,street\n0,0,8,A\n9,0,6,B\n').height.tolist() == [8, 6]


def test_what_stands_between_the_trees_of_a_map_is_left_out(tmp_path: Path) -> None:
    tags = [
        {'natural': 'tree', 'height': '7'},
        {'amenity': 'fountain', 'height': '3'},
        {'natural': 'tree', 'height': '9'},
    ]
    nodes = [{'lat': 52.5, 'lon': 13.4 + 1e-3 * n, 'tags': each} for n, each in enumerate(tags)]
    assert inventory(tmp_path, dumps({'elements': nodes}), 'a.json').height.tolist() == [7, 9]


def test_several_stems_in_a_cell_are_said(tmp_path: Path) -> None:
    found = inventory(tmp_path, 'x;y;height;girth [cm]\n0;0;9;30+40\n5;0;8;50\n')
    np.testing.assert_allclose(found.diameter, 0.5 / np.pi)
    assert '1 cells of girth [cm] have several stems: one of their section' in found.notes


@pytest.mark.parametrize(
    ('text', 'east', 'north'),
    [
        ('azi;dist;bhd;hoehe\ngon;cm;mm;dm\n100;500;300;150\n200;800;310;160\n', [5, 0], [0, -8]),
        ('species,Azimuth,Distance [m],height\nash,0,4,15\nash,270,6,16\n', [0, -6], [4, 0]),
        (
            'azimuth,dist,dbh [in],height [ft]\n90,10,12,50\n180,20,14,60\n',
            [3.048, 0],
            [0, -6.096],
        ),
    ],
    ids=['gon', 'degrees', 'feet'],
)
def test_trees_stand_by_azimuth_and_distance(
    tmp_path: Path, text: str, east: list[float], north: list[float]
) -> None:
    found = inventory(tmp_path, text)
    np.testing.assert_allclose(found.x, east, atol=1e-9)
    np.testing.assert_allclose(found.y, north, atol=1e-9)
    assert any('placed from the centre of the plot' in note for note in found.notes)


def test_azimuths_of_several_plots_have_no_common_centre(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match='about several centres, by subplot'):
        inventory(tmp_path, 'subplot,azimuth,dist,height\n1,90,4,15\n2,90,4,16\n')


def test_names_of_a_species_in_one_cell(tmp_path: Path) -> None:
    rows = 'x;y;S/P;Common name | Latin name;vyska;torzsatmero\n'
    rows += '0;0;S;letter ash | Fraxinus excelsior;9 m;30 cm\n5;0;P;x | Picea abies;8 m;25 cm\n'
    found = inventory(tmp_path, rows.replace('vyska', 'height'))
    assert [found.wood[each].key for each in found.species] == ['ash', 'spruce']
    np.testing.assert_allclose(found.diameter, [0.30, 0.25])


CLOCKS = {
    'ZDA': 'GPZDA,{time:06d}.00,05,03,2024,00,00',
    'RMC': 'GPRMC,{time:06d}.00,A,5231.12,N,01324.30,E,0.0,84.4,050324,3.1,E',
}


def boat(clock: str, per_clock: int) -> str:
    """Sentences of a clock, each before some of wind; one clock in five seconds is missing."""
    lines = []
    for second, time in enumerate([135959, 140000, 140001, 140003]):
        wind = [f'WIMWD,225.0,T,,M,,N,{4.0 + second:.1f},M'] * per_clock
        lines += [CLOCKS[clock].format(time=time), 'HEHDT,44.2,T', *wind]
    return ''.join(f'${each}*{checksum_of(each)}\n' for each in lines)


@pytest.mark.parametrize('clock', CLOCKS)
def test_sentences_have_the_time_of_the_clock_before_them(tmp_path: Path, clock: str) -> None:
    record = read_wind(written(tmp_path, boat(clock, 1), 'a.nmea'))
    assert (record.epoch, record.time.tolist()) == (BEGIN, [0, 1, 2, 4])
    several = read_wind(written(tmp_path, boat(clock, 2), 'b.nmea'), rate=2.0)
    assert (several.epoch, len(several.time), several.period) == (None, 8, 0.5)


def test_long_tables_with_a_date_and_a_time_apart(tmp_path: Path) -> None:
    rows = 'Date,Time,Sensor name,Value,Unit\n' + ''.join(
        f'{day},{time},WdSpd,{speed},mph\n{day},{time},WdDir,270,deg\n'
        for day, time, speed in (('05.03.2024', '23:59:00', 10), ('06.03.2024', '00:00:00', 20))
    )
    record = read_wind(written(tmp_path, rows), turbulence=False)
    np.testing.assert_allclose(record.velocity[:, 0], [4.4704, 8.9408])
    assert record.time.tolist() == [0.0, 60.0]


@pytest.mark.parametrize(
    ('form', 'step', 'unit'),
    [
        (' 1  {h:.6f}  3 98 121 279.4 0.005 {speed:.3f} 0.0 99321.4 291.2{zeros}', 36.0, 1.0),
        ('2024-03-05 14:00:{n:02d}.25: WIND {{direction : -90.0, speed : {speed}, z : 0}}', 1, 1),
        ('03/05/2024,14:{n:02d}:00,WdSpd,{speed},mph,G\n'
         '03/05/2024,14:{n:02d}:00,WdDir,270,Deg,G', 60.0, 0.44704),
    ],
    ids=['WRF', 'MAVLink', 'Sutron'],
)  # fmt: skip
def test_lines_whose_form_is_published(
    tmp_path: Path, form: str, step: float, unit: float
) -> None:
    speeds = [4.0 + n for n in range(6)]
    lines = [
        form.format(n=n, h=0.01 * (n + 1), speed=speed, zeros=' 0.0' * 8)
        for n, speed in enumerate(speeds)
    ]
    above = ['Mast 1 3 mast (61.8, 24.2) (98, 121) (61.8, 24.2) 162.3 meters']
    text = '\n'.join(above * form.startswith(' ') + lines)
    record = read_wind(written(tmp_path, text, 'a.txt'), turbulence=False)
    np.testing.assert_allclose(record.velocity[:, 0], unit * np.array(speeds), rtol=1e-9)
    np.testing.assert_allclose(np.diff(record.time), step)


def test_a_wind_relative_to_its_mount_is_no_true_wind(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match='no column for the speed and none for the direction'):
        read_wind(written(tmp_path, 'time,relative wind speed,relative wind direction\n0,5,90\n'))


@pytest.mark.parametrize(('covariance', 'is_turned'), [('-1.0', False), ('0.01', True)])
def test_echoed_messages(tmp_path: Path, covariance: str, is_turned: bool) -> None:
    zeros = ''.join('- 0.0\n' for _ in range(8))
    messages = [
        f'header:\n  stamp:\n    sec: 1709647199\n    nanosec: {nanoseconds}\n  frame_id: imu\n'
        'orientation:\n  x: 0.0\n  y: 0.0\n  z: 0.0\n  w: 1.0\n'
        f'orientation_covariance:\n- {covariance}\n{zeros}'
        f'angular_velocity:\n  x: 0.1\n  y: 0.2\n  z: 0.3\nangular_velocity_covariance:\n{zeros}'
        f'linear_acceleration:\n  x: 0.5\n  y: 0.0\n  z: 9.8\n'
        f'linear_acceleration_covariance:\n{zeros}'
        for nanoseconds in (0, 20_000_000, 40_000_000)
    ]
    record = read_motion(written(tmp_path, '---\n'.join([*messages, '']), 'echo.txt'))
    assert record.acceleration is not None
    assert record.rate is not None
    assert record.acceleration.tolist() == [[0.5, 0.0, 9.8]] * 3
    assert record.rate.tolist() == [[0.1, 0.2, 0.3]] * 3
    assert (record.orientation is not None) == is_turned
    np.testing.assert_allclose(np.diff(record.time), 0.02, atol=1e-6)
    assert record.epoch == BEGIN


def test_the_largest_gust_of_a_time(tmp_path: Path) -> None:
    data = [
        {
            'referenceTime': f'2024-03-05T14:{minutes}:00Z',
            'observations': [
                {'elementId': name, 'value': value, 'unit': 'm/s'}
                for name, value in (('wind_speed', 4.0), ('max(wind_speed_of_gust PT10M)', 7.0))
            ],
        }
        for minutes in (10, 20, 30)
    ]
    record = read_wind(
        written(tmp_path, dumps({'data': data}), 'a.json'), direction=270.0, turbulence=False
    )
    assert record.gust is not None
    assert record.gust.tolist() == [7.0] * 3


def test_units_are_words_of_names_without_a_sign(tmp_path: Path) -> None:
    rows = [{'rollDegrees': 90.0 * n, 'yawRadians': 0.0, 'time': 0.1 * n} for n in range(4)]
    path = written(tmp_path, '\n'.join(map(dumps, rows)), 'tilt.jsonl')
    sway = read_csv_sway(path)
    assert sway.quantity == 'tilt'
    np.testing.assert_allclose(sway.motion[1], [np.pi / 2.0, 0.0])
    with pytest.raises(FormatError, match='no motion among rollDegrees'):
        read_motion(path)


@pytest.mark.parametrize(
    ('name', 'text', 'match'),
    [
        ('a.log', '2024 03 05 14 00 00.1 H:x =  -305 y =   364 z =   -28\n', 'METEK'),
        ('a.TXT', '"COMMENT",\n"STEM N/E"\n"DATE","11-14-2026"\n', 'a recording of Hioki'),
        ('a.csv', 'Trajectories\n120\n,,A,,\nFrame,Sub Frame,X,Y,Z\n', 'frames are no times'),
        ('a.log', 'a/g:\t702\t422\t4139\t-39\t9\t-8\n', 'whose range and rate are set in its'),
        ('a.csv', '--- Data Table File Created By ActiGraph ---\n', 'counts of an activity'),
        ('a.txt', 'wx,at=roof speed=4.0,dir=250 1709647200000000000\nwx,at=a', 'of InfluxDB'),
        ('log.csv', '!Boat,Utc,TWS\n!boat,0,5\n0,45858.5,5,12.1\n', 'pairs of the number'),
        ('a.log', 'FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\n', 'of ArduPilot'),
        ('o.sto', 'DataRate=100.0\nDataType=Quaternion\nversion=3\n', 'the cells of OpenSim'),
        (
            'walk.gpx',
            '<?xml version="1.0"?>\n<gpx creator="x">\n',
            'without the motion of a sensor',
        ),
        (
            'ACC.csv',
            '1791021600.0, 1791021600.0, 1791021600.0\n32.0, 32.0, 32.0\n-12,36,54\n',
            'counts of 1/64 g',
        ),
        ('a.ASC', 'EVENT_NAME: NORCIA\nEVENT_ID: 1\nDATE: 20261030\n', 'as of ESM and ITACA'),
        ('a.csv', 'PROVINCIA;MUNICIPIO;ESTACION;MAGNITUD;H01;V01\n', 'as of Madrid'),
        ('pull.txt', 'Interval=\t0.02 s\nExcelDateTime=\t46309.4\n', 'a text of LabChart'),
        ('a.txt', 'TIMESERIES AM_R7E2C_00_ENE_M, 60 samples, 100 sps,\n', 'of a seismograph'),
        ('a.pos', '% program   : RTKPOST ver.2.4.3\n% obs start : 2026\n', 'of RTKLIB'),
        ('take.csv', 'Format Version,1.23,Take Name,pull\n', 'a take of OptiTrack Motive'),
        ('a.mnd', 'FORMAT-1\n2024-03-05 00:00:00 0\nSFAS\n', 'profiles of a sodar in blocks'),
    ],
)
def test_the_beginning_tells_before_the_suffix(
    tmp_path: Path, name: str, text: str, match: str
) -> None:
    for read in (read_wind, read_motion):
        with pytest.raises(FormatError, match=match):
            read(written(tmp_path, text, name))


@pytest.mark.parametrize(
    ('name', 'text', 'match'),
    [
        ('a.gml', '<?xml version="1.0"?>\n<core:CityModel>\n', 'a city model of CityGML'),
        ('a.xml', '<?xml version="1.0"?><?xml-stylesheet?>\n<Bestand>\n', 'stand of TreeGrOSS'),
        ('a.gml', '<wfs:FeatureCollection xmlns:wfs="x">\n', 'features of a map service in GML'),
        ('a.asc', '//X Y Z Intensity\n1 2 3 40\n', 'a point cloud'),
        (
            'a.csv',
            'TreeID,Segment,X,Y,Radius,Error,AvgHeight,N\n1,1,3.4,-1.2,0.1,0,1,9\n',
            'TreeLS',
        ),
        ('a.asc', 'ncols 40\nnrows 36\nxllcorner 0\n', 'a raster of heights'),
        ('a.csv', '"code","azimuth","dBase","dTip"\n"L1",0,70,50\n', 'the logs and branches'),
    ],
)
def test_the_beginning_of_a_tree_tells_before_its_suffix(
    tmp_path: Path, name: str, text: str, match: str
) -> None:
    with pytest.raises(FormatError, match=match):
        open_tree(written(tmp_path, text, name))


def test_segments_with_numbers_are_cylinders(tmp_path: Path) -> None:
    head = 'file , startX, startY, startZ, endX, endY, endZ, radius, SegmentID, ParentSegmentID'
    rows = 'scan , 0, 0, 7, 0, 0, 9, 0.1, 5, -1,  \nscan , 0, 0, 9, 0, 0.5, 10, 0.05, 6, 5,  \n'
    tree = open_tree(written(tmp_path, f'{head},  \n{rows}'), warn=False).tree
    assert tree.height == pytest.approx(3.0)


def test_counts_of_a_logger_by_the_words_above_them(tmp_path: Path) -> None:
    rows = ''.join(f'{0.01 * n:.3f},0,0,2048\n' for n in range(5))
    text = f';Title, x16-1e, ADXL345\n;Headers, time,Ax,Ay,Az\n{rows}'
    record = read_motion(written(tmp_path, text))
    assert record.acceleration is not None
    np.testing.assert_allclose(record.acceleration[:, 2], 9.80665)


def test_a_temperature_that_falls_is_no_clock(tmp_path: Path) -> None:
    rows = [
        f'"0{9 - k // 24}.03.2024 {23 - k % 24:02}:00";"{9.5 - 0.1 * k:.1f}";'
        f'"Ветер, дующий с юго-запада";"{3 + k % 2}"'
        for k in range(8)
    ]
    text = '\n'.join(['"Местное время в Риге";"T";"DD";"Ff"', *rows])
    found = read_wind(written(tmp_path, text), turbulence=False)
    np.testing.assert_allclose(np.diff(found.time), 3600.0)
    np.testing.assert_allclose(np.linalg.norm(found.velocity, axis=1)[:2], [4.0, 3.0])
    np.testing.assert_allclose(found.velocity[0, :2], np.sqrt(0.5) * 4.0)


def test_places_of_a_scan_with_many_digits_are_metres(tmp_path: Path) -> None:
    rows = ['3.276082,-7.351153,9,640', '-11.120645,15.204001,8,431', '18.5,-2.125,7,512']
    found = inventory(tmp_path, '\n'.join(['x,y,height,n.pts.est', *rows]))
    np.testing.assert_allclose(found.x, [3.276082, -11.120645, 18.5])
    assert 'x and y are taken in m: as degrees the trees would be too far apart' in found.notes
    city = '\n'.join(f'2.35{k}12,48.85{k}12,9,1' for k in range(3))
    assert abs(inventory(tmp_path, f'x,y,height,n\n{city}').x).max() < 400.0


def test_strains_with_a_decimal_comma(tmp_path: Path) -> None:
    rows = [f'{0.02 * k:.2f}\t{60.0 + k:.1f}\t{10.0 - k:.1f}'.replace('.', ',') for k in range(9)]
    text = '\n'.join(['Zeit [s]\tNord [µm/m]\tOst [µm/m]', *rows])
    found = read_strain(written(tmp_path, text, 'pull.asc'))
    np.testing.assert_allclose(found.strain[0, 0], [6e-5, 1e-5])
    np.testing.assert_allclose(np.diff(found.time), 0.02)


def test_components_by_the_names_of_grib(tmp_path: Path) -> None:
    rows = [f'2024-03-05T0{k}:00:00Z,3.0,4.0' for k in range(5)]
    text = '\n'.join(['time,ugrd10m [m/s],vgrd10m [m/s]', *rows])
    found = read_wind(written(tmp_path, text), turbulence=False)
    np.testing.assert_allclose(found.velocity, [[3.0, 4.0, 0.0]] * 5)


def test_columns_of_a_date_are_no_wind_and_lines_about_a_column_tell_its_unit(
    tmp_path: Path,
) -> None:
    head = '% Wind speed WS25 knots 25 m\n%YY MM DD HH Min WD25 WS25\n'
    rows = ''.join(f'2026 05 09 {hour:02} 00 305 {10 + hour}\n' for hour in range(9))
    wind = read_wind(written(tmp_path, head + rows), turbulence=False)
    np.testing.assert_allclose(np.hypot(*wind.velocity[0, :2]), 10.0 * 1852.0 / 3600.0)
    np.testing.assert_allclose(np.degrees(np.arctan2(*-wind.velocity[0, :2])), 305.0 - 360.0)


def test_names_are_below_the_heads_of_labview() -> None:
    heads = 'LabVIEW Measurement\nDate\t2026/04/21\n***End_of_Header***\nDate\t2026/04/21\n'
    units = 'Y_Unit_Label\tg\tStrain\n***End_of_Header***\n'
    rows = 'X_Value\tsila_X\tDMS\tComment\n\t0,5\t1E-4\n'
    table = table_of((heads + units + rows).splitlines(), 'a.lvm')
    assert table.columns == ('X_Value', 'sila_X', 'DMS', 'Comment')
    assert table.units[1] == 'g'
    assert table.values([1]).tolist() == [[0.5]]


@pytest.mark.parametrize(
    ('names', 'stems', 'note'),
    [
        ('x,y,dbh', (10, 15, 52, 126, 283, 533), 'dbh is taken as mm'),
        ('gx,gy,hom,dbh', (10, 15, 52), 'dbh is in mm, as of ForestGEO'),
    ],
)
def test_stems_of_plots_are_in_millimetres(
    tmp_path: Path, names: str, stems: tuple[int, ...], note: str
) -> None:
    place = ','.join('1' for _ in names.split(',')[1:])
    found = inventory(tmp_path, '\n'.join((names, *(f'{place},{each}' for each in stems))))
    np.testing.assert_allclose(found.diameter, np.array(stems) / 1000.0)
    assert note in found.notes


def test_girths_of_old_giants_stay_in_centimetres(tmp_path: Path) -> None:
    found = inventory(tmp_path, 'x,y,girth\n' + ''.join(f'0,0,{g}\n' for g in (310, 480, 950)))
    np.testing.assert_allclose(found.diameter, np.array([3.1, 4.8, 9.5]) / np.pi)


def test_columns_of_another_unit_are_no_strain(tmp_path: Path) -> None:
    text = 'Zeit [s]\tN [µm/m]\tO [µm/m]\tNeigung [°]\n0,0\t26,5\t-38\t0,4\n0,1\t27,5\t-37\t0,4\n'
    record = read_strain(written(tmp_path, text))
    np.testing.assert_allclose(record.strain[0], [[26.5e-6, -38e-6]])
    assert 'columns that are not used: Neigung [°]' in record.notes


def test_strain_of_a_logger_of_campbell_beside_its_other_columns(tmp_path: Path) -> None:
    logger = '"TOA5","W","CR1000","4","Std","CPU:a.CR1","2","Sway"\n'
    names = '"TIMESTAMP","RECORD","S(1)","S(2)","Tilt_X"\n'
    units = '"TS","RN","uStrain","uStrain","deg"\n"","","Smp","Smp","Smp"\n'
    rows = '"2026-10-14 09:59:55",88,31.2,33.5,0.41\n"2026-10-14 09:59:55.25",89,80,"NAN",0.6\n'
    path = written(tmp_path, logger + names + units + rows, 'W.dat')
    np.testing.assert_allclose(
        read_strain(path).strain[:, 0], [[31.2e-6, 33.5e-6], [80e-6, np.nan]]
    )
    with pytest.raises(FormatError, match='a record of motion, not a record of wind'):
        read_wind(path)


def test_names_go_on_beside_units_as_of_kestrel(tmp_path: Path) -> None:
    names = 'FORMATTED DATE_TIME,Wind Speed,Compass True Direction\n'
    units = 'yyyy-MM-dd hh:mm:ss a,km/h,Deg,Data Type,Notes\n'
    rows = ''.join(f'2026-10-14 11:59:{5 * n:02} AM,{7.2 * n:.1f},270,point,\n' for n in range(9))
    wind = read_wind(written(tmp_path, names + units + rows), turbulence=False)
    np.testing.assert_allclose(wind.velocity[:, 0], 2.0 * np.arange(9))


def test_the_name_of_a_species_is_below_its_genus(tmp_path: Path) -> None:
    rows = 'x,y,dbh [cm],Genus,SpeciesName\n0,0,12,Inga,laurina\n5,0,12,Fagus,sylvatica\n'
    assert inventory(tmp_path, rows).species == ('Inga laurina', 'Fagus sylvatica')


def test_a_record_begins_where_it_is_told(tmp_path: Path) -> None:
    rows = ''.join(f'2026-10-14 11:59:{n:02},{n},0\n' for n in range(9))
    path = written(tmp_path, 'time,u [m/s],v [m/s]\n' + rows)
    whole, part = read_wind(path), read_wind(path, start=4.5)
    assert part.epoch == (whole.epoch or 0.0) + 5.0
    np.testing.assert_allclose(part.time, np.arange(4.0))
    np.testing.assert_allclose(part.velocity[:, 0], np.arange(5.0, 9.0))
    with pytest.raises(ParameterError, match='is out of range; use 0 to 8 s'):
        read_wind(path, start=9.0)


def test_a_given_unit_is_that_of_components_too(tmp_path: Path) -> None:
    path = written(tmp_path, 'time,u,v\n0,36,0\n1,18,0\n')
    wind = read_wind(path, speed_unit='km/h')
    np.testing.assert_allclose(wind.velocity[:, 0], [10.0, 5.0])
    assert 'speeds are taken in km/h, as given' in wind.notes
    assert 'taken in m/s' in read_wind(path).notes[0]


def settings(count: int, key: str) -> str:
    """Lines of a logger's settings above its table, each a key and a value."""
    return ''.join(f'{key} {n}\t{n}.5\n' for n in range(count))


@pytest.mark.parametrize('count', [5, 90])
def test_a_table_begins_below_settings_of_any_length(tmp_path: Path, count: int) -> None:
    text = settings(count, 'Speed of fan') + 'Speed units:\tkn\nData\nTime\tMean speed\tMean dir\n'
    rows = ''.join(f'2026-03-05 14:{n}0:00\t{n + 4}\t270\n' for n in range(5))
    record = read_wind(written(tmp_path, text + rows, 'mast.txt'), turbulence=False)
    np.testing.assert_allclose(record.velocity[:, 0], (np.arange(5) + 4) * 1852 / 3600)
    assert record.period == 600.0


@pytest.mark.parametrize(
    ('units', 'factor'), [('Units,mph\n', 0.44704), ('Units,mph\nUnits,m/s\n', 1.0)]
)
def test_a_unit_of_all_channels_is_that_of_the_speed(
    tmp_path: Path, units: str, factor: float
) -> None:
    head = f'[Channel 1]\n{units}Height,40\nTime Stamp,Average Speed,Average Direction\n'
    rows = ''.join(f'3/14/26 9:{n}0,{n + 4},270\n' for n in range(5))
    record = read_wind(written(tmp_path, head + rows), turbulence=False)
    np.testing.assert_allclose(record.velocity[:, 0], (np.arange(5) + 4) * factor)
    assert any('no unit of the speed' in note for note in record.notes) == (factor == 1.0)


def test_a_spread_of_the_wind_is_no_speed_and_a_gust_is_before_a_maximum(tmp_path: Path) -> None:
    kinds = ('SD', 'Avg', 'Max', 'Gust')
    names = '\t'.join(f'Ch4_Anem_25.50m_W_{kind}_m/s' for kind in kinds)
    head = f'Timestamp\t{names}\tCh9_Vane_24.00m_N_SD_Deg\tCh9_Vane_24.00m_N_Avg_Deg\n'
    rows = ''.join(f'2026-03-05 14:{n}0:00\t1\t6\t11\t9\t2\t270\n' for n in range(5))
    record = read_wind(written(tmp_path, head + rows, 'a.txt'), turbulence=False)
    np.testing.assert_allclose(record.velocity, [[6.0, 0.0, 0.0]] * 5, atol=1e-9)
    assert record.gust is not None
    np.testing.assert_allclose(record.gust, 9.0)


def test_an_archive_is_known_by_its_content(tmp_path: Path) -> None:
    names = 'DATAH\tSeconds\tNanoseconds\tDate\tTime\tAux 1 - U (m/s)\tAux 2 - V (m/s)\n'
    rows = [f'DATA\t{BEGIN}\t{n}00000000\t2024-03-05\t09:00:00:{n}00\t{n}\t-1\n' for n in range(4)]
    with ZipFile(tmp_path / 'tower.ghg', 'w') as archive:
        archive.writestr('tower.metadata', '[Site]\nheight=3\n')
        archive.writestr('tower.data', 'Model:\tA\n' + names + ''.join(rows))
    record = read_wind(tmp_path / 'tower.ghg')
    np.testing.assert_allclose(record.velocity, [[n, -1, 0] for n in range(4)])
    np.testing.assert_allclose(record.time, 0.1 * np.arange(4), atol=1e-6)
    assert record.epoch == BEGIN


def workbook(path: Path, *sheets: list[list[Any]]) -> Path:
    """Write a spreadsheet with the rows of its sheets."""
    openpyxl = pytest.importorskip('openpyxl', reason='the extra inventory is not installed')
    book = openpyxl.Workbook()
    book.remove(book.active)
    for rows in sheets:
        sheet = book.create_sheet()
        for row in rows:
            sheet.append(row)
    book.save(path)
    return path


def test_a_wind_in_a_spreadsheet_below_several_header_rows(tmp_path: Path) -> None:
    head = [['x6', 'Port 1', 'Port 1'], ['9 records', 'Station', 'Station']]
    names = [['Timestamps', ' ° Wind Direction', ' mph Wind Speed', ' mph Gust Speed']]
    rows = [[datetime(2026, 3, 5, n), 270, 10 + n, '#N/A' if n else 20] for n in range(4)]
    path = workbook(tmp_path / 'a.xlsx', [['about']], head + names + rows)
    record = read_wind(path, turbulence=False)
    np.testing.assert_allclose(record.velocity[:, 0], (np.arange(4) + 10) * 0.44704)
    assert record.gust is not None
    np.testing.assert_allclose(record.gust, [20 * 0.44704, *[np.nan] * 3])
    with pytest.raises(FormatError, match='a record of wind, not a record of motion'):
        read_motion(path)


def test_a_spreadsheet_of_trees_is_no_wind(tmp_path: Path) -> None:
    trees = [['x', 'y', 'species', 'height'], [0, 0, 'oak', 12], [5, 0, 'ash', 13]]
    path = workbook(tmp_path / 'a.xlsx', [['about']], trees)
    with pytest.raises(FormatError, match='an inventory of trees, not a record of wind'):
        read_wind(path)


def test_an_acceleration_of_a_phone_is_no_wind(tmp_path: Path) -> None:
    with ZipFile(tmp_path / 'a.zip', 'w') as archive:
        archive.writestr('Accelerometer.csv', 'time,x,y,z\n0,0.1,0,9.8\n0.02,0.2,0,9.8\n')
    with pytest.raises(FormatError, match='no column for the speed'):
        read_wind(tmp_path / 'a.zip')


def history(kinds: dict[str, str], lag: float, unit: str = '') -> str:
    """Rows of one entity after another, of which each is a lag [s] behind the one before."""
    rows = [
        f'{unit_of},{name},{4 + n if "speed" in name else 270},'
        f'2026-03-05T14:{n:02d}:{lag * k:06.3f}Z'
        for k, (name, unit_of) in enumerate(kinds.items())
        for n in range(6)
    ]
    return '\n'.join([unit, *rows])


@pytest.mark.parametrize(('lag', 'count'), [(0.0, 6), (0.4, 6), (20.0, 11)])
def test_values_of_entities_belong_together_where_they_are_much_less_than_a_sample_apart(
    tmp_path: Path, lag: float, count: int
) -> None:
    kinds = {'roof_wind_speed': 'km/h', 'roof_wind_direction': '°', 'roof_battery': '%'}
    text = history(kinds, lag, '_measurement,entity_id,_value,_time')
    record = read_wind(written(tmp_path, text), turbulence=False)
    speeds = (np.arange(6) + 4) / 3.6
    np.testing.assert_allclose(np.unique(record.velocity[:, 0]), speeds)
    assert (len(record.time), record.refused) == (count, int(lag > 6.0))


def test_a_history_without_units_asks_for_them(tmp_path: Path) -> None:
    kinds = {'sensor.hof_windgeschwindigkeit_speed': '', 'sensor.hof_windrichtung': ''}
    text = history(kinds, 0.4, 'x,entity_id,state,last_changed').replace('keit_speed', 'keit')
    path = written(tmp_path, text.replace('270', '8').replace(',4,', ',8,'))
    with pytest.raises(FormatError, match='does not say the unit of the speed') as raised:
        read_wind(path)
    assert '--wind-option speed_unit' in raised.value.cure
    assert len(read_wind(path, speed_unit='km/h', turbulence=False).time) == 6


def test_a_channel_that_was_created_has_feeds_with_times(tmp_path: Path) -> None:
    channel = {
        'field1': 'Wind Speed (mph)',
        'field2': 'Wind Direction',
        'created_at': '2020-01-01T00:00:00Z',
    }
    feeds = [
        {'created_at': f'2026-03-05T14:0{n}:00Z', 'field1': '10', 'field2': '270'}
        for n in range(4)
    ]
    path = written(tmp_path, dumps({'channel': channel, 'feeds': feeds}), 'a.json')
    record = read_wind(path, turbulence=False)
    np.testing.assert_allclose(record.velocity[:, 0], 4.4704)
    assert not any('2020' in note for note in record.notes)


NAMES = {
    'series of Prometheus': [
        '"{__name__=""hill_wind_speed_kmh"", instance=""a:1""}"',
        '"{__name__=""hill_wind_direction_degrees"", instance=""a:1""}"',
    ],
    'series with labels': ['wind_speed_kmh{job="w"}', 'wind_direction_degrees{job="w"}'],
    'a place': ['north_hill_windSpeed [km/h]', 'north_hill_windDir'],
    'the mean of two': ['400 Wind speed act. [km/h],Avg wind speed [km/h]', 'Wind dir act.'],
}


@pytest.mark.parametrize('name', NAMES)
def test_names_of_columns_within_others(tmp_path: Path, name: str) -> None:
    speed, direction = NAMES[name]
    first = '1,' * speed.count('],')
    rows = ''.join(f'2026-03-05 14:{n:02}:00,{first}{36 + n},270\n' for n in range(5))
    path = written(tmp_path, f'Time,{speed},{direction}\n{rows}')
    record = read_wind(path, turbulence=False)
    np.testing.assert_allclose(record.velocity[:, 0], (36 + np.arange(5)) / 3.6)


def test_topics_are_names_and_a_sentence_is_no_header(tmp_path: Path) -> None:
    rows = [
        f'2026-03-05T14:0{n}:00Z,yard/wx/{topic},{value}'
        for n in range(5)
        for topic, value in (('windSpeed_ms', 6), ('windDir', 270), ('battery', 3.2))
    ]
    record = read_wind(written(tmp_path, '\n'.join(['time,topic,value', *rows])), turbulence=False)
    np.testing.assert_allclose(record.velocity, [[6.0, 0.0, 0.0]] * 5, atol=1e-9)
    prose = (
        'Time stamps tell the end of the time of a speed.\nDate/Time\tSpeed 9 m\tDirection 8 m\n'
    )
    table = ''.join(f'2026-03-05 14:{n}0\t6\t270\n' for n in range(5))
    record = read_wind(written(tmp_path, prose + table, 'a.txt'), turbulence=False)
    np.testing.assert_allclose(record.velocity, [[6.0, 0.0, 0.0]] * 5, atol=1e-9)


def test_rows_of_several_heights_are_those_of_the_lowest(tmp_path: Path) -> None:
    rows = [f'2026-03-05 14:{n}0,{z},{z / 10},270' for n in range(5) for z in (80, 40)]
    path = written(tmp_path, '\n'.join(['time,height [m],speed [m/s],direction', *rows]))
    record = read_wind(path, turbulence=False)
    np.testing.assert_allclose(record.velocity, [[4.0, 0.0, 0.0]] * 5, atol=1e-9)
    assert 'the wind at 40 of the heights 80, 40' in record.notes


def test_paths_of_signal_k_are_in_its_units(tmp_path: Path) -> None:
    rows = [f'2026-03-05T14:00:0{n}Z,6,4.712389' for n in range(5)]
    names = 'timestamp,environment.wind.speedTrue,environment.wind.directionTrue'
    record = read_wind(written(tmp_path, '\n'.join([names, *rows])))
    np.testing.assert_allclose(record.velocity, [[6.0, 0.0, 0.0]] * 5, atol=1e-4)
    assert record.notes == ('speeds are in m/s, as Signal K has them',)


def test_a_date_and_a_time_in_cells_of_a_spreadsheet_above_a_remark(tmp_path: Path) -> None:
    clocks = [datetime(2026, 3, 5, 14, 5 * n).time() for n in range(4)]
    rows = [[datetime(2026, 3, 5), clock, 36 + n, 270] for n, clock in enumerate(clocks)]
    names = [['Datum', 'Uhrzeit', 'Windgeschw.', 'Windrichtung'], ['', '', 'km/h', '°']]
    path = workbook(tmp_path / 'a.xlsx', [['Mast'], [], *names, *rows, ['checked by hand']])
    record = read_wind(path, turbulence=False)
    np.testing.assert_allclose(record.velocity[:, 0], (36 + np.arange(4)) / 3.6)
    assert (record.period, record.refused) == (300.0, 0)
    assert record.epoch == datetime(2026, 3, 5, 14, tzinfo=UTC).timestamp()


def test_means_of_a_long_table_have_their_unit_beside_them(tmp_path: Path) -> None:
    kinds = (('sensor.roof_wind_speed', 'km/h', 36), ('sensor.roof_wind_direction', '°', 270))
    rows = [f'{name},{unit},05.03.2026 1{n}:00,1,99,{value}' for name, unit, value in kinds
            for n in range(5)]  # fmt: skip
    path = written(tmp_path, '\n'.join(['statistic_id,unit,start,min,max,mean', *rows]))
    np.testing.assert_allclose(read_wind(path, turbulence=False).velocity[:, 0], 10.0)


@pytest.mark.parametrize('name', ['a.txt', 'a.log'])
def test_pairs_behind_a_date(tmp_path: Path, name: str) -> None:
    rows = [f'2026-03-05T14:00:0{n}Z wind_speed={n + 4} wind_dir=270 gust=11.5' for n in range(5)]
    record = read_wind(written(tmp_path, '\n'.join(rows), name))
    np.testing.assert_allclose(record.velocity[:, 0], np.arange(5) + 4)
    assert record.epoch == datetime(2026, 3, 5, 14, tzinfo=UTC).timestamp()
    assert record.gust is not None
    np.testing.assert_allclose(record.gust, 11.5)


def test_units_of_settings_in_german_and_labels_in_braces(tmp_path: Path) -> None:
    head = 'Station;Hang 4\nEinheit Wind;km/h\n\nDatum;Windgeschwindigkeit Mittel;Windrichtung\n'
    rows = ''.join(f'05.03.2026 14:{n}0;{36 + n},5;270\n' for n in range(5))
    record = read_wind(written(tmp_path, head + rows), turbulence=False)
    np.testing.assert_allclose(record.velocity[:, 0], (36.5 + np.arange(5)) / 3.6)
    head = '"Time","wind_speed [kn] {mast: 2}","wind_direction {mast: 2}"\n'
    rows = ''.join(f'2026-03-05 14:{n}0:00,10,270\n' for n in range(5))
    record = read_wind(written(tmp_path, head + rows), turbulence=False)
    np.testing.assert_allclose(record.velocity[:, 0], 10 * 1852 / 3600)


@pytest.mark.parametrize(('beside', 'to_east'), [('110', -4.0), ('290', 4.0), ('20', 4.0)])
def test_components_are_turned_about_by_the_direction_beside_them(tmp_path, beside, to_east):
    rows = '\n'.join(f'{second},4.0,-1.46,{beside}' for second in range(20))
    path = tmp_path / 'sonic.csv'
    path.write_text(f'time,u_m_s,v_m_s,azimuth_deg\n{rows}\n', encoding='utf-8')
    record = read_wind(path)
    assert record.velocity[0, 0] == pytest.approx(to_east)
    assert any('comes from' in note for note in record.notes) == (to_east < 0.0)


def test_hours_are_told_by_the_names_above_names(tmp_path):
    rows = '\n'.join(f'"{hour:02d}","3.{hour % 10}","{10 * hour}"' for hour in range(1, 13))
    names = '"時間(hour)","風速(m/s)","風向(360degree)"\n"ObsTime","WS","WD"'
    path = tmp_path / 'station.csv'
    path.write_text(f'{names}\n{rows}\n', encoding='utf-8')
    assert read_wind(path, turbulence=False).period == 3600.0


def test_a_wind_with_numbered_codes_beside_it_is_no_motion(tmp_path):
    path = tmp_path / 'codes.csv'
    path.write_text('time,ff,dd,w1,w2\n2024-01-01 00:00,3,270,1,2\n', encoding='utf-8')
    assert kind_of(path) == 'wind'


def test_two_columns_of_one_name_are_not_the_first(tmp_path: Path) -> None:
    rows = ''.join(f'{0.02 * n:.2f},0,0,0.05,790,2330,-143\n' for n in range(9))
    path = written(tmp_path, f'time [s],X,Y,Z,X,Y,Z\n{rows}')
    for read in (read_csv_sway, read_motion):
        with pytest.raises(FormatError, match="several columns are called 'X'"):
            read(path)


def test_codes_of_a_service_name_quantities(tmp_path: Path) -> None:
    codes = {'30': '4.0', '31': '270', '32': '18.5', '50': '7.2'}
    rows = [
        {
            'codi_variable': code,
            'data_lectura': f'2026-02-01T09:{half}0:00',
            'valor_lectura': value,
        }
        for half in (0, 3)
        for code, value in codes.items()
    ]
    record = read_wind(written(tmp_path, dumps(rows), 'a.json'), turbulence=False)
    np.testing.assert_allclose(record.velocity, [[4.0, 0.0, 0.0]] * 2, atol=1e-9)
    assert record.gust is not None
    assert record.gust.tolist() == [7.2] * 2


def test_a_zip_has_a_tree_in_each_file(tmp_path: Path) -> None:
    path = tmp_path / 'trees.zip'
    with ZipFile(path, 'w') as archive:
        for number, state in enumerate(('alive', 'dead', 'alive')):
            measured = [{'DBH_cm': 30.0, 'height_m': None, 'state': state}, {'height_m': 20.0}]
            place = {'type': 'Point', 'coordinates': [8.7 + 1e-4 * number, 49.0]}
            own = {'id': f't{number}', 'species': 'Fagus sylvatica', 'measurements': measured}
            tree = {'type': 'Feature', 'properties': own, 'geometry': place}
            archive.writestr(f't{number}.geojson', dumps(tree))
    scene = open_scene(path, warn=False)
    assert [each.name for each in scene.trees] == ['t0', 't2']
    assert scene.trees[0].scale * scene.trees[0].tree.height == pytest.approx(20.0)
    assert any('1 dead or gone' in note for note in scene.notes)


def test_a_zip_has_lists_of_trees_beside_other_files(tmp_path: Path) -> None:
    path = tmp_path / 'trees.zip'
    with ZipFile(path, 'w') as archive:
        archive.writestr('LICENSE.txt', 'CC BY 4.0')
        for part in ('north', 'south'):
            trees = [
                {
                    'type': 'Feature',
                    'properties': {'species': 'Fagus sylvatica', 'height_m': 20.0 + number},
                    'geometry': {'type': 'Point', 'coordinates': [8.7 + 1e-4 * number, 49.0]},
                }
                for number in range(3)
            ]
            document = {'type': 'FeatureCollection', 'features': trees}
            archive.writestr(f'{part}.geojson', dumps(document))
    assert len(open_scene(path, warn=False).trees) == 6


def test_a_zip_without_a_table_names_what_is_in_it(tmp_path: Path) -> None:
    path = tmp_path / 'export.zip'
    with ZipFile(path, 'w') as archive:
        archive.writestr('apple_health_export/export.xml', '<HealthData/>')
    with pytest.raises(FormatError, match='0 of them tables: apple_health_export/'):
        read_motion(path)
