# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Columns to a table: CSV, JSON, or Parquet where pyarrow is there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
import csv
from importlib.util import find_spec
import io
import json
from pathlib import Path
from typing import Any

from tree_sway.errors import FormatError, MissingDependencyError
from tree_sway.extras import cure_of_missing
from tree_sway.files.atomic_file import whole_file, write_text_whole

_TABLE_SUFFIXES = ('.csv', '.parquet', '.json')


def refuse_no_table(path: Path) -> None:
    """
    Refuse a file that cannot be written as a table, before anything is computed.

    Raises
    ------
    FormatError
        A suffix that is not one of `_TABLE_SUFFIXES`.
    MissingDependencyError
        Parquet without pyarrow.

    """
    suffix = path.suffix.lower()
    if suffix not in _TABLE_SUFFIXES:
        raise FormatError(
            f"'{path.suffix}' is no table",
            where=str(path),
            cure=f'end it with one of: {", ".join(_TABLE_SUFFIXES)}',
        )
    if suffix == '.parquet' and find_spec('pyarrow') is None:
        raise MissingDependencyError(
            'Parquet needs pyarrow',
            cure=f'{cure_of_missing("pyarrow")}; or end the name with .csv',
        )


def write_columns(columns: Mapping[str, Sequence[Any]], path: Path) -> None:
    """
    Write columns of one length by their names, atomically.

    Raises
    ------
    FormatError
        A file that cannot be written.
    TreeSwayError
        Errors of `refuse_no_table`.

    """
    refuse_no_table(path)
    if path.suffix.lower() == '.csv':
        text = io.StringIO()
        writer = csv.writer(text, lineterminator='\n')
        writer.writerow(columns)
        writer.writerows(zip(*columns.values(), strict=True))
        write_text_whole(path, text.getvalue())
    elif path.suffix == '.json':
        write_text_whole(path, json.dumps({name: [*each] for name, each in columns.items()}))
    else:
        import pyarrow
        from pyarrow import parquet

        with whole_file(path) as partial:
            parquet.write_table(pyarrow.table(dict(columns)), partial)
