# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Path of a value in JSON, as ``data.conditions[0].wind_speed_last``, and a value as a time."""

from __future__ import annotations

from functools import lru_cache
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


@lru_cache
def steps_of(path: str) -> tuple[str | int, ...]:
    """
    Return the names and places of a path, which ``$.`` may begin, for `value_at`.

    Raises a `ParameterError` for text that is no path.
    """
    if not _PATH.fullmatch(path):
        raise ParameterError(f"'{path}' is no path", cure='write it as data.conditions[0].speed')
    named = _STEP.findall(path.removeprefix('$').removeprefix('.'))
    return tuple(int(index) if index else name for index, name in named)


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
