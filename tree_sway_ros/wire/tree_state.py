# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The state of a tree as `sensor_msgs/JointState`: a name per coordinate; wind and flags first.

With the ``state`` of `tree_description` all poses follow from it; a bag of it can be plotted by
other programs and takes some 50 MB per hour.
"""

from __future__ import annotations

import base64
from typing import Any

import numpy as np
from sensor_msgs.msg import JointState

from tree_sway.core.arrays import Floats
from tree_sway.errors import FormatError
from tree_sway.stream.protocol import PAUSED, WIND_LOST
from tree_sway_ros.wire.cdr import block_mark, CdrTemplate, mark_stamp

WIND_NAMES = ('wind/x', 'wind/y', 'wind/z')
"""Wind at the anemometer, blowing to, in [m/s]; the first numbers of a state."""

FLAGS_NAME = 'flags'
"""Name of the sum of the flags of `protocol`, after the wind; states of old bags have none."""


def state_template(coordinate_names: list[str], frame_id: str) -> CdrTemplate:
    """Make the bytes of a state: its block has wind [m/s], flags and coordinates, (4 + m,)."""
    message = JointState()
    message.header.frame_id = frame_id
    mark_stamp(message.header.stamp)
    message.name = [*WIND_NAMES, FLAGS_NAME, *coordinate_names]
    message.position = [block_mark(), *[0.0] * (len(message.name) - 1)]
    # Velocities and efforts: two empty lists.
    return CdrTemplate(message, 1, [(len(message.name),)], tail=8)


def read_state(message: Any) -> tuple[Floats, Floats, int]:
    """Wind (3,) [m/s], coordinates (m,), flags of a state; a `FormatError` for wrong names."""
    if tuple(message.name[:3]) != WIND_NAMES or len(message.name) != len(message.position):
        raise FormatError(
            f'{len(message.position)} positions of {len(message.name)} names',
            where='tree_state',
            cure=f'send {", ".join(WIND_NAMES)} and then the coordinates',
        )
    values = np.array(message.position, dtype=np.float64)
    if not np.isfinite(values).all():
        raise FormatError('a state that is not finite', where='tree_state')
    if tuple(message.name[3:4]) != (FLAGS_NAME,):
        return values[:3], values[3:], 0
    return values[:3], values[4:], int(values[3]) & (PAUSED | WIND_LOST)


def state_entry(description: bytes) -> dict[str, str]:
    """Return the entry of `tree_description` for the state, by doc/streaming.md."""
    return {'format': 'doc/streaming.md', 'base64': base64.b64encode(description).decode('ascii')}


def read_state_entry(content: Any) -> bytes | None:
    """
    Binary description in a `tree_description`; None where it has no state yet.

    A `FormatError` is raised for a different form than that of `state_entry`.
    """
    entry = content.get('state') if isinstance(content, dict) else None
    if entry is None:
        return None
    try:
        return base64.b64decode(entry['base64'], validate=True)
    except (ValueError, KeyError, TypeError) as error:
        raise FormatError(
            f'a state that is not base64 ({error})', where='tree_description'
        ) from None
