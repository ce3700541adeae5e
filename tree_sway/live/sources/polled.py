# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Documents of known services and instruments that are asked for now and then: `polled.csv`.

``place`` is the form of the text behind the scheme, ``url`` the address with it, beside the option
``server``, which is that of another installation; ``example`` is the cure for a wrong place.
``every`` is the time between requests, ``interval`` the length of a mean that the document does
not tell, and ``lasts`` the time for which it is used [s]; ``upper`` says that capital letters are
meant. ``read`` is a function of `readers`, or one that makes such a function of the row.
"""

from __future__ import annotations

from importlib import import_module
import re

from tree_sway.live import readers
from tree_sway.live.source import Source
from tree_sway.live.source_address import SourceAddress
from tree_sway.live.transports.http_poll import HttpPoll
from tree_sway.tables import table_beside

_KINDS = {each['scheme']: each for each in table_beside(__file__, 'polled.csv')}


def open_source(address: SourceAddress) -> Source:
    """Open a place of a kind of the table: ``open-meteo:52.52,13.41``, ``metar:EDDB``."""
    known = _KINDS[address.scheme]
    place = address.place.lstrip('/')
    place = place.upper() if known['upper'] else place
    found = re.fullmatch(known['place'], place)
    if found is None:
        raise address.error(known['lacking'], f'give {known["example"]}')
    server = address.text_of('server', known['server'] or '')
    every = address.number('every', known['every'], 0.2, 86_400.0)
    url = known['url'].format(*found.groups(), place=place, server=server)
    name = known['name'] if 'name' in address.options else known['shown'].format(place=place)
    module, function = known['read'].split('.')
    read = getattr(import_module(f'{readers.__name__}.{module}'), function)
    read = read(known) if known['speed'] else read
    lasts = known['lasts'] or None
    return Source(HttpPoll(url, every), read, name, known['expects'], known['interval'], lasts)
