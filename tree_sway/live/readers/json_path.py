# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Path of a value in JSON, as ``data.conditions[0].wind_speed_last``, and a value as a time."""

from __future__ import annotations

import json
import math
import re
from typing import Any

from tree_sway.errors import ParameterError
from tree_sway.files import dates
from tree_sway.files.wind import number

_STEP = re.compile(r'\[(\d+)\]|([^.\[\]]+)')
_PATH = re.compile(r'(\$\.?)?([^.\[\]]+|\[\d+\])((\.[^.\[\]]+)|(\[\d+\]))*')

_LONGEST = 40
"""Length of the longest text that may be a date."""


class JsonPath:
    """
    A path of names and of indices in brackets; ``$.`` may begin it.

    Raises
    ------
    ParameterError
        Text that is no path.

    """

    def __init__(self, text: str) -> None:
        if not _PATH.fullmatch(text):
            raise ParameterError(
                f"'{text}' is no path", cure='write it as data.conditions[0].speed'
            )
        self.text = text
        self._steps: list[str | int] = [
            int(index) if index else name
            for index, name in _STEP.findall(text.removeprefix('$').removeprefix('.'))
        ]

    def find(self, document: Any) -> Any:
        """Return the value, None where there is none."""
        return value_at(document, *self._steps)


def value_at(document: Any, *steps: str | int) -> Any:
    """Return the value at names and places within a document; None where there is none."""
    for step in steps:
        is_inside = isinstance(document, list if isinstance(step, int) else dict)
        try:
            document = document[step] if is_inside else None
        except LookupError:
            return None
    return document


def parse_json(data: bytes) -> Any:
    """Return a document; None for any other text, as for JSON's own null."""
    try:
        return json.loads(data)
    except (ValueError, RecursionError):
        return None


def time_of(value: Any) -> float | None:
    """Return a number of any unit, or the seconds of a date since 1970; None for any other."""
    found = number(value)
    if found is None and isinstance(value, str):
        times = dates([value[:_LONGEST]])
        found = times.epoch if math.isfinite(times.seconds[0]) else None
    return found
