# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Critical winds of trees by their names, from the table that ``tree-sway risk`` writes."""

from __future__ import annotations

import csv
from pathlib import Path

from tree_sway.errors import FormatError, inside
from tree_sway.files.paths import of_file
from tree_sway.files.text_file import finite, read_text

NAME = 'name'
LOW = 'low_80 [m/s]'
HIGH = 'high_80 [m/s]'
_CURE = 'give the table that tree-sway risk writes'


@of_file
def read_critical_winds(path: Path) -> dict[str, tuple[float, float]]:
    """
    Read the band of 80 % of the critical wind of each tree.

    Parameters
    ----------
    path
        Table of ``tree-sway risk``.

    Returns
    -------
    dict
        Low and high end of the band at 10 m in [m/s] by the name of the tree; trees without a
        critical wind are left out.

    Raises
    ------
    FormatError
        A file that cannot be read, without the columns, or with a wind that is no number.

    """
    rows = csv.DictReader(read_text(path).splitlines())
    for column in (NAME, LOW, HIGH):
        if column not in (rows.fieldnames or ()):
            raise FormatError(f"no column '{column}'", cure=_CURE)
    found = {}
    for row in rows:
        if row[LOW] and row[HIGH]:
            with inside(f'line {rows.line_num}'):
                found[row[NAME]] = _wind(row[LOW]), _wind(row[HIGH])
    return found


def _wind(text: str) -> float:
    value = finite(text)
    if value is None or value < 0.0:
        raise FormatError(f"'{text[:40]}' is no wind speed", cure=_CURE)
    return value
