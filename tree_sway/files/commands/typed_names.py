# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Names of trees and winds as they are typed: what is one of another kind is told at once."""

from __future__ import annotations

from pathlib import Path
import re

from tree_sway.core.species import species_keys
from tree_sway.errors import FormatError
from tree_sway.files.paths import is_file
from tree_sway.files.wind import EXAMPLES

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
    """
    Return the name of a recorded wind.

    A `FormatError` is raised for a tree, a live source or a folder without a record.
    """
    path = Path(text)
    if path.is_dir():
        names = {name for each in path.iterdir() for name in (each.name, each.suffix)}
        if names.isdisjoint(_OF_A_RECORD):
            what = 'a folder without metadata.yaml, .db3 or .mcap, so no bag of ROS 2'
            cure = 'give a folder that `ros2 bag record` wrote, a file of wind, or canopy'
            raise FormatError(what, where=text, cure=cure)
    elif text in species_keys() and not is_file(path):
        raise FormatError(f"'{text}' is a tree, not a wind", cure=f'name it first, {_CURE}')
    elif re.match(r'[\w-]{2,}:', text) and not is_file(path):
        raise FormatError(f"'{text}' is no file", cure='give a live source by --sensor')
    return text


def source_name(text: str) -> str:
    """Return the name of a live source; raise a `FormatError` for a recorded wind."""
    if text in EXAMPLES or is_file(Path(text)):
        raise FormatError(f"'{text}' is a recording, no live source", cure='give it by --wind')
    return text
