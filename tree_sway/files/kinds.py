# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What a file is where another was expected: its kind, and what takes it.

`kinds.csv` has what each kind is called, what takes it, and the outermost keys of YAML that tell
it, those of a study first as it has trees too.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
import re

from tree_sway.errors import FormatError, TreeSwayError
from tree_sway.files.column_names import folded, motion_of
from tree_sway.files.layouts.known import looks_like_wind, table_of, ZIP_BEGINS
from tree_sway.files.text_file import read_head
from tree_sway.files.yaml_document import begins_with_key
from tree_sway.files.zipped import table_in
from tree_sway.tables import table_beside

_ROWS = 60
"""Lines at the beginning of a table that are looked at."""
_KINDS = {each['kind']: each for each in table_beside(__file__, 'kinds.csv')}


@contextmanager
def expected(path: Path, *kinds: str) -> Iterator[None]:
    """Say what a file is instead, if it cannot be read as one of some kinds but is of another."""
    try:
        yield
    except FormatError:
        found = kind_of(path)
        if found in kinds or not found:
            raise
        told = _KINDS[found]
        raise FormatError(
            f'{told["what"]}, not {_KINDS[kinds[0]]["what"]}',
            where=str(path),
            cure=told['cure'].format(path.name),
        ) from None


def kind_of(path: Path) -> str:
    """Return the kind of a file by its beginning; empty if nothing tells it."""
    with suppress(TreeSwayError):
        from tree_sway.files.scenes.stand_table import is_stand_table
        from tree_sway.files.trees.tree_formats import TREE_FORMATS
        from tree_sway.files.wind.wind_formats import WIND_FORMATS

        head = read_head(path)
        for kind, told in _KINDS.items():
            if any(begins_with_key(path, head, key) for key in (told['keys'] or '').split()):
                return kind
        if head.startswith('time [s],wind_x [m/s],'):
            return 'sway'
        if head.startswith(ZIP_BEGINS):
            lines = table_in(path, looks_like_wind)[1]
            if found := _kind_of_table('\n'.join(lines[:_ROWS])):
                return found
        if is_stand_table(head, path):
            return 'inventory'
        sure = (each for each in WIND_FORMATS if each.name not in ('toa5', 'sonic', 'csv'))
        if any(each.recognise(head) for each in sure):
            return 'wind'
        names = {each.name for each in TREE_FORMATS if each.recognise(head)} - {'treegraph'}
        return 'tree' if names else _kind_of_table(head)
    return ''


def _kind_of_table(head: str) -> str:
    """Return whether the columns of a table over time are a wind or a motion."""
    with suppress(FormatError):
        if re.match(r'\s*[{[](?![A-Za-z])', head):  # JSON, whose end may be missing
            return 'wind' if looks_like_wind(head) else ''
        table = table_of(head.splitlines()[:_ROWS], '')
        if not table.find_all('time'):
            return ''
        moved = {found[0] for found in map(motion_of, table.columns) if found and found[2]}
        is_wind = table.find_all('wind_speed') and table.find_all('wind_direction')
        if moved - {'displacement'} and not is_wind:  # as ux of a wind is one
            return 'motion'
        components = {folded(table.columns[index]) for index in table.find_all('wind_x')}
        if table.find_all('wind_speed') or components - {'x', 'east'}:
            return 'wind'
        return 'motion' if moved else ''
    return ''
