# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What the reader of a wind record is told in words: ``rate=20 sentence=MWV columns=u,v,w``."""

from __future__ import annotations

from typing import Any

from tree_sway_ros.errors import ParameterError


def reader_options(text: str) -> dict[str, Any]:
    """
    Read options for `read_wind`.

    Parameters
    ----------
    text
        ``NAME=VALUE`` parted by spaces; a number as such, words parted by commas as a tuple.

    Raises
    ------
    ParameterError
        If a word is none.

    """
    options: dict[str, Any] = {}
    for word in text.split():
        name, equals, value = word.partition("=")
        if not (name and equals and value):
            raise ParameterError(
                f"'{word}' is no option of a reader", cure="write NAME=VALUE, parted by spaces"
            )
        options[name] = _value(value)
    return options


def _value(text: str) -> Any:
    if "," in text:
        return tuple(part.strip() for part in text.split(","))
    try:
        return float(text)
    except ValueError:
        return text
