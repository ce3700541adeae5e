# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The present wind of a service on the internet, whose row of ``polled.csv`` tells where it is.

Open-Meteo's is the output of weather models at 10 m height, over a quarter of an hour (Open-Meteo,
"Weather Forecast API", `current`); that of an airport is its report, a mean over ten minutes and
the gust, in knots (Aviation Weather Center, "Data API", `metar`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from tree_sway.files import object_of
from tree_sway.files.wind import number, Readings, Refusal, WindReading
from tree_sway.live.readers.json_path import JsonPath, parse_json, time_of
from tree_sway.live.readers.named_values import WindNames
from tree_sway.live.transports.transport import Message

_WIND = ('speed', 'direction', 'gust')
_ABOUT = ('time', 'lasting', 'station')
"""Paths of the time of the wind, of the length of its mean [s] and of the name of a station."""


class ServiceAnswer:
    """Reader of the answers of a service: ``known`` is its row."""

    def __init__(self, known: Mapping[str, Any]) -> None:
        self._kind: str = known['name']
        speed, direction, gust = (JsonPath(known[each]) for each in _WIND)
        self._names = WindNames(speed, direction, gust, known['unit'])
        self._about = {each: JsonPath(known[each]) for each in _ABOUT if known[each]}

    def __call__(self, message: Message) -> Readings:
        """Read an answer; its reason is the refusal of one without a wind."""
        document = parse_json(message.data)
        reason = object_of(document).get('reason')
        if document == []:
            reason = 'no report'
        if isinstance(reason, str):
            return [Refusal(self._kind, reason[:80])]
        about = {each: path.find(document) for each, path in self._about.items()}
        fields: dict[str, Any] = {
            'time': time_of(about['time']),
            'interval': number(about.get('lasting')),
            'place': str(about.get('station') or '').partition(',')[0][:60],
        }
        return [
            replace(each, **fields) if isinstance(each, WindReading) else each
            for each in self._names.read(document, self._kind)
        ]
