# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Numbers as people write them in inventories: ``12 m``, ``6-10 m``, ``30' - 40'``, ``> 35``."""

from __future__ import annotations

import re

from tree_sway.files.column_names import unit_factor
from tree_sway.files.text_file import finite

_NUMBER = re.compile(r'(?<![\w.])\d+(?:[.,]\d+)?')
_UNIT = re.compile(r"[\d\s]([a-zA-Z]+\.?|'|\")\s*$")
_WORDS = ('tot', 'to', 'bis', 'à', 'a', 'und', 'ca', 'bzw')


def cell_number(text: str) -> tuple[float, str] | None:
    """
    Return the number of a cell and its unit, the middle of a range; None if it has none.

    The unit is empty unless it is one of lengths. A cell with other words is no number.
    """
    plain = finite(text)
    if plain is not None:
        return plain, ''
    numbers = [float(each.replace(',', '.')) for each in _NUMBER.findall(text)]
    if not 1 <= len(numbers) <= 2 or (text.strip()[:1] in '-−' and len(numbers) == 1):
        return None
    found = _UNIT.search(text)
    unit = found[1].rstrip('.') if found and unit_factor('length', found[1].rstrip('.')) else ''
    words = re.findall(r'[^\W\d_]+', text.lower())
    if any(word not in _WORDS and unit_factor('length', word) is None for word in words):
        return None
    return sum(numbers) / len(numbers), unit
