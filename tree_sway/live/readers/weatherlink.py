# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Conditions of Davis WeatherLink Live, as it answers and as it broadcasts (port 22222).

Speeds are in miles per hour; the last one, ``wind_speed_last``, is new every 2.5 s (Davis,
"WeatherLink Live Local API").
"""

from __future__ import annotations

from typing import Any

from tree_sway.files import list_of, object_of
from tree_sway.files.wind import Readings
from tree_sway.live.readers.json_path import parse_json
from tree_sway.live.readers.named_values import WindNames
from tree_sway.live.transports.transport import Message

_KIND = 'WeatherLink Live'
_STATION = 1
"""Type of the record of a station with an anemometer."""
_NAMES = WindNames(
    'wind_speed_last', 'wind_dir_last', 'wind_speed_hi_last_2_min', unit='mph', interval=0.0
)


def conditions_of(document: Any) -> list[Any]:
    """Return the records of a document; none of any other."""
    inside = object_of(object_of(document).get('data', document))
    return list_of(inside.get('conditions'))


def read_weatherlink(document: Any) -> Readings:
    """Read the conditions of the first station with a wind."""
    for each in conditions_of(document):
        if isinstance(each, dict) and each.get('data_structure_type') == _STATION:
            if found := _NAMES.read(each, _KIND):
                return found
    return ()


def read_conditions(message: Message) -> Readings:
    """Read the answer of its local interface."""
    return read_weatherlink(parse_json(message.data))
