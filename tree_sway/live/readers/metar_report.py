# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Reports of an airport from the Aviation Weather Center of the USA, which has those of the world.

Its JSON has the raw report, from which the wind is read as from a file of METAR: a mean over ten
minutes, and the gust (Aviation Weather Center, "Data API", `metar`).
"""

from __future__ import annotations

from collections.abc import Sequence

from tree_sway.files import unit_factor
from tree_sway.files.wind import METAR, number, reading_of
from tree_sway.live.readers.json_path import parse_json
from tree_sway.live.reading import Reading, Refusal
from tree_sway.live.transports.transport import Message

_KIND = 'METAR'


def read_reports(message: Message) -> Sequence[Reading]:
    """Read the newest report of an answer, or of lines of raw reports."""
    document = parse_json(message.data)
    if isinstance(document, list):
        first = document[0] if document else None
        if not isinstance(first, dict) or not isinstance(first.get('rawOb'), str):
            return [Refusal(_KIND, 'no report of this airport')] if not document else ()
        return _read(first['rawOb'], number(first.get('obsTime')), str(first.get('name', '')))
    return _read(message.data.decode('utf-8', 'replace'), None, '')


def _read(text: str, time: float | None, place: str) -> Sequence[Reading]:
    report = METAR.search(text)
    if report is None:
        return ()
    direction, speed, gust, unit = report.group(4, 5, 6, 7)
    factor = unit_factor('speed', unit) or 1.0
    most = factor * float(gust) if gust else None
    where = place.partition(',')[0][:60]
    vane = None if direction == 'VRB' else direction
    return [reading_of(_KIND, speed, vane, factor=factor, gust=most, time=time, place=where)]
