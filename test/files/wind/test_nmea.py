# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from math import pi, radians
from pathlib import Path

import numpy as np
import pytest

from tree_sway.errors import FormatError, ParameterError
from tree_sway.files.wind.nmea import parse_nmea, read_nmea_wind
from tree_sway.files.wind.sensor_line import checksum_of
from tree_sway.files.wind.wind_file import read_wind

DATA = Path(__file__).parents[1] / 'data'
MAST = DATA / 'mast.nmea'


def test_true_wind_units_and_places_in_time():
    record = read_nmea_wind(MAST)
    np.testing.assert_array_equal(record.time, [0, 1, 5, 6, 7])
    speed = np.linalg.norm(record.velocity, axis=1)
    np.testing.assert_allclose(speed, [10, 10, 4.4704, 5, 5])
    # From 270 degrees is a westerly: it blows to the east.
    np.testing.assert_allclose(record.velocity[0], [10, 0, 0], atol=1e-12)
    np.testing.assert_allclose(record.velocity[-1], [0, 5, 0], atol=1e-12)


def test_refused_sentences():
    record = read_nmea_wind(MAST)
    assert record.refused == 3
    assert record.first_refused == "line 5: status is 'V', not A"


def test_relative_wind_by_name():
    record = read_nmea_wind(MAST, sentence='MWV R')
    np.testing.assert_allclose(record.velocity, [[12 * 1852 / 3600, 0, 0]], atol=1e-12)


def test_wind_direction_true_and_magnetic():
    record = read_nmea_wind(DATA / 'weather.nmea', declination=radians(5))
    np.testing.assert_allclose(record.velocity[0], [10, 0, 0], atol=1e-12)
    np.testing.assert_allclose(record.velocity[1], [0, -19.438 * 1852 / 3600, 0], atol=1e-12)
    assert record.refused == 1


def test_heading_and_rate():
    record = read_nmea_wind(MAST, heading=pi / 2, rate=4.0)
    np.testing.assert_allclose(record.velocity[0], [0, -10, 0], atol=1e-12)
    assert record.period == 0.25
    assert any('head 90 degrees' in note for note in record.notes)


@pytest.mark.parametrize(
    ('body', 'velocity'),
    [
        ('IIVWR,090.0,L,,,5.0,M,,', (5, 0, 0)),  # from the left, to the right
        ('IIVWR,090.0,R,10.0,N,5.2,M,18.7,K', (-10 * 1852 / 3600, 0, 0)),
        ('IIVWT,000.0,R,,N,,M,18.0,K', (0, -5, 0)),
        ('WIMWV,180.0,R,36.0,K,A', (0, 10, 0)),
    ],
)
def test_left_and_right_of_the_bow(body, velocity):
    said = parse_nmea(f'${body}*{checksum_of(body)}\r\n')
    np.testing.assert_allclose(said.velocity(0.0), velocity, atol=1e-12)
    x, y, _ = said.velocity(0.0)
    turned = parse_nmea(f'${body}', heading=pi / 2)
    np.testing.assert_allclose(turned.velocity(0.0)[:2], (y, -x), atol=1e-12)


@pytest.mark.parametrize(
    ('line', 'refusal'),
    [
        ('$IIVWR,190.0,L,5.0,M', "no angle up to 180: '190.0'"),
        ('$IIVWR,90.0,X,5.0,M', "no side L or R: 'X'"),
        ('$IIVWR,90.0,R,5.0,C', 'no speed with a unit'),
        ('$IIVWT,90.0,R,-5.0,M', "speed is '-5.0'"),
        ('$IIMWV,,R,12.0,N,A', "direction is ''"),
        ('$IIMWV,270,R,,N,A', "speed is ''"),
        ('$IIMWV,270,R,12.0,X,A', "no unit K, M, N or S: 'X'"),
        ('$IIMWD,,T,,M,10.0,N,5.1,M', "direction is ''"),
        ('$IIMWD,45.0,T,,M,,N,fast,M', "speed is 'fast'"),
        ('$IIMWV,270,R,12.0,N,A*1', 'wrong checksum'),
        ('$IIMWV,270,R,12.0,N,A*+1', 'wrong checksum'),
        ('$IIMWV,270,R,12.0,N,A' + ',' * 2000, 'a line of 2021 characters'),
    ],
)
def test_refusals(line, refusal):
    assert parse_nmea(line).reason == refusal


@pytest.mark.parametrize('line', ['', '$', '$IIMWV', '$IIMWV,1', '$PMWV,1,R,2,N,A', '$IIHDT,1,T'])
def test_what_is_not_about_the_wind(line):
    assert parse_nmea(line) is None


def test_errors(tmp_path):
    (tmp_path / 'other.nmea').write_text('$GPZDA,120000\n')
    with pytest.raises(FormatError, match='no sentence MWD'):
        read_nmea_wind(tmp_path / 'other.nmea', sentence='MWD')
    with pytest.raises(FormatError, match='no good row of wind, 1 refused; first line 11'):
        read_nmea_wind(MAST, sentence='MWD')
    with pytest.raises(ParameterError, match="sentence is 'VHW'"):
        read_nmea_wind(MAST, sentence='VHW')
    for rate in (0.0, float('nan')):
        with pytest.raises(ParameterError, match='rate is'):
            read_nmea_wind(MAST, rate=rate)


def test_a_log_of_a_boat(tmp_path):
    """Sentences of many instruments, true and apparent wind in turn, at about 1 Hz."""
    rng = np.random.default_rng(3)
    knots, lines = rng.uniform(2.0, 22.9, 375).round(1), list[str]()
    for speed in knots:
        for body in (
            'GPGLL,5958.613,N,02325.928,E,121022,A,D',
            f'IIMWV,{rng.integers(360):03},R,{speed + 3:.1f},N,A',
            f'IIMWV,{rng.integers(360):03},T,{speed:.1f},N,A',
            'SDDBT,17.0,f,5.2,M,2.8,F',
        ):
            lines.append(f'${body}*{checksum_of(body)}')
    (tmp_path / 'boat.log').write_text('\r\n'.join(lines))
    record = read_wind(tmp_path / 'boat.log')
    speed = np.linalg.norm(record.velocity, axis=1)
    np.testing.assert_allclose(speed, knots * 1852 / 3600)
    assert (len(record.time), record.refused) == (375, 0)
