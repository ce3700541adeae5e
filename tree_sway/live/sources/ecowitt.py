# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Stations that send to a server: Ecowitt, Froggit, Ambient, and all that know Weather Underground.

Ecowitt posts a form with ``windspeedmph``, ``windgustmph`` and ``winddir``; in the protocol of
Weather Underground the same names are in the query of a GET. Speeds are in miles per hour in both.
A station sends every 8 to 60 s: a shorter interval than 20 s is the wind itself, others are means.
"""

from __future__ import annotations

from hashlib import sha256
from urllib.parse import parse_qsl

from tree_sway.doorkeeper import is_loopback
from tree_sway.files.wind import Readings, Refusal
from tree_sway.live.readers.named_values import WindNames
from tree_sway.live.source import Source
from tree_sway.live.source_address import SourceAddress
from tree_sway.live.transports.http_server import HttpServer
from tree_sway.live.transports.transport import Message

_KIND = 'upload'
_MOST_FIELDS = 500
_SHORTEST_PASSKEY = 8
_NAMES = WindNames()


def read_upload(message: Message) -> Readings:
    """Read a form of the two protocols."""
    try:
        text = message.data.decode('utf-8', 'replace')
        named = dict(parse_qsl(text, max_num_fields=_MOST_FIELDS))
    except ValueError:
        return [Refusal(_KIND, 'too many fields')]
    if secret := named.pop('PASSKEY', ''):
        named.setdefault('ID', f'station {sha256(secret.encode()).hexdigest()[:8]}')
    return _NAMES.read(named, _KIND)


def open_source(address: SourceAddress) -> Source:
    """
    Open a server on a port: ``ecowitt:8080``, for this machine alone.

    ``host=0.0.0.0`` opens it to the network, for whoever sends the word in ``passkey_file``.
    """
    port = address.port(cure='give ecowitt:8080, and that port in the station')
    host = address.text_of('host', '127.0.0.1')
    passkey = address.secret('passkey_file')
    if not is_loopback(host) and len(passkey) < _SHORTEST_PASSKEY:
        raise address.error(
            f'{host} is open to the network, without a passkey of {_SHORTEST_PASSKEY} letters',
            'write one to a file, name it as passkey_file=FILE, and give it in the station: as '
            'its password, or in its path, as /PASSKEY/',
        )
    server = HttpServer(port, host, passkey)
    expects = 'the upload of Ecowitt or of Weather Underground, with windspeedmph'
    return Source(server, read_upload, 'weather station', expects)
