# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Names of trees and winds as they are typed: the other of the two is told before any work."""

from __future__ import annotations

from pathlib import Path

from tree_sway.core.species import species_keys
from tree_sway.errors import FormatError
from tree_sway.files.paths import is_file
from tree_sway.files.wind import EXAMPLES
from tree_sway.growth import BUILTIN_TREES

_CURE = 'as in tree-sway plot goldcrest --wind canopy -o sway.png'
_OF_A_RECORD = ('metadata.yaml', '.db3', '.mcap', 'record.yaml')


def tree_name(text: str) -> str:
    """Return the name of a tree; raise a `FormatError` for a built-in wind or an empty file."""
    path = Path(text)
    if is_file(path):
        if not path.stat().st_size:
            raise FormatError('an empty file', where=text)
    elif text in EXAMPLES:
        raise FormatError(f"'{text}' is a wind, not a tree", cure=f'give it by --wind, {_CURE}')
    return text


def wind_name(text: str) -> str:
    """Return the name of a wind; raise a `FormatError` for a tree or a folder without a record."""
    path = Path(text)
    if path.is_dir():
        names = {name for each in path.iterdir() for name in (each.name, each.suffix)}
        if names.isdisjoint(_OF_A_RECORD):
            what = 'a folder without metadata.yaml, .db3 or .mcap, so no bag of ROS 2'
            cure = 'give a folder that `ros2 bag record` wrote, a file of wind, or canopy'
            raise FormatError(what, where=text, cure=cure)
    elif text in (*BUILTIN_TREES, *species_keys()) and not is_file(path):
        raise FormatError(f"'{text}' is a tree, not a wind", cure=f'name it first, {_CURE}')
    return text
