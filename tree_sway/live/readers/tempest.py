# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Messages of WeatherFlow's Tempest, of which ``rapid_wind`` is read.

It has the wind every three seconds; the mean over a minute (``obs_st``) is not read beside it
(Tempest API, "UDP Broadcast", version 171).
"""

from __future__ import annotations

from typing import Any

from tree_sway.files import object_of
from tree_sway.files.wind import reading_of, Readings, tempest_values

KIND = 'rapid_wind'


def is_tempest(document: Any) -> bool:
    """Whether a document is a message of a Tempest's hub."""
    return object_of(document).keys() >= {'type', 'hub_sn'}


def read_tempest(document: Any) -> Readings:
    """Read the wind of an instant; nothing of any other message."""
    found = tempest_values(document)
    if not found or document['type'] != KIND:
        return ()
    speed, direction = (str(found[0][name]) for name in ('wind_speed', 'wind_direction'))
    sender = str(document.get('serial_number', ''))
    return [reading_of(KIND, speed, direction, interval=0.0, sender=sender)]
