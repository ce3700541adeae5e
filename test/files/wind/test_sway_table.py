# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from math import pi

import numpy as np
import pytest

from tree_sway.errors import FormatError
from tree_sway.files.wind.sway_table import parse_sway, read_csv_sway


def read(tmp_path, text):
    path = tmp_path / 'sway.csv'
    path.write_text(text)
    return read_csv_sway(path)


@pytest.mark.parametrize(
    ('header', 'quantity', 'factor'),
    [
        ('time,x,y', 'displacement', 1.0),
        ('t;X [mm];Y [mm]', 'displacement', 1e-3),
        ('Time [s],displacement_x (cm),displacement_y (cm)', 'displacement', 1e-2),
        ('stamp\ttilt_x [deg]\ttilt_y [deg]', 'tilt', pi / 180),
        ('time,roll,pitch', 'tilt', 1.0),
        ('time,gyro_x [deg/s],gyro_y [deg/s]', 'rate', pi / 180),
        ('time,ax [g],ay [g]', 'acceleration', 9.80665),
        ('seconds,Accel X,Accel Y', 'acceleration', 1.0),
    ],
)
def test_quantities_and_units(tmp_path, header, quantity, factor):
    separator = next(c for c in ',;\t' if c in header)
    rows = [separator.join(cells) for cells in (('0', '1', '-2'), ('0.1', '3', '4e-1'))]
    record = read(tmp_path, '\n'.join(['# a pull', header, *rows]) + '\n')
    assert record.quantity == quantity
    np.testing.assert_allclose(record.time, [0.0, 0.1])
    np.testing.assert_allclose(record.motion, factor * np.array([[1.0, -2.0], [3.0, 0.4]]))
    assert len(record.columns) == 2
    assert record.source.endswith('sway.csv')


def test_other_columns_are_left_alone(tmp_path):
    record = read(
        tmp_path, 'wind_speed,time_of_day,t [ms],battery (V),z\n4,noon,0,12,1\nn/a,noon,50,12,2\n'
    )
    np.testing.assert_allclose(record.time, [0.0, 0.05])
    np.testing.assert_allclose(record.motion, [[1.0], [2.0]])


def test_dates(tmp_path):
    record = read(tmp_path, 'time,x\n2024-03-01T12:00:00.00Z,1\n2024-03-01T12:00:00.05Z,2\n')
    np.testing.assert_allclose(record.time, [0.0, 0.05])


@pytest.mark.parametrize(
    ('text', 'message'),
    [
        ('time,wind\n0,1\n', r'sway.csv:1: no motion among time, wind; call the columns time, x'),
        ('x,y\n0,1\n', r'sway.csv:1: no time among x, y'),
        ('time,x,ax\n0,1,1\n', r'sway.csv:1: acceleration and displacement in one file; keep'),
        ('time,x [ft]\n0,1\n', r"sway.csv:1: unknown unit 'ft'; use m, cm, mm"),
        ('time [week],x\n0,1\n', r"sway.csv:1: unknown unit 'week'"),
        ('time,x\n0,1\n.1,1e308\n', r'sway.csv:3: x is 1e\+308, which is implausible; correct'),
        ('time,x [g]\n0,1\n.1,1e308\n', r"sway.csv:1: unknown unit 'g'"),
        ('time,ax [g]\n0,1\n.1,1e308\n', r'sway.csv:3: ax \[g\] is 1e\+308, which is implausible'),
        ('time,x\n0,1\n1e300,1\n', r"sway.csv:3: time is '1e300', neither seconds nor a date"),
        ('time;x\n0.5;1\n1;0,5\n', r"sway.csv:3: x is '0,5', with a decimal comma: export it"),
        ('time,x\n0,0,0,5\n0,1,0,6\n', r'sway.csv:2: more cells than the 2 columns'),
        ('time,x\n0,1\n.1,nan\n', r"sway.csv:3: x is 'nan', not a finite number; correct"),
        ('time,x\n0,1\n.1\n', r"sway.csv:3: 1 cells, none for 'x'"),
        ('time,x\n0,1\nlater,1\n', r"sway.csv:3: time is 'later', neither seconds nor a date"),
        ('time,x\n0,1\n.2,1\n.1,1\n', r'sway.csv:4: time .1 does not come after .2; put the rows'),
        ('time,x\n0,1\n0,1\n', r'sway.csv:3: time 0 does not come after 0'),
        ('time,x\n', 'no header and rows'),
        ('', 'no header and rows'),
    ],
)
def test_errors(tmp_path, text, message):
    with pytest.raises(FormatError, match=message):
        read(tmp_path, text)


def test_no_file(tmp_path):
    with pytest.raises(FormatError, match=r'none.csv: no such file'):
        read_csv_sway(tmp_path / 'none.csv')


def test_of_an_imu_the_acceleration_is_taken():
    rows = ['time,ax,ay,az,gx,gy,gz', '0,1,2,9.8,7,7,7', '1,3,4,9.8,7,7,7']
    found = parse_sway(rows, 'motion_1.csv')
    assert found.quantity == 'acceleration'
    assert found.motion.tolist() == [[1.0, 2.0, 9.8], [3.0, 4.0, 9.8]]
