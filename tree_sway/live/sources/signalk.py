# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Wind of a Signal K server, over its WebSocket (Signal K specification 1.7, "Streaming").

It subscribes to ``environment.wind``.
"""

from __future__ import annotations

import json

from tree_sway.files.wind import SIGNALK_WIND
from tree_sway.live.readers.signalk import HEADING, SignalKWind
from tree_sway.live.source import Source
from tree_sway.live.source_address import SourceAddress
from tree_sway.live.transports.websocket import WebSocket

_PORT = 3000


def open_source(address: SourceAddress) -> Source:
    """Open a server: ``signalk://host:3000``; ``signalks`` with TLS, ``token_file`` to log in."""
    if not address.host:
        raise address.error('no host', 'give signalk://host:3000')
    scheme = 'wss' if address.scheme == 'signalks' else 'ws'
    port = address.port(_PORT)
    url = f'{scheme}://{address.host}:{port}/signalk/v1/stream?subscribe=none'
    paths = [f'{SIGNALK_WIND}*', HEADING]
    subscription = {
        'context': 'vessels.self',
        'subscribe': [{'path': path, 'policy': 'instant', 'minPeriod': 50} for path in paths],
    }
    hello = json.dumps(subscription)
    socket = WebSocket(url, hello, address.headers(), address.silence(30.0))
    read = SignalKWind(address.angle('heading_degrees'))
    return Source(socket, read, f'Signal K {address.host}', 'deltas of environment.wind', 0.0)
