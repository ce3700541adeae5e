# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Formats of recorded wind. A new one is one module with a reader, and one line here."""

from __future__ import annotations

from tree_sway.files.file_format import contains, FileFormat
from tree_sway.files.layouts.known import looks_like_wind
from tree_sway.files.wind.bag import read_bag_wind
from tree_sway.files.wind.instruments import is_logged, read_instrument_wind
from tree_sway.files.wind.metar import METAR, read_metar_wind
from tree_sway.files.wind.netcdf import read_netcdf_wind
from tree_sway.files.wind.nmea import read_nmea_wind
from tree_sway.files.wind.table import read_table_wind

_TABLES = ('.csv', '.tsv', '.txt', '.json', '.epw', '.zip')

WIND_FORMATS = (
    FileFormat('toa5', ('.dat', '.toa5'), contains(r'\A"?TOA5"?,'), read_table_wind),
    FileFormat('nmea', ('.nmea', '.log'), contains(r'\$(?!VN)[A-Z]{5},'), read_nmea_wind),
    FileFormat('sonic', (), is_logged, read_instrument_wind),
    FileFormat(
        'bag', ('.db3', '.mcap'), contains(r'\A(SQLite format 3\0|\ufffdMCAP0\r\n)'), read_bag_wind
    ),
    FileFormat(
        'netcdf',
        ('.nc', '.nc4'),
        contains(r'\A(CDF[\x01\x02\x05]|\ufffdHDF\r\n)'),
        read_netcdf_wind,
    ),
    FileFormat('metar', ('.metar',), lambda head: METAR.search(head) is not None, read_metar_wind),
    FileFormat('csv', _TABLES, looks_like_wind, read_table_wind),
)
