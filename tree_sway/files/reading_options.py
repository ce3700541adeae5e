# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Options of the reader of a file as words: ``rate=20 sentence=MWV columns=u,v,w``."""

from __future__ import annotations

from collections.abc import Iterable

from tree_sway.errors import ParameterError

Option = bool | float | str | tuple[str, ...]


def reader_options(words: Iterable[str]) -> dict[str, Option]:
    """
    Read options for `read_wind`, `read_trees` and `open_tree` from words ``NAME=VALUE``.

    Numbers, true, false, yes and no are converted, words separated by commas are a tuple. Raises a
    `ParameterError` for a word without a value.
    """
    options: dict[str, Option] = {}
    for word in words:
        name, _, value = (part.strip() for part in word.partition('='))
        if not (name and value):
            raise ParameterError(f"'{word}' is no option of a reader", cure='write NAME=VALUE')
        options[name.replace('-', '_')] = _value(value)
    return options


def _value(text: str) -> Option:
    if text in ('true', 'yes', 'false', 'no'):
        return text in ('true', 'yes')
    if ',' in text:
        return tuple(part.strip() for part in text.split(','))
    try:
        return float(text)
    except ValueError:
        return text
