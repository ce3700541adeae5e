# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A record of wind and sway together: a folder with a sheet and its tables.

The sheet ``record.yaml`` names the file of the tree, the table of the wind, and each motion sensor
with its table and place. Times of all tables are dates of one clock. Where a camera measured the
displacement of a tip, the sheet names its table too.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import yaml

from tree_sway.files.atomic_file import write_text_whole

SHEET = 'record.yaml'


class RecordedSensor(NamedTuple):
    """Table of a motion sensor, its place as `place_on` takes it, and what measured it."""

    file: str
    at: str
    source: str = ''


class TreeRecord(NamedTuple):
    """
    The sheet of a record; files are names in its folder.

    Parameters
    ----------
    folder
        The folder.
    tree, wind
        File of the tree, and table of the wind.
    motion
        The motion sensors.
    leaves
        ``on``, ``off`` or ``auto``.
    wind_source
        Source of the wind.
    sway, branch
        Table of the displacement of a tip, and its branch; empty without one.
    notes
        Anything else.

    """

    folder: Path
    tree: str
    wind: str
    motion: Sequence[RecordedSensor] = ()
    leaves: str = 'auto'
    wind_source: str = ''
    sway: str = ''
    branch: str = ''
    notes: str = ''

    def path(self, name: str) -> str:
        """Return the path of a file of the record."""
        return str(self.folder / name)


def write_tree_record(record: TreeRecord) -> None:
    """Write the sheet of a record into its folder."""
    values: dict[str, object] = {
        'tree_sway_record': 1,
        'tree': record.tree,
        'leaves': record.leaves,
        'wind': {'file': record.wind, 'source': record.wind_source},
        'motion': [each._asdict() for each in record.motion],
        'program': 'tree_sway_ros',
    }
    if record.sway:
        values['sway'] = {'file': record.sway, 'branch': record.branch}
    values['notes'] = record.notes
    text = yaml.safe_dump(values, sort_keys=False, allow_unicode=True)
    write_text_whole(record.folder / SHEET, text)
