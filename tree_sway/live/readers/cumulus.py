# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The file ``realtime.txt`` that Cumulus or Cumulus MX puts on a web server.

Its speed and its bearing are means of ten minutes as a rule, with the gust of these; the file says
the unit (Cumulus Wiki, "Realtime.txt").
"""

from __future__ import annotations

from tree_sway.files.wind import form_of, Readings
from tree_sway.live.readers.named_values import WindNames
from tree_sway.live.transports.transport import Message

_FORM = form_of('Cumulus realtime')
_NAMES = WindNames(unit='unit')


def read_realtime(message: Message) -> Readings:
    """Read the wind of a file; a refusal if its numbers are none."""
    found = _FORM.fullmatch(message.data.decode('utf-8', 'replace').strip().replace(',', '.'))
    return [] if found is None else _NAMES.read(found.groupdict(), 'Cumulus')
