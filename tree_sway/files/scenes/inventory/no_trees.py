# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What cells say in place of a species or of a living tree: dead, a stump, an empty place.

``no_trees.csv`` has the words of public inventories in a dozen languages, a star for any letters:
the values of Lyon, Vienna, Camden, Arganda del Rey and the sources of OpenTrees, of i-Tree and of
BS 5837:2012. Those of other languages are translations of these.
"""

from __future__ import annotations

from collections.abc import Collection
from functools import cache
import re

from tree_sway.files.column_names import folded
from tree_sway.tables import table_beside

UNKNOWN = 'unknown'
GROUP = 'of a group or hedge'
_WORD = re.compile(r'[^\W\d_]+')
_BETWEEN = re.compile(r'[,;:()\[\]|]|\s[-–]\s|(?<=\w\w)/')


def _plain(text: str) -> str:
    """Words of a text, folded; a star becomes the expression for any text."""
    return '.*'.join(' '.join(map(folded, _WORD.findall(part))) for part in text.split('*'))


*_SAYS, (_, _LEFT_OUT) = (
    (row['says'], re.compile('|'.join(map(_plain, row['words'].split(', ')))))
    for row in table_beside(__file__, 'no_trees.csv')
)


@cache
def said_of_none(text: str) -> str:
    """
    Return why a cell is no living tree, or `UNKNOWN`; empty for any other text.

    One part of it says that there is none; all have to say that its species is not known.
    """
    if '%' in text or not _WORD.search(text):
        return ''
    parts = [
        ' '.join(word for word in _plain(part).split() if not _LEFT_OUT.fullmatch(word))
        for part in _BETWEEN.split(text.replace('(s)', 's'))
    ]
    said = [
        next((says for says, words in _SAYS if words.fullmatch(part)), '')
        for part in filter(None, parts)
    ]
    none = (says for says in said if says not in ('', UNKNOWN))
    return next(none, UNKNOWN if all(said) else '')


_CODES = {row['column']: row for row in table_beside(__file__, 'state_codes.csv')}


def gone_by_codes(column: str, quantity: str, texts: Collection[str]) -> frozenset[str]:
    """
    Return the cells of a column that are codes of dead trees, or of those that are gone.

    They are so in a column of living or of dead trees or stumps, maybe of the date of their end,
    and where all cells are codes of a list, and some of living trees: that of ForestGEO
    (forestgeo/fgeo.validate), with the L of plots that have L and D, of FIA (user guide), or of
    FVS (Essential FVS: history).
    """
    codes = _CODES.get(folded(column)) or _CODES.get(f'any {quantity}')
    if codes is None or not all(re.fullmatch(codes['all'], text) for text in texts if text):
        return frozenset()
    is_of_living = any(re.fullmatch(codes['living'], text) for text in texts)
    return frozenset(text for text in texts if is_of_living and re.fullmatch(codes['gone'], text))
