# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Critical winds of trees by their names, from the table that ``tree-sway risk`` writes."""

from __future__ import annotations

import csv
import math
from pathlib import Path

from tree_sway.errors import FormatError
from tree_sway.files.paths import path_of
from tree_sway.files.text_file import read_text

NAME = 'name'
LOW = 'low_80 [m/s]'
HIGH = 'high_80 [m/s]'


def read_critical_winds(path: str | Path) -> dict[str, tuple[float, float]]:
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
    source = path_of(path)
    rows = csv.DictReader(read_text(source).splitlines())
    for column in (NAME, LOW, HIGH):
        if column not in (rows.fieldnames or ()):
            cure = 'give the table that tree-sway risk writes'
            raise FormatError(f"no column '{column}'", where=str(source), cure=cure)
    found = {}
    for row in rows:
        if row[LOW] and row[HIGH]:
            where = f'{source}: line {rows.line_num}'
            found[row[NAME]] = _wind(row[LOW], where), _wind(row[HIGH], where)
    return found


def _wind(text: str, where: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0.0 <= value < math.inf:
        cure = 'give the table that tree-sway risk writes'
        raise FormatError(f"'{text[:40]}' is no wind speed", where=where, cure=cure)
    return value
