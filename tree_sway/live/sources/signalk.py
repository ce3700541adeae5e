# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Wind of a Signal K server, over its WebSocket (Signal K specification 1.7, "Streaming").

It subscribes to ``environment.wind``. Values are in SI: speeds in m/s, angles in rad, those from
the bow positive to starboard. Of what comes, the pair is read that depends least on the motion of
the boat: direction from true north with the speed over ground or the true one, then the apparent
wind, whose angle counts from the heading.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
import json
import math
from typing import Any

from tree_sway.live.question_options import silence_of
from tree_sway.live.readers.json_path import parse_json
from tree_sway.live.readers.values import number
from tree_sway.live.reading import Reading, Refusal, WindReading
from tree_sway.live.source_address import SourceAddress
from tree_sway.live.source_kind import Source, SourceKind
from tree_sway.live.transports.transport import Message
from tree_sway.live.transports.websocket import WebSocket

_PORT = 3000
_WIND = 'environment.wind.'
_HEADING = 'navigation.headingTrue'
_PAIRS = (
    ('speedOverGround', 'directionTrue', False),
    ('speedTrue', 'directionTrue', False),
    ('speedApparent', 'angleApparent', True),
)
"""Speeds and angles, best first, and whether the angle counts from the bow."""
_KNOWN = {_HEADING, *(_WIND + name for *pair, _ in _PAIRS for name in pair)}
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

    def __call__(self, message: Message) -> Sequence[Reading]:
        """Read a delta: a reading where it has the speed of the best pair."""
        found = list[Reading]()
        changed = dict[str, str]()
        for path, value, sender in _values(parse_json(message.data)):
            if path not in _KNOWN:
                continue
            known = number(value)
            if known is None:
                found.append(Refusal(_KIND, f'{path} is {str(value)[:20]}'))
                continue
            name = path.removeprefix(_WIND)
            self.values[name] = known
            changed[name] = sender
        for speed, angle, is_from_bow in _PAIRS:
            if speed in self.values and angle in self.values:
                if speed in changed:
                    found.append(self._reading(speed, angle, is_from_bow, changed[speed]))
                break
        return found

    def _reading(self, speed: str, angle: str, is_from_bow: bool, sender: str) -> Reading:
        if self.values[speed] < 0.0:
            return Refusal(_KIND, f'{speed} is {self.values[speed]:g}')
        bow = self.values.get(_HEADING, self.heading) if is_from_bow else 0.0
        bearing = (self.values[angle] + bow) % math.tau
        kind = f'{_KIND} {speed}'
        return WindReading(kind, self.values[speed], bearing, interval=0.0, sender=sender)


def _values(document: Any) -> Iterator[tuple[str, Any, str]]:
    """Yield paths, values and their source of a delta; nothing of any other document."""
    updates = document.get('updates') if isinstance(document, dict) else None
    for update in updates if isinstance(updates, list) else ():
        values = update.get('values') if isinstance(update, dict) else None
        for each in values if isinstance(values, list) else ():
            if isinstance(each, dict) and isinstance(each.get('path'), str):
                yield each['path'], each.get('value'), str(update.get('$source', ''))


def open_signalk(address: SourceAddress) -> Source:
    """Open a server: ``signalk://host:3000``; ``signalks`` with TLS, ``token_file`` to log in."""
    if not address.host:
        raise address.error('no host', 'give signalk://host:3000')
    scheme = 'wss' if address.scheme == 'signalks' else 'ws'
    port = address.port(_PORT)
    url = f'{scheme}://{address.host}:{port}/signalk/v1/stream?subscribe=none'
    paths = [f'{_WIND}*', _HEADING]
    subscription = {
        'context': 'vessels.self',
        'subscribe': [{'path': path, 'policy': 'instant', 'minPeriod': 50} for path in paths],
    }
    token = address.secret('token_file')
    headers = {'Authorization': f'Bearer {token}'} if token else {}
    socket = WebSocket(url, json.dumps(subscription), headers, silence_of(address, 30.0))
    read = SignalKWind(address.angle('heading_degrees'))
    return Source(socket, read, f'Signal K {address.host}', 'deltas of environment.wind', 0.0)


SOURCES = (
    SourceKind(
        ('signalk', 'signalks'), 'signalk://host:3000', 'a boat with Signal K', open_signalk
    ),
)
