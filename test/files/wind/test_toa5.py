# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from math import pi
from pathlib import Path

import numpy as np
import pytest

from tree_sway.errors import FormatError, ParameterError
from tree_sway.files.wind.table import read_table_wind

DATA = Path(__file__).parents[1] / 'data'
SONIC = DATA / 'sonic.toa5.dat'


def test_samples_across_midnight_with_a_gap():
    record = read_table_wind(SONIC)
    np.testing.assert_allclose(record.time, [0, 0.05, 0.1, 0.2, 0.4, 0.6], atol=1e-12)
    np.testing.assert_allclose(record.velocity[0], [2.0, 0.5, -0.1])
    np.testing.assert_allclose(record.velocity[-1], [2.8, -0.3, -0.26])
    assert record.epoch == pytest.approx(1709337599.9, abs=1e-5)


def test_bad_rows_are_counted_and_the_first_is_named():
    record = read_table_wind(SONIC)
    assert record.refused == 6
    assert record.first_refused == "line 8: Ux is 'NAN', not a finite number"


def test_axes_of_the_sonic():
    turned = read_table_wind(SONIC, yaw=pi / 2).velocity
    np.testing.assert_allclose(turned[0], [-0.5, 2.0, -0.1], atol=1e-15)
    against = read_table_wind(SONIC, direction_convention='from').velocity
    np.testing.assert_allclose(against[0], [-2.0, -0.5, 0.1])
    with pytest.raises(ParameterError, match='use one of: to, from'):
        read_table_wind(SONIC, direction_convention='north')


def test_columns_by_name():
    record = read_table_wind(SONIC, columns=('Uy', 'Ux', 'Uz'))
    np.testing.assert_allclose(record.velocity[0], [0.5, 2.0, -0.1])
    with pytest.raises(FormatError, match="no column 'Vx' among TIMESTAMP, RECORD, Ux"):
        read_table_wind(SONIC, columns=('Vx', 'Uy', 'Uz'))


@pytest.mark.parametrize(
    ('old', 'new', 'message'),
    [
        ('Ux', 'wind', ':2: no column for the direction among TIMESTAMP'),
        ('cm/s', 'furlong', ":3: unknown unit 'furlong'"),
        ('2024-', '2024x', 'no good row of wind, 12 refused; first line 5'),
    ],
)
def test_not_what_it_promises(tmp_path, old, new, message):
    broken = tmp_path / 'broken.dat'
    broken.write_text(SONIC.read_text().replace(old, new))
    with pytest.raises(FormatError, match=message):
        read_table_wind(broken)


def test_half_a_minute_over_a_canopy():
    """600 rows of the record that the example wind is from, as the logger wrote them."""
    record = read_table_wind(DATA / 'canopy.toa5.dat')
    assert (len(record.time), record.refused) == (600, 0)
    assert record.duration == pytest.approx(29.95, abs=1e-6)
    assert record.period == pytest.approx(0.05, abs=1e-9)
    assert record.epoch == pytest.approx(1339073510.05, abs=1e-6)
    np.testing.assert_allclose(record.velocity[0], [0.436, 0.12175, 0.816])


def test_a_quarter_of_an_hour_is_read_whole(tmp_path):
    head, rows = (DATA / 'canopy.toa5.dat').read_text().splitlines(), []
    for second in range(900):
        stamp = f'2012-06-07 {12 + second // 3600}:{second // 60 % 60:02}:{second % 60:02}'
        rows += [f'"{stamp}.{k * 5:02}",1,1.5,-0.25,0.1,600,8,27,100,0' for k in range(20)]
    (tmp_path / 'a.dat').write_text('\n'.join([*head[:4], *rows]))
    record = read_table_wind(tmp_path / 'a.dat')
    assert (len(record.time), record.refused) == (18000, 0)


def test_good_and_damaged_rows_are_read_alike(tmp_path):
    """One row that numpy does not take must not change how the others are read."""
    whole = read_table_wind(SONIC)
    for damage in ('"2024-03-02 00:00:09",1\n', '"2024-03-02 00:00:09,1,2,3\n', '\n\n', '\x00,\n'):
        (tmp_path / 'a.dat').write_text(SONIC.read_text() + damage)
        record = read_table_wind(tmp_path / 'a.dat')
        np.testing.assert_array_equal(record.time, whole.time)
        np.testing.assert_array_equal(record.velocity, whole.velocity)
        assert record.refused == whole.refused + (damage != '\n\n')
