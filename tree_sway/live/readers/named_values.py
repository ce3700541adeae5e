# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Wind among values with names, as in JSON, in a form, or in a line of ``name=value``.

Names are those of the columns of tables; one may end with its unit, as ``wind_avg_km_h`` of
rtl_433 or ``windspeedmph`` of Ecowitt.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import islice
from typing import Any

from tree_sway.files import folded, rank_of, SENDERS, unit_factor, unit_in_name
from tree_sway.files.motion import flat, unit_beside
from tree_sway.files.wind import number, reading_of
from tree_sway.live.readers.json_path import JsonPath
from tree_sway.live.reading import Reading, Refusal

_LONGEST = 120
"""Length of names that are looked at; of one letter is none, which may be anything."""
_MOST = 2000
"""Largest number of values of one message."""
_NO_UNIT = 'taken in m/s, as nothing tells its unit: unit=km/h in the address changes it'


@dataclass(frozen=True)
class WindNames:
    """
    Where to find the wind among named values.

    Parameters
    ----------
    speed, direction, gust
        Paths of the values; found by their usual names if None.
    unit
        Unit of speeds without one in their names, or the path of a text that is the unit.
    interval
        As in `WindReading`.

    """

    speed: JsonPath | None = None
    direction: JsonPath | None = None
    gust: JsonPath | None = None
    unit: str = ''
    interval: float | None = None

    def read(self, document: Any, kind: str) -> list[Reading]:
        """Return the wind of a document; nothing where it has no speed."""
        whole = document if isinstance(document, Mapping) else {'': document}
        leaves = dict(islice(flat(whole, lists=True), _MOST))
        name, speed = _found(document, leaves, self.speed, 'wind_speed')
        if speed is _ABSENT:
            return []
        unit = self._unit_of(document, leaves, name, 'wind_speed')
        factor = unit_factor('speed', unit or 'm/s')
        if factor is None:
            return [Refusal(kind, f"unknown unit '{unit[:20]}'")]
        _, direction = _found(document, leaves, self.direction, 'wind_direction')
        name, gust = _found(document, leaves, self.gust, 'gust')
        most = None if gust is _ABSENT else number(gust)
        gust_factor = unit_factor('speed', self._unit_of(document, leaves, name, 'gust') or 'm/s')
        has_gust = most is not None and gust_factor is not None
        return [
            reading_of(
                kind,
                speed,
                None if direction in (_ABSENT, *_NO_DIRECTION) else direction,
                factor=factor,
                gust=most * gust_factor if has_gust else None,  # type: ignore[operator]
                interval=self.interval,
                sender=_sender(leaves),
                assumed='' if unit else _NO_UNIT,
            )
        ]

    def _unit(self, document: Any) -> str:
        """Text of the unit of speeds; empty where nothing tells it."""
        if not self.unit or unit_factor('speed', self.unit) is not None:
            return self.unit
        found = JsonPath(self.unit).find(document)
        return found if isinstance(found, str) and found else self.unit

    def _unit_of(self, document: Any, leaves: Mapping[str, Any], name: str, quantity: str) -> str:
        """Return the unit of a speed: that beside it, in its name, or of all."""
        if not name:
            return self._unit(document)
        has_parts = name.endswith('.value')
        beside = unit_beside(leaves, name) if has_parts else leaves.get(f'{name}_unit')
        last = name.removesuffix('.value').rpartition('.')[2]
        return beside or unit_in_name(last, quantity) or self._unit(document)


_ABSENT = object()
_NO_DIRECTION = ('', 'VRB')
"""Cells of a direction that is not measured, or variable."""


def _sender(leaves: Mapping[str, Any]) -> str:
    """Return what a message says of its instrument; empty for nothing."""
    named = {folded(name.rpartition('.')[2]): value for name, value in leaves.items()}
    return next((named[name] for name in SENDERS if named.get(name)), '')[:_LONGEST]


def _found(
    document: Any, leaves: Mapping[str, Any], path: JsonPath | None, quantity: str
) -> tuple[str, Any]:
    """Name and value of a quantity; the name is empty where a path says where it is."""
    if path is not None:
        found = path.find(document)
        return '', _ABSENT if found is None else found
    # Longer names are none, and would stay in the cache.
    last_of = {name: name.rpartition('.')[2] for name in leaves if len(name) <= _LONGEST}
    ranks = {name: rank_of(name, quantity) for name, last in last_of.items() if last[1:]}
    # A boat has a speed as well as a wind_speed.
    known = [
        ('wind' not in name.lower(), rank, name.count('.'), name)
        for name, rank in ranks.items()
        if rank is not None
    ]
    if not known:
        return '', _ABSENT
    name = min(known)[-1]
    return name, leaves[name]
