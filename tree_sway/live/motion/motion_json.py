# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Motion in JSON: one object per sample, or a list of them.

``{"t": 12.34, "ax": 0.1, "ay": -0.2, "az": 9.8, "gx": 0.01, "gy": 0, "gz": 0}``, with any names
that a table of motion may have, or three axes together: ``"acceleration": [0.1, -0.2, 9.8]``,
``"linear_acceleration": {"x": 0.1, "y": -0.2, "z": 9.8}``. An orientation is ``qx``, ``qy``,
``qz``, ``qw``, or four together. A value that is no number is kept as not a number, so that the
sensor counts its refusal.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from itertools import islice
import math
from typing import Any

from tree_sway.files import motion_of, rank_of
from tree_sway.files.motion import AXES, flat
from tree_sway.files.wind import number, Refusal
from tree_sway.live.motion.motion_reading import MotionReading
from tree_sway.live.readers.json_path import parse_json, time_of
from tree_sway.live.transports.transport import Message

EXPECTS = (
    'JSON with a time and acceleration or angular rate: '
    '{"t": 1.25, "ax": 0.1, "ay": 0, "az": 9.8, "gx": 0, "gy": 0, "gz": 0}'
)
_KIND = 'JSON'
_MOST = 500
"""Largest number of samples in one message."""
_LONGEST = 40
_MOST_NAMES = 256


def read_motion_json(message: Message) -> Sequence[MotionReading | Refusal]:
    """Read a message; nothing for one without motion."""
    document = parse_json(message.data)
    samples = document if isinstance(document, list) else [document]
    if len(samples) > _MOST:
        return [Refusal(_KIND, f'more than {_MOST} samples in a message')]
    found = [_sample(each) for each in samples if isinstance(each, Mapping)]
    return [each for each in found if each is not None]


def _sample(document: Mapping[str, Any]) -> MotionReading | Refusal | None:
    """Return the sample of an object; None without motion."""
    parts = {name: dict[str, float]() for name in AXES}
    times = list[float | None]()
    for name, value in islice(flat(document), _MOST_NAMES):
        quantity, axis = _place(name[-_LONGEST:])
        if quantity == 'time':
            times.append(time_of(value))
        elif quantity:
            known = number(value)
            parts[quantity][axis] = math.nan if known is None else known
    whole = {
        name: tuple(parts[name][axis] for axis in axes)
        for name, axes in AXES.items()
        if parts[name].keys() >= set(axes)
    }
    if not whole:
        named = [name for name, axes in parts.items() if axes]
        return Refusal(_KIND, f'{named[0]} without all of its axes') if named else None
    time = times[-1] if times else None
    if times and time is None:
        return Refusal(_KIND, 'its time is neither a number nor a date')
    return MotionReading(time, **whole)


@lru_cache(4096)
def _place(name: str) -> tuple[str, str]:
    """Quantity and axis of a name; the quantity is empty for any other."""
    if rank_of(name, 'time') is not None:
        return 'time', ''
    for each in (name, name.rpartition('.')[2]):  # ax within data is none of "data a"
        quantity, _, axis = motion_of(each) or ('', '', '')
        if quantity in AXES and axis in tuple('xyzw'):
            return quantity, axis
    return '', ''
