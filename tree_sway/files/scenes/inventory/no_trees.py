# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What a cell says in place of a species or of a living tree: dead, a stump, an empty place.

``no_trees.csv`` has the words of public inventories in a dozen languages, a star for any letters:
the values of Lyon, Vienna, Camden, Arganda del Rey and the sources of OpenTrees, of i-Tree and of
BS 5837:2012, and what they are in other languages.
"""

from __future__ import annotations

from functools import cache
import re

from tree_sway.files.column_names import folded
from tree_sway.tables import table_beside

UNKNOWN = 'unknown'
GROUP = 'of a group or hedge'
_WORD = re.compile(r'[^\W\d_]+')
_BETWEEN = re.compile(r'[,;:()\[\]|]|\s[-–]\s|(?<=\w\w)/')


def _plain(text: str) -> str:
    return ' '.join(map(folded, _WORD.findall(text)))


_WORDS = {
    (row['says'], row['language']): [
        '.*'.join(map(_plain, word.split('*'))) for word in row['words'].split(', ')
    ]
    for row in table_beside(__file__, 'no_trees.csv')
}
_LEFT_OUT = frozenset(_WORDS.pop(('left out of these', 'all')))
_SAYS = [(says, re.compile('|'.join(words))) for (says, _), words in _WORDS.items()]


@cache
def said_of_none(text: str) -> str:
    """
    Return why a cell is no living tree, or `UNKNOWN`; empty for any other text.

    One part of it says that there is none; all have to say that its species is not known.
    """
    if '%' in text or not _WORD.search(text):
        return ''
    parts = [
        ' '.join(word for word in _plain(part).split() if word not in _LEFT_OUT)
        for part in _BETWEEN.split(text.replace('(s)', 's'))
    ]
    said = {
        part: next((says for says, words in _SAYS if words.fullmatch(part)), '')
        for part in filter(None, parts)
    }
    none = [says for says in said.values() if says not in ('', UNKNOWN)]
    return none[0] if none else UNKNOWN if all(said.values()) else ''
