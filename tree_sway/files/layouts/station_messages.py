# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Messages in JSON whose values have no names: Tempest's lists, and the paths of Signal K.

`station_messages.csv` has the places of the values in the list of each type of Tempest, in m/s and
degrees. A delta of Signal K has paths and values in SI; angles are in rad.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

from tree_sway.files.json_values import list_of, object_of, Record
from tree_sway.tables import table_beside

_TYPES = {each['type']: each for each in table_beside(__file__, 'station_messages.csv')}
_VALUES = ('time', 'wind_speed', 'wind_direction', 'gust')
SIGNALK_WIND = 'environment.wind.'
SIGNALK_PAIRS = (
    ('speedOverGround', 'directionTrue', False),
    ('speedTrue', 'directionTrue', False),
    ('speedApparent', 'angleApparent', True),
)
"""Speeds and angles, best first, and whether the angle counts from the bow."""


class PathValue(NamedTuple):
    """A value of Signal K, its source and its time as text."""

    path: str
    value: Any
    source: str
    time: str


def tempest_values(message: Any) -> list[Record]:
    """Return the times and winds of a Tempest's message by name; none of any other message."""
    kind = object_of(message).get('type')
    places = _TYPES.get(kind) if isinstance(kind, str) else None
    if places is None:
        return []
    cells = list_of(message.get(places['list']))
    rows = map(list_of, cells) if cells and isinstance(cells[0], list) else [cells]
    return [{name: (row + [None] * 20)[places[name]] for name in _VALUES} for row in rows]


def signalk_values(message: Any) -> Iterator[PathValue]:
    """Yield the values of a delta; nothing of any other message."""
    for update in map(object_of, list_of(object_of(message).get('updates'))):
        for each in map(object_of, list_of(update.get('values'))):
            if isinstance(each.get('path'), str):
                source, time = (str(update.get(name, '')) for name in ('$source', 'timestamp'))
                yield PathValue(each['path'], each.get('value'), source, time)
