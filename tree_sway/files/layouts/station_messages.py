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


def tempest_values(message: Any) -> dict[str, Any] | None:
    """Return the time and wind of a Tempest's message by name; None for any other message."""
    kind = message.get('type') if isinstance(message, dict) else None
    places = _TYPES.get(kind) if isinstance(kind, str) else None
    if places is None:
        return None
    cells = message.get(places['list'])
    if isinstance(cells, list) and cells and isinstance(cells[0], list):
        cells = cells[0]
    found = cells if isinstance(cells, list) else []
    return {name: found[places[name]] if places[name] < len(found) else None for name in _VALUES}


def signalk_values(message: Any) -> Iterator[PathValue]:
    """Yield the values of a delta; nothing of any other message."""
    updates = message.get('updates') if isinstance(message, dict) else None
    for update in updates if isinstance(updates, list) else ():
        values = update.get('values') if isinstance(update, dict) else None
        for each in values if isinstance(values, list) else ():
            if isinstance(each, dict) and isinstance(each.get('path'), str):
                source, time = (str(update.get(name, '')) for name in ('$source', 'timestamp'))
                yield PathValue(each['path'], each.get('value'), source, time)
