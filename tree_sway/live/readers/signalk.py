# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Deltas of Signal K, of which the pair is read that depends least on the motion of the boat.

That is the direction from true north with the speed over ground or the true one, then the apparent
wind, whose angle counts from the heading. Values are in SI: speeds in m/s, angles in rad, those
from the bow positive to starboard.
"""

from __future__ import annotations

from dataclasses import dataclass, field
import math

from tree_sway.files.wind import (
    number,
    Reading,
    Readings,
    Refusal,
    SIGNALK_PAIRS,
    signalk_values,
    SIGNALK_WIND,
    WindReading,
)
from tree_sway.live.readers.json_path import parse_json
from tree_sway.live.transports.transport import Message

HEADING = 'navigation.headingTrue'
_KNOWN = {HEADING, *(SIGNALK_WIND + name for *pair, _ in SIGNALK_PAIRS for name in pair)}
"""Paths that are kept; a server may send any number of others."""
_KIND = 'Signal K'


@dataclass
class SignalKWind:
    """
    Reader of deltas, which keeps the newest value of each path.

    ``heading`` is that of the bow [rad] until the server sends one.
    """

    heading: float = 0.0
    values: dict[str, float] = field(default_factory=dict, init=False)

    def __call__(self, message: Message) -> Readings:
        """Read a delta: a reading where it has the speed of the best pair."""
        found = list[Reading]()
        changed = dict[str, str]()
        for path, value, sender, _ in signalk_values(parse_json(message.data)):
            if path not in _KNOWN:
                continue
            known = number(value)
            if known is None:
                found.append(Refusal(_KIND, f'{path} is {str(value)[:20]}'))
                continue
            name = path.removeprefix(SIGNALK_WIND)
            self.values[name] = known
            changed[name] = sender
        for speed, angle, is_from_bow in SIGNALK_PAIRS:
            if speed in self.values and angle in self.values:
                if speed in changed:
                    found.append(self._reading(speed, angle, is_from_bow, changed[speed]))
                break
        return found

    def _reading(self, speed: str, angle: str, is_from_bow: bool, sender: str) -> Reading:
        if self.values[speed] < 0.0:
            return Refusal(_KIND, f'{speed} is {self.values[speed]:g}')
        bow = self.values.get(HEADING, self.heading) if is_from_bow else 0.0
        bearing = (self.values[angle] + bow) % math.tau
        kind = f'{_KIND} {speed}'
        return WindReading(kind, self.values[speed], bearing, interval=0.0, sender=sender)
