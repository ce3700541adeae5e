# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Read a record of wind and sway together, as ``tree-sway record`` writes it."""

from __future__ import annotations

from pathlib import Path

from tree_sway.errors import FormatError
from tree_sway.files import packaged_schema, path_of, read_lines, read_yaml
from tree_sway.files.motion import RecordedSensor, SHEET, TreeRecord


def is_tree_record(path: str | Path) -> bool:
    """Whether a path is the folder of a record, or its sheet."""
    return Path(path).name == SHEET or (Path(path) / SHEET).is_file()


def read_tree_record(path: str | Path) -> TreeRecord:
    """
    Read the sheet of a record.

    Raises
    ------
    FormatError
        No sheet, one that is not of this form, or that names a file outside of its folder.

    """
    given = path_of(path)
    folder = given.parent if given.name == SHEET else given
    sheet = folder / SHEET
    document = read_yaml(
        '\n'.join(read_lines(sheet)), str(sheet), packaged_schema('record_schema.json')
    )
    values = document.values
    wind = values['wind']
    sway = values.get('sway', {})
    sensors = tuple(RecordedSensor(**each) for each in values.get('motion', ()))
    record = TreeRecord(
        folder,
        tree=values['tree'],
        wind=wind['file'],
        motion=sensors,
        leaves=values.get('leaves', 'auto'),
        wind_source=wind.get('source', ''),
        sway=sway.get('file', ''),
        branch=sway.get('branch', ''),
        notes=values.get('notes', ''),
    )
    names = [record.tree, record.wind, record.sway, *(each.file for each in sensors)]
    for name in names:
        if Path(name).name != name:
            cure = 'give the name of a file in the folder of the sheet'
            raise FormatError(f"'{name}' is no name of a file", where=str(sheet), cure=cure)
    return record
