# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The present wind of a service on the internet, whose row of ``polled.csv`` tells where it is.

Open-Meteo's is the output of weather models at 10 m height, over a quarter of an hour (Open-Meteo,
"Weather Forecast API", `current`); that of an airport is its report, a mean over ten minutes and
the gust, in knots (Aviation Weather Center, "Data API", `metar`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from tree_sway.files import object_of
from tree_sway.files.wind import number, Readings, Refusal, WindReading
from tree_sway.live.readers.json_path import parse_json, steps_of, time_of, value_at
from tree_sway.live.readers.named_values import WindNames
from tree_sway.live.transports.transport import Message

_ABOUT = ('time', 'lasting', 'station')
"""Paths of the time of the wind, of the length of its mean [s] and of the name of a station."""


def service_reader(known: Mapping[str, Any]) -> Callable[[Message], Readings]:
    """Return the reader of a service of a row; its reason is the refusal of one without a wind."""
    kind: str = known['name']
    names = WindNames(known['speed'], known['direction'], known['gust'], known['unit'])

    def read(message: Message) -> Readings:
        document = parse_json(message.data)
        reason = 'no report' if document == [] else object_of(document).get('reason')
        if isinstance(reason, str):
            return [Refusal(kind, reason[:80])]
        time, lasting, station = (
            value_at(document, *steps_of(known[each])) if known[each] else None for each in _ABOUT
        )
        fields: dict[str, Any] = {
            'time': time_of(time),
            'interval': number(lasting),
            'place': str(station or '').partition(',')[0][:60],
        }
        return [
            replace(each, **fields) if isinstance(each, WindReading) else each
            for each in names.read(document, kind)
        ]

    return read
