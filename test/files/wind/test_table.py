# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from math import pi
from pathlib import Path

import numpy as np
import pytest

from tree_sway.errors import FormatError, ParameterError
from tree_sway.files.wind.table import read_table_wind

DATA = Path(__file__).parents[1] / 'data'


def test_speed_and_direction():
    record = read_table_wind(DATA / 'wind.csv')
    np.testing.assert_allclose(record.time, [0, 0.5, 1.5])
    np.testing.assert_allclose(record.velocity, [[10, 0, 0], [0, 5, 0], [-2.5, 0, 0]], atol=1e-12)
    assert record.refused == 1
    assert record.first_refused == "line 5: wind_speed (km/h) is '', not a finite number"
    assert record.epoch is None


def test_direction_it_blows_to_and_turned_sensor():
    against = read_table_wind(DATA / 'wind.csv', direction_convention='to')
    np.testing.assert_allclose(against.velocity[0], [-10, 0, 0], atol=1e-12)
    turned = read_table_wind(DATA / 'wind.csv', yaw=pi / 2)
    np.testing.assert_allclose(turned.velocity[0], [0, 10, 0], atol=1e-12)


def test_components_with_dates():
    record = read_table_wind(DATA / 'wind_components.csv')
    knot = 1852 / 3600
    np.testing.assert_allclose(record.velocity, [[10 * knot, 0, 0], [10 * knot, 5 * knot, 0]])
    assert record.epoch == 1709290800.0
    assert list(record.time) == [0.0, 0.25]


@pytest.mark.parametrize(
    ('text', 'message'),
    [
        ('time,u\n0,1\n', ':1: no column for the speed and none for the direction among time, u'),
        ('u,v\n0,1\n', ':1: no column for the time among u, v; call it time in'),
        ('time,u [furlong],v\n0,1,1\n', ":1: unknown unit 'furlong'"),
        ('time,u,v\n', 'no header and rows'),
        ('time,u,v\n0,a,1\n1,2\n', "no good row of wind, 2 refused; first line 2: u is 'a', not"),
        ('time,speed,direction\n0,-1,0\n', 'first line 2: speed is -1'),
    ],
)
def test_errors(tmp_path, text, message):
    (tmp_path / 'wind.csv').write_text(text)
    with pytest.raises(FormatError, match=message):
        read_table_wind(tmp_path / 'wind.csv')


def test_convention_is_checked():
    with pytest.raises(ParameterError, match='use one of: to, from'):
        read_table_wind(DATA / 'wind.csv', direction_convention='in')


@pytest.mark.parametrize('stamp', ['2024-13-01 00:00:00', 'now', '2024-03-01 25:00', 'NaT', ''])
def test_a_wrong_date_costs_one_row(tmp_path, stamp):
    rows = [f'{date},1,2' for date in ('2024-03-01 00:00', stamp, '2024-03-01 00:01:00.5Z')]
    (tmp_path / 'wind.csv').write_text('\n'.join(['time,u,v', *rows]))
    record = read_table_wind(tmp_path / 'wind.csv')
    assert list(record.time) == [0.0, 60.5]
    assert record.refused == 1
