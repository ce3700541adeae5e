# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The lines of a table's file, or of the tables in a zip, as phones and services export them.

A zip is known by its content, as those of loggers have suffixes of their own. Those of the sheets
of a spreadsheet have tabs between the cells.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from zipfile import BadZipFile, is_zipfile, ZipFile
import zlib

from tree_sway.errors import FormatError
from tree_sway.files.foreign_file import foreign_file
from tree_sway.files.spreadsheet import sheets_of
from tree_sway.files.text_file import decoded, read_bytes, read_lines, reason_of, table_lines

_MOST_FILES = 200
_SHOWN = 3
_HEAD = 200
_MOST_BYTES = 64 << 20
"""Largest size of all tables of a zip that are unpacked [bytes]."""
_SUFFIXES = '.csv .txt .tsv .dat .data .log .tab .json .geojson'.split()


def table_in(path: Path, is_wanted: Callable[[str], bool]) -> tuple[str, list[str]]:
    """Return name and lines of the first table in a file that begins as wanted, else the first."""
    tables = list(tables_in(path))
    wanted = (each for each in tables if is_wanted('\n'.join(each[1][:_HEAD])))
    return next(wanted, tables[0])


def tables_in(path: Path) -> Iterator[tuple[str, list[str]]]:
    """
    Yield the name and the lines of a file, or of each table in a zip or sheet of a spreadsheet.

    Raises a `FormatError` for a broken zip, one without a table, or one that is too large.
    """
    if path.suffix.lower() in ('.xlsx', '.xlsm'):
        for number, rows in enumerate(sheets_of(path), start=1):
            lines = ('\t'.join(map(' '.join, map(str.split, row))) for row in rows)
            yield f'{path}/sheet {number}', [line.replace('"', ' ') for line in lines]
        return
    if not read_bytes(path, 4) or not is_zipfile(path):
        yield str(path), read_lines(path)
        return
    cure = foreign_file(path)[1] or 'unpack it first'
    try:
        with ZipFile(path) as archive:
            files = [each for each in archive.infolist() if not each.is_dir()]
            found = [each for each in files if Path(each.filename).suffix.lower() in _SUFFIXES]
            if not found or len(files) > _MOST_FILES:
                names = ', '.join(each.filename for each in files[:_SHOWN])
                what = f'a zip of {len(files)} files, {len(found)} of them tables: {names}'
                raise FormatError(what, cure=cure)
            left = _MOST_BYTES
            for each in found:
                with archive.open(each) as packed:
                    data = packed.read(left + 1)
                left -= len(data)
                if left < 0:
                    raise FormatError(
                        f'tables of more than {_MOST_BYTES >> 20} MiB in a zip', cure=cure
                    )
                name = f'{path}/{each.filename}'
                yield name, table_lines(decoded(data, 'replace'), Path(name))
    except (BadZipFile, OSError, RuntimeError, NotImplementedError, EOFError, zlib.error) as error:
        raise FormatError(f'a zip that cannot be read: {reason_of(error)}', cure=cure) from None
