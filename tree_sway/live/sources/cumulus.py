# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A garden station by the file ``realtime.txt`` that Cumulus or Cumulus MX puts on a web server.

Its speed and its bearing are means of ten minutes as a rule, with the gust of these; the file says
the unit (Cumulus Wiki, "Realtime.txt").
"""

from __future__ import annotations

from collections.abc import Sequence
from math import radians

from tree_sway.files import unit_factor
from tree_sway.files.wind import form_of
from tree_sway.live.readers.values import number
from tree_sway.live.reading import Reading, Refusal, WindReading
from tree_sway.live.source import Source
from tree_sway.live.source_address import SourceAddress
from tree_sway.live.transports.http_poll import HttpPoll
from tree_sway.live.transports.transport import Message

_EVERY = 60.0
_INTERVAL = 600.0
_KIND = 'Cumulus'
_FORM = form_of('Cumulus realtime')


def _read_realtime(message: Message) -> Sequence[Reading]:
    """Read the wind of a file; a refusal if its numbers are none."""
    found = _FORM.fullmatch(message.data.decode('utf-8', 'replace').strip().replace(',', '.'))
    factor = None if found is None else unit_factor('speed', found['unit'])
    if found is None or factor is None:
        return ()
    speed, bearing, gust = (
        number(found[each]) for each in ('wind_speed', 'wind_direction', 'gust')
    )
    if speed is None or bearing is None:
        return [Refusal(_KIND, f"no speed or bearing in '{found[0][:40]}'")]
    most = None if gust is None else factor * gust
    return [WindReading(_KIND, factor * speed, radians(bearing), gust=most, interval=_INTERVAL)]


def open_source(address: SourceAddress) -> Source:
    """Open a file on a server: ``cumulus:HOST/realtime.txt``."""
    if not address.place:
        raise address.error('no host', 'give cumulus:weather.example.org/realtime.txt')
    url = f'http://{address.place.lstrip("/")}'
    every = address.number('every', _EVERY, 0.2, 86_400.0)
    expects = 'the fields of realtime.txt'
    return Source(HttpPoll(url, every), _read_realtime, _KIND, expects, _INTERVAL)
