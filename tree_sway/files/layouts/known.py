# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Layouts of tables, in the order in which they are tried; a new one is a line here."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from tree_sway.errors import FormatError, inside
from tree_sway.files.foreign_file import foreign_file
from tree_sway.files.layouts.csiro import CSIRO
from tree_sway.files.layouts.jma import JMA
from tree_sway.files.layouts.json_tables import JSON
from tree_sway.files.layouts.layout import Layout
from tree_sway.files.layouts.lines import LINES
from tree_sway.files.layouts.long import widened
from tree_sway.files.layouts.monitor import MONITOR
from tree_sway.files.layouts.plain import PLAIN
from tree_sway.files.layouts.weatherlink_text import WEATHERLINK_TEXT
from tree_sway.files.table_file import TextTable

_LAYOUTS = (
    *(JSON, WEATHERLINK_TEXT, CSIRO, JMA, MONITOR),
    *LINES,
    PLAIN,
)

_HEAD = 200
ZIP_BEGINS = 'PK\3\4'


def _layout_of(lines: Sequence[str]) -> Layout | None:
    """Return the layout of a table by its first lines; None if it is none."""
    return next((layout for layout in _LAYOUTS if layout.recognise(lines or [''])), None)


def table_of(lines: list[str], source: str) -> TextTable:
    """Return the table of a file's lines; a `FormatError` if they are none."""
    with inside(source):
        what, cure = foreign_file(Path(source), '\n'.join(lines[:3]) or ' ')
        if what:
            raise FormatError(what, cure=cure)
        if '---' in lines:  # below each message, as ROS echoes them
            lines = [' '.join(each.split()) for each in '\n'.join(lines).split('\n---')]
        return widened((_layout_of(lines[:_HEAD]) or PLAIN).read(lines, source))


def looks_like_wind(head: str) -> bool:
    """Whether the beginning of a file is that of a table of wind, or of a zip."""
    lines = head.replace('\r\n', '\n').replace('\r', '\n').split('\n')
    found = _layout_of(lines[:_HEAD])
    if found is JSON:
        return any(word in head.lower() for word in ('wind', '"wd', '_wd', '"obs'))
    return found is not None or head.startswith(ZIP_BEGINS)
