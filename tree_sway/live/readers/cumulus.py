# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The file ``realtime.txt`` that Cumulus or Cumulus MX puts on a web server.

Its speed and its bearing are means of ten minutes as a rule, with the gust of these; the file says
the unit (Cumulus Wiki, "Realtime.txt").
"""

from __future__ import annotations

from collections.abc import Sequence

from tree_sway.files import unit_factor
from tree_sway.files.wind import form_of, number, Reading, reading_of
from tree_sway.live.transports.transport import Message

_KIND = 'Cumulus'
_FORM = form_of('Cumulus realtime')


def read_realtime(message: Message) -> Sequence[Reading]:
    """Read the wind of a file; a refusal if its numbers are none."""
    found = _FORM.fullmatch(message.data.decode('utf-8', 'replace').strip().replace(',', '.'))
    factor = None if found is None else unit_factor('speed', found['unit'])
    if found is None or factor is None:
        return ()
    most = number(found['gust'])
    gust = None if most is None else factor * most
    speed, direction = found['wind_speed'], found['wind_direction']
    return [reading_of(_KIND, speed, direction, factor=factor, gust=gust)]
