# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Files of inventories: text, spreadsheets, GeoJSON and GeoPackage, each as a table."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
import re

from tree_sway.errors import FormatError
from tree_sway.files.cell_table import table_of_cells
from tree_sway.files.foreign_file import foreign_file
from tree_sway.files.layouts.plain import PLAIN
from tree_sway.files.paths import of_file
from tree_sway.files.scenes.inventory.columns import missing_columns
from tree_sway.files.scenes.inventory.geojson import looks_like_geojson, read_geojson
from tree_sway.files.scenes.inventory.geopackage import is_geopackage, read_geopackage
from tree_sway.files.spreadsheet import read_spreadsheet
from tree_sway.files.table_file import TextTable
from tree_sway.files.zipped import table_in

_HEAD = 60
_LONGEST = 65_536
"""Characters of the beginning of a file in a zip that are looked at."""
_NAME = re.compile(r'"([^"\n]{1,60})"\s*:')


@of_file
def inventory_table(path: Path, head: str) -> TextTable:
    """Return the table of an inventory's file; errors are those of its format."""
    if read := _own_reader(path, head):
        return read(path)
    what, cure = foreign_file(path, head or ' ')
    if what:
        raise FormatError(what, cure=cure)
    name, lines = table_in(path, _is_inventory)
    return PLAIN.read(lines, name)


def has_own_format(path: Path, head: str) -> bool:
    """Whether a file is of a format that inventories have and other files of trees have not."""
    is_zip = path.suffix.lower() == '.zip'
    return _own_reader(path, head) is not None or (is_zip and _is_inventory(_head_in(path)))


def _head_in(path: Path) -> str:
    """Return the beginning of the table in a zip that is most like an inventory."""
    _, lines = table_in(path, lambda head: looks_like_geojson(head) or _is_inventory(head))
    return '\n'.join(lines[:_HEAD])[:_LONGEST]


def _own_reader(path: Path, head: str) -> Callable[[Path], TextTable] | None:
    """Reader of a file that is no table of text; None for any other."""
    if is_geopackage(head, path):
        return read_geopackage
    if path.suffix.lower() in ('.xlsx', '.xlsm'):
        return read_spreadsheet
    if path.suffix.lower() == '.zip':
        head = _head_in(path)
    return read_geojson if looks_like_geojson(head) or _has_records(head) else None


def _has_records(head: str) -> bool:
    """Whether the beginning of a file is JSON with the names of an inventory."""
    names = _NAME.findall(head) if head.lstrip()[:1] in ('{', '[') else []
    return bool(names) and not missing_columns(table_of_cells(names, [], ''))


def _is_inventory(head: str) -> bool:
    return lacking_columns(head) == []


def lacking_columns(head: str) -> list[str] | None:
    """Columns of an inventory that the beginning of a text file lacks; None if it is no table."""
    try:
        return missing_columns(PLAIN.read(head.splitlines()[:_HEAD], ''))
    except FormatError:
        return None
