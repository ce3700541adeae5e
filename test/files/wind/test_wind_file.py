# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from pathlib import Path
import shutil

import numpy as np
import pytest

from tree_sway.errors import FormatError, ParameterError
from tree_sway.files.wind.wind_file import read_wind, WIND_FORMATS

DATA = Path(__file__).parents[1] / 'data'


@pytest.mark.parametrize(
    ('name', 'n'),
    [('sonic.toa5.dat', 6), ('mast.nmea', 5), ('wind.csv', 3), ('wind_components.csv', 2)],
)
@pytest.mark.parametrize('suffix', [None, '.txt', ''])
def test_content_decides(tmp_path, name, n, suffix):
    path = DATA / name
    if suffix is not None:
        path = Path(shutil.copy(path, tmp_path / f'record{suffix}'))
    record = read_wind(path)
    assert record.velocity.shape == (n, 3)
    assert record.source == str(path)


def test_line_ends_and_byte_order_mark(tmp_path):
    text = (DATA / 'sonic.toa5.dat').read_text()
    for end in ('\r\n', '\r'):
        (tmp_path / 'a.dat').write_bytes(b'\xef\xbb\xbf' + text.replace('\n', end).encode())
        assert len(read_wind(tmp_path / 'a.dat').time) == 6


def test_options_and_formats_are_checked():
    with pytest.raises(ParameterError, match="no option 'rate'; it has: columns, dir"):
        read_wind(DATA / 'sonic.toa5.dat', rate=2.0)
    formats = 'toa5, nmea, sonic, bag, netcdf, metar, csv'
    with pytest.raises(ParameterError, match=f"unknown wind format 'grib'; use {formats}"):
        read_wind(DATA / 'sonic.toa5.dat', format='grib')
    assert len({known.name for known in WIND_FORMATS}) == len(WIND_FORMATS)


def test_no_known_format(tmp_path):
    (tmp_path / 'x.bin').write_bytes(b'\x00\x01')
    with pytest.raises(FormatError, match='unknown wind format; give one of toa5'):
        read_wind(tmp_path / 'x.bin')
    with pytest.raises(FormatError, match='no such file'):
        read_wind(tmp_path / 'none.csv')


def test_an_example_comes_with_the_package():
    record = read_wind('canopy')
    assert (len(record.time), record.refused) == (6000, 0)
    assert record.duration == pytest.approx(299.95)
    assert np.linalg.norm(record.velocity, axis=1).mean() == pytest.approx(2.2, abs=0.01)
    assert 'CC0' in Path(record.source).read_text()[:500]
