# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The state of a tree as `std_msgs/Float64MultiArray`: its modal coordinates, after their time.

The array that the layout describes is the coordinates: one dimension, ``coordinates``, which
begins at ``data_offset``. In front of it are the numbers of `HEAD`, as the message has no header.
With the ``state`` of `tree_description` all poses follow from it; a bag of it takes some 50 MB
per hour.
"""

from __future__ import annotations

import base64
from typing import Any, NamedTuple

import numpy as np
from std_msgs.msg import Float64MultiArray, MultiArrayDimension

from tree_sway.core.arrays import Floats
from tree_sway.errors import FormatError
from tree_sway.stream import PAUSED, WIND_LOST
from tree_sway_ros.wire.cdr import block_mark, CdrTemplate

HEAD = ('stamp/sec', 'stamp/nanosec', 'wind/x', 'wind/y', 'wind/z', 'flags')
"""
Numbers in front of the coordinates: the time, in seconds and the nanoseconds of the last one, as
each of the two is exact in a float64; the wind at the anemometer, blowing to, in [m/s]; the sum of
the flags of `protocol`.

"""

_LABEL = 'coordinates'
"""Label of the dimension."""

_SECOND = 1_000_000_000
_LATEST = float(2**31)
"""End of ROS time [s]."""


class ModalState(NamedTuple):
    """A state: time [ns], wind (3,) [m/s], sum of flags, coordinates (m,)."""

    stamp: int
    wind: Floats
    flags: int
    coordinates: Floats


class StateWriter:
    """Writer of states of ``count`` coordinates, as bytes."""

    def __init__(self, count: int) -> None:
        message = Float64MultiArray()
        dimension = MultiArrayDimension(label=_LABEL, size=count, stride=count)
        message.layout.dim = [dimension]
        message.layout.data_offset = len(HEAD)
        size = len(HEAD) + count
        message.data = [block_mark(), *[0.0] * (size - 1)]
        self.count = count
        self._template = CdrTemplate(message, 0, [(size,)], tail=0)

    def to_bytes(self, state: ModalState) -> bytes:
        """Write a state as a ``std_msgs/Float64MultiArray``."""
        numbers = self._template.blocks[0]
        numbers[0], numbers[1] = divmod(state.stamp, _SECOND)
        numbers[2:5] = state.wind
        numbers[5] = state.flags
        numbers[len(HEAD) :] = state.coordinates
        return self._template.to_bytes()


def read_state(message: Any) -> ModalState:
    """Read a state; a `FormatError` for a different layout, or numbers that cannot be."""
    layout = message.layout
    numbers = np.array(message.data, dtype=np.float64)
    labels = [each.label for each in layout.dim]
    if labels != [_LABEL] or layout.data_offset != len(HEAD):
        raise FormatError(
            f'dimensions {labels} from number {layout.data_offset} on',
            where='tree_state',
            cure=f"send {', '.join(HEAD)} and then one dimension, '{_LABEL}'",
        )
    if len(numbers) != len(HEAD) + layout.dim[0].size:
        what = f'{len(numbers)} numbers for {layout.dim[0].size} coordinates'
        raise FormatError(what, where='tree_state', cure=f'send {len(HEAD)} more')
    if not np.isfinite(numbers).all():
        raise FormatError('a state that is not finite', where='tree_state')
    seconds, nanoseconds = numbers[:2]
    if not (0.0 <= seconds < _LATEST and 0.0 <= nanoseconds < _SECOND):
        raise FormatError(f'the time {seconds:g} s {nanoseconds:g} ns', where='tree_state')
    return ModalState(
        stamp=int(seconds) * _SECOND + int(nanoseconds),
        wind=numbers[2:5],
        flags=int(numbers[5]) & (PAUSED | WIND_LOST),
        coordinates=numbers[len(HEAD) :],
    )


def state_entry(description: bytes, coordinate_names: list[str]) -> dict[str, Any]:
    """Return the entry of `tree_description` for the state, by doc/streaming.md."""
    return {
        'format': 'doc/streaming.md',
        'base64': base64.b64encode(description).decode('ascii'),
        'names': coordinate_names,
    }


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
