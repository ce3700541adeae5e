# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Numbers as people write them in inventories: ``12 m``, ``6-10 m``, ``30' - 40'``, ``> 35``."""

from __future__ import annotations

import math
import re

from tree_sway.files.column_names import unit_factor
from tree_sway.files.text_file import finite

_NUMBER = re.compile(r'(?<![\w.])\d+(?:[.,]\d+)?')
_GROUPED = re.compile(
    r'(?<![\d.,])(?:(\d{1,3}(?:\.\d{3})+),(\d+)|(\d{1,3}(?:[,’\']\d{3})+)\.(\d+)|'
    r'(\d{1,3}(?:[.,]\d{3}){2,}))(?![\d.,])'
)
"""A number of thousands, ``1.234,5``, ``1,234.5`` or ``1.234.567``."""
_UNIT = re.compile(r"[\d\s]([a-zA-Z]+|'|\")\.?\s*$")
_AND = r'[+;&|]|,\s|\s(?:and|und|et|y|en|e|och|og)\s'
_SEVERAL = re.compile(rf'\d(?:\D{{0,4}}?(?:{_AND})|\s)\s*\d')
_TIMES = re.compile(r'(?<![\d.,])([2-9])\s*[x×*@]\s*(\d+(?:[.,]\d+)?)')
"""A number of stems of one size, as in ``2 x 35`` or ``3 @ 150``."""
_BETWEEN = re.compile(r'[^\W\d_]+|[-–—~/]|\.\.')
"""What stands between the two numbers of a range."""
_CLASS = re.compile(r'^\s*(?:[a-z]\.\s|\w\))(?=[<>=\s]*\d)')
"""Letter or number of a class before its range, as in ``c. 9 tot 12 m.`` and ``2) 10 - 16m``."""
_AND_MORE = re.compile(
    r'\s+(?:en|y|et|und|and|or)\s+(?:hoger|meer|groter|más|plus|höher|mehr|higher|over|above|more|'
    r'taller|larger)\.?\s*$',
    re.IGNORECASE,
)
"""End of the highest class, as in ``24 m. en hoger``: its number is the least of the class."""
_SPLIT = re.compile(rf'(?:{_AND}|/|(?<=\d)\s)(?=\s*\d)')
_SLASHES = re.compile(r'\s*(\d+(?:[.,]\d+)?)\s*/\s*(\d+(?:[.,]\d+)?)\s*(/.*)?')
_WORDS = 'tot to bis à a und ca bzw'.split()


def cell_number(text: str) -> tuple[float, str] | None:
    """
    Return the number of a cell and its unit, the middle of a range; None if it has none.

    The unit is empty unless it is one of lengths. A cell with other words is no number.
    """
    plain = finite(_GROUPED.sub(_without_groups, text))
    if plain is not None:
        return plain, ''
    if _SEVERAL.search(text):
        return None
    text = _GROUPED.sub(_without_groups, _AND_MORE.sub('', _CLASS.sub('', text)))
    numbers = [float(each.replace(',', '.')) for each in _NUMBER.findall(text)]
    if len(numbers) == 2 and not _BETWEEN.search(_NUMBER.split(text)[1]):
        return None
    if not 1 <= len(numbers) <= 2 or (text.strip()[:1] in '-−' and len(numbers) == 1):
        return None
    found = _UNIT.search(text)
    unit = found[1] if found and unit_factor('length', found[1]) else ''
    words = re.findall(r'[^\W\d_]+', text.lower())
    if any(word not in _WORDS and unit_factor('length', word) is None for word in words):
        return None
    return sum(numbers) / len(numbers), unit


def _without_groups(found: re.Match[str]) -> str:
    whole = re.sub(r'\D', '', found[1] or found[3] or found[5])
    return f'{whole}.{found[2] or found[4] or 0}'


def stems_number(text: str) -> tuple[float, str] | None:
    """
    Return the number of a cell of one stem or several, as `cell_number`.

    Stems such as ``320, 280``, ``30+25`` or ``20/18/15`` are one of the sum of their sections;
    ``18/20`` is a class of nurseries, a range.
    """
    text = _TIMES.sub(lambda found: '+'.join([found[2]] * int(found[1])), text)
    slashes = _SLASHES.match(text)
    is_class = slashes is None or (
        slashes[3] is None
        and float(slashes[1].replace(',', '.')) < float(slashes[2].replace(',', '.'))
    )
    if is_class and not _SEVERAL.search(text):
        return cell_number(text)
    found = [cell_number(part) for part in _SPLIT.split(text)]
    stems = [each for each in found if each is not None]
    if len(stems) != len(found):
        return None
    unit = next((unit for _, unit in stems if unit), '')
    return math.sqrt(sum(value**2 for value, _ in stems)), unit
