# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Read a wind record from a file of any known format.

The content decides before the suffix. A new format is one module with a reader, and one line here.
"""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path
from typing import Any

from tree_sway.errors import FormatError, nearest
from tree_sway.files.file_format import contains, FileFormat, format_of
from tree_sway.files.kinds import expected
from tree_sway.files.layouts.known import looks_like_wind
from tree_sway.files.paths import of_file
from tree_sway.files.wind.bag import read_bag_wind
from tree_sway.files.wind.metar import METAR, read_metar_wind
from tree_sway.files.wind.netcdf import read_netcdf_wind
from tree_sway.files.wind.nmea import read_nmea_wind
from tree_sway.files.wind.record import WindRecord
from tree_sway.files.wind.sonic_ascii import read_sonic_wind
from tree_sway.files.wind.table import read_table_wind

_TABLES = ('.csv', '.tsv', '.txt', '.json', '.epw', '.zip')

WIND_FORMATS = (
    FileFormat('toa5', ('.dat', '.toa5'), contains(r'\A"?TOA5"?,'), read_table_wind),
    FileFormat('nmea', ('.nmea', '.log'), contains(r'\$[A-Z]{5},'), read_nmea_wind),
    FileFormat(
        'sonic',
        (),
        contains(r'^(\d[-\d:. T]*Z?[ ,;]+)?(\x02[A-Z],|[A-Z],[+-]?\d+(\.\d+)?,[+-]?\d+\.\d+,)'),
        read_sonic_wind,
    ),
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

EXAMPLES = ('canopy',)
"""Built-in winds: five minutes of a sonic anemometer over a canopy, 20 Hz."""


@of_file
def read_wind(path: Path, /, format: str | None = None, **options: Any) -> WindRecord:  # noqa: A002
    """
    Read a wind record.

    Parameters
    ----------
    path
        Path of the file, or the folder of a bag, or one of `EXAMPLES`.
    format
        Name of the format; found from content and suffix if None.
    **options
        Options of the reader of the format, such as ``topic`` or ``rate``.

    Raises
    ------
    FormatError
        A file of an unknown format, or one without a good row of wind.
    ParameterError
        An option that the reader of this format does not have, or a wrong value.

    """
    if str(path) in EXAMPLES and not path.exists():
        path = Path(str(files('tree_sway.files.wind').joinpath(f'{path}.csv')))
    elif not path.exists() and (guess := nearest(str(path), EXAMPLES)):
        raise FormatError('no such file', cure=guess)
    with expected(path, 'wind'):
        chosen = format_of(path, format, WIND_FORMATS, 'wind', folder='bag')
        chosen.refuse_others(options, chosen.own_options)
        record: WindRecord = chosen.read(path, **options)
        return record
