# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Rows of a study as one table: CSV, or Parquet where pyarrow is there."""

from __future__ import annotations

import csv
import io
from pathlib import Path

from tree_sway_ros.errors import FormatError, MissingDependencyError
from tree_sway_ros.files.whole_file import whole_file, write_text_whole
from tree_sway_ros.study.campaign.plan import Plain


def write_table(rows: list[Plain], path: Path) -> None:
    """
    Write one row per case, whole or not at all; columns in the order in which they first occur.

    Raises
    ------
    FormatError
        A suffix that is neither ``.csv`` nor ``.parquet``.
    MissingDependencyError
        Parquet is asked for and pyarrow is not there.

    """
    names = list(dict.fromkeys(name for row in rows for name in row))
    if path.suffix == '.csv':
        text = io.StringIO()
        writer = csv.DictWriter(text, names, lineterminator='\n')
        writer.writeheader()
        writer.writerows(rows)
        write_text_whole(path, text.getvalue())
    elif path.suffix == '.parquet':
        try:
            import pyarrow
            from pyarrow import parquet
        except ImportError:
            raise MissingDependencyError(
                'Parquet needs pyarrow', cure='pip install pyarrow, or end the name with .csv'
            ) from None
        columns = {name: [row.get(name) for row in rows] for name in names}
        with whole_file(path) as partial:
            parquet.write_table(pyarrow.table(columns), partial)
    else:
        raise FormatError(
            f"'{path.suffix}' is no table", where=str(path), cure='end it with .csv or .parquet'
        )
