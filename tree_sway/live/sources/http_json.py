# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""JSON of an HTTP server, requested now and then: Home Assistant, Davis WeatherLink Live, any."""

from __future__ import annotations

from urllib.parse import parse_qsl, urlencode

from tree_sway.errors import nearest
from tree_sway.files import unit_factor
from tree_sway.files.wind import Readings
from tree_sway.live.readers.documents import read_document
from tree_sway.live.readers.json_path import parse_json
from tree_sway.live.readers.named_values import names_of
from tree_sway.live.source import Source
from tree_sway.live.source_address import SourceAddress
from tree_sway.live.transports.http_poll import HttpPoll
from tree_sway.live.transports.transport import Message
from tree_sway.simulation.wind import LEAST_INTERVAL

_OPTIONS = 'speed direction gust unit every token_file name mean from_degrees'.split()
"""Options of ours in a query; others belong to the server."""
_ALIKE = 0.8
"""Share of common letters from which an option of the query is a misspelt one of ours."""

_EXPECTS = 'JSON with a wind speed; say where: speed=PATH&direction=PATH&unit=km/h'


def open_source(address: SourceAddress) -> Source:
    """
    Open an address: ``http://host/state.json?speed=PATH&direction=PATH&every=60``.

    ``token_file`` is a file with a token for the header ``Authorization``.
    """
    if not address.host:
        raise address.error('no host', 'give http://host/path')
    parts = address.parts
    if not parts.fragment:
        theirs = [each for each in parse_qsl(parts.query, True) if each[0] not in _OPTIONS]
        for name, value in theirs:  # of which one with another letter is meant to be ours
            is_theirs = name == 'units' and unit_factor('speed', value) is None
            if not is_theirs and (guess := nearest(name, _OPTIONS, _ALIKE)):
                cure = (
                    f"{guess} Behind a '#' are options of ours alone, and all of the query is sent"
                )
                raise address.error(f"no option '{name}'", cure)
        address.options = {k: v for k, v in address.options.items() if k in _OPTIONS}
        parts = parts._replace(query=urlencode(theirs))
    every = address.number('every', 60.0, 0.2, 86_400.0)
    url = parts._replace(fragment='').geturl()
    transport = HttpPoll(url, every, address.headers())
    interval = every if every >= LEAST_INTERVAL else 0.0
    names = names_of(address)

    def read(message: Message) -> Readings:
        return read_document(parse_json(message.data), names)

    return Source(transport, read, address.host, _EXPECTS, interval)
