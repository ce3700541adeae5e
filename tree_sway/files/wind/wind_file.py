# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Read a wind record from a file of any known format.

The content decides before the suffix.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from tree_sway.errors import FormatError, nearest
from tree_sway.files.file_format import format_of
from tree_sway.files.kinds import expected
from tree_sway.files.paths import of_file
from tree_sway.files.wind.record import WindRecord
from tree_sway.files.wind.wind_formats import WIND_FORMATS as WIND_FORMATS

EXAMPLES = ('canopy',)
"""Built-in winds: five minutes of a sonic anemometer over a canopy, 20 Hz."""


@of_file
def read_wind(
    path: Path,
    /,
    format: str | None = None,  # noqa: A002
    start: float = 0.0,
    **options: Any,
) -> WindRecord:
    """
    Read a wind record.

    Parameters
    ----------
    path
        Path of the file, or the folder of a bag, or one of `EXAMPLES`.
    format
        Name of the format; found from content and suffix if None.
    start
        Time after the first sample from which on the record is kept [s].
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
        path = Path(__file__).with_name(f'{path}.csv')
    elif not path.exists() and (guess := nearest(str(path), EXAMPLES)):
        raise FormatError('no such file', cure=guess)
    with expected(path, 'wind'):
        chosen = format_of(path, format, WIND_FORMATS, 'wind', folder='bag')
        chosen.refuse_others(options, (*chosen.own_options, 'start'))
        record: WindRecord = chosen.read(path, **options)
        return record.after(start) if start else record
