# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A layout of a table of wind: how it is recognised, and how it is read."""

from __future__ import annotations

from collections.abc import Callable, Sequence
import re
from typing import NamedTuple

from tree_sway.files.table_file import TextTable


class Layout(NamedTuple):
    """
    A layout of a table of wind.

    ``recognise`` gets the first lines of a file, ``read`` all of them and the name of the file.
    """

    recognise: Callable[[Sequence[str]], bool]
    read: Callable[[list[str], str], TextTable]


def begins(form: str, flags: int = 0) -> Callable[[Sequence[str]], bool]:
    """Recognise a layout by a regular expression of its first lines."""
    compiled = re.compile(form, flags)
    return lambda lines: compiled.match('\n'.join(lines)) is not None
