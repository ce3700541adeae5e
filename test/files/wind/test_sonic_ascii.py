# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from math import pi
from pathlib import Path

import numpy as np
import pytest

from tree_sway.errors import FormatError, ParameterError
from tree_sway.files.wind.instruments import read_instrument, read_instrument_wind
from tree_sway.files.wind.reading import Refusal, WindReading
from tree_sway.files.wind.sensor_line import checksum_of
from tree_sway.files.wind.wind_file import read_wind


def gill(body: str) -> str:
    return f'\x02{body}\x03{checksum_of(body)}\r\n'


@pytest.mark.parametrize(
    ('body', 'checksum'),
    [
        ('Q,229,002.74,M,00,', '16'),
        ('A,+000.04,-000.02,M,+345.01,+022.36,00,', '25'),
        ('A,121,000.08,M,+344.66,+021.76,00,', '06'),
    ],
)
def test_the_examples_of_the_manuals_have_a_right_checksum(body, checksum):
    assert isinstance(read_instrument(f'\x02{body}\x03{checksum}'), WindReading)
    assert read_instrument(f'\x02{body}\x0377') == Refusal('gill', 'wrong checksum')


@pytest.mark.parametrize(
    ('line', 'velocity'),
    [
        (gill('Q,270,010.00,M,00,'), (10, 0, 0)),  # from the west, to the east
        (gill('Q,000,010.00,N,00,'), (0, -10 * 1852 / 3600, 0)),
        (gill('Q,,000.04,M,60,'), (0, -0.04, 0)),  # calm, without a direction
        (gill('Q,090.5,003.000,-000.500,M,+345.01,+022.36,00,'), (-2.99989, 0.02618, -0.5)),
        (gill('A,+003.00,-004.00,M,00,'), (4, 3, 0)),  # to the north, and from west to east
        (gill('A,+003.00,+004.00,+001.00,M,+345.01,+022.36,00,+23.13C,'), (-4, 3, 1)),
        ('Q,180,060.00,F,00,', (0, 0.3048, 0)),
    ],
)
def test_what_is_said(line, velocity):
    said = read_instrument(line)
    np.testing.assert_allclose(said.velocity(0.0), velocity, atol=1e-4)
    x, y, z = said.velocity(0.0)
    turned = read_instrument(line, heading=pi / 2)  # the marker points to the east
    np.testing.assert_allclose(turned.velocity(0.0), (y, -x, z), atol=1e-12)


@pytest.mark.parametrize(
    ('line', 'refusal'),
    [
        (gill('Q,270,010.00,M,00,').replace('270', '271'), 'wrong checksum'),
        (gill('Q,270,010.00,M,04,'), "status is '04', not 00"),
        (gill('Q,270,010.00,M,'), "status is '', not 00"),
        (gill('Q,270,010.00,X,00,'), "speed is ''"),
        (gill('Q,,010.00,M,00,'), "direction is ''"),
        (gill('Q,400,010.00,M,00,'), "direction is '400'"),
        (gill('Q,270,-10.00,M,00,'), "speed is ''"),
        (gill('A,001.59,1,M,00,'), "speed is ''"),
        (gill('A,+001.59,,M,00,'), "speed is ''"),
        ('Q,270,010.00,M,00,' + ' ' * 2000, 'a line of 2018 characters'),
    ],
)
def test_what_is_refused(line, refusal):
    assert read_instrument(line) == Refusal('gill', refusal)


@pytest.mark.parametrize('line', ['', '\x02', 'hello', 'T 21.3 H 40', '$IIMWV,1,R,2,N,A', '1,2,3'])
def test_what_is_not_about_the_wind(line):
    assert read_instrument(line) is None


def test_a_log(tmp_path: Path):
    lines = [gill('Q,270,005.00,M,00,'), gill('Q,270,005.00,M,04,'), gill('Q,280,006.00,M,00,')]
    (tmp_path / 'sonic.txt').write_text('start\n' + ''.join(lines), newline='')
    record = read_wind(tmp_path / 'sonic.txt', rate=4.0)
    np.testing.assert_allclose(record.time, [0.0, 0.5])
    np.testing.assert_allclose(np.linalg.norm(record.velocity, axis=1), [5, 6])
    assert record.refused == 1
    with pytest.raises(ParameterError, match='rate is 0 Hz'):
        read_instrument_wind(tmp_path / 'sonic.txt', rate=0.0)
    (tmp_path / 'sonic.txt').write_text('start\n')
    with pytest.raises(FormatError, match='no sentence gill'):
        read_instrument_wind(tmp_path / 'sonic.txt')


def test_a_sonic_that_measures_no_direction_in_a_calm_measures_a_wind():
    assert read_instrument(gill('Q,,000.05,M,00,')).speed == 0.05
