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
from tree_sway.files.wind import number, Reading, reading_of, Refusal
from tree_sway.live.readers.json_path import steps_of, value_at
from tree_sway.live.source_address import SourceAddress

_LONGEST = 120
"""Length of names that are looked at; of one letter is none, which may be anything."""
_MOST = 2000
"""Largest number of values of one message."""
NO_UNIT = 'taken in m/s, as nothing tells its unit: unit=km/h in the address changes it'


@dataclass(frozen=True)
class WindNames:
    """
    Where to find the wind among named values.

    Parameters
    ----------
    speed, direction, gust
        Paths of the values; found by their usual names if empty.
    unit
        Unit of speeds without one in their names, or the path of a text that is the unit.
    interval
        As in `WindReading`.

    """

    speed: str = ''
    direction: str = ''
    gust: str = ''
    unit: str = ''
    interval: float | None = None

    def read(self, document: Any, kind: str) -> list[Reading]:
        """Return the wind of a document; nothing where it has no speed."""
        whole = document if isinstance(document, Mapping) else {'': document}
        leaves = dict(islice(flat(whole, lists=True), _MOST))
        common = self._unit(document)

        def found(path: str, quantity: str) -> _Found:
            if path:
                return value_at(document, *steps_of(path)), common
            return _by_name(leaves, quantity, common)

        speed, unit = found(self.speed, 'wind_speed')
        if speed is None:
            return []
        factor = unit_factor('speed', unit or 'm/s')
        if factor is None:
            return [Refusal(kind, f"unknown unit '{unit[:20]}'")]
        direction, _ = found(self.direction, 'wind_direction')
        gust, its_unit = found(self.gust, 'gust')
        size, in_si = number(gust), unit_factor('speed', its_unit or 'm/s')
        return [
            reading_of(
                kind,
                speed,
                None if direction in _NO_DIRECTION else direction,
                factor=factor,
                gust=None if size is None or in_si is None else size * in_si,
                interval=self.interval,
                sender=_sender(leaves),
                assumed='' if unit else NO_UNIT,
            )
        ]

    def _unit(self, document: Any) -> str:
        """Text of the unit of speeds; empty where nothing tells it."""
        if not self.unit or unit_factor('speed', self.unit) is not None:
            return self.unit
        found = value_at(document, *steps_of(self.unit))
        return found if isinstance(found, str) and found else self.unit


def names_of(address: SourceAddress) -> WindNames:
    """
    Read the paths ``speed``, ``direction`` and ``gust`` of an address, and ``unit``.

    Raises a `ParameterError` for text that is no path.
    """
    speed, direction, gust = map(address.text_of, ('speed', 'direction', 'gust'))
    for path in filter(None, (speed, direction, gust)):
        steps_of(path)
    return WindNames(speed, direction, gust, address.text_of('unit'))


_NO_DIRECTION = ('', 'VRB')
"""Cells of a direction that is not measured, or variable."""


_Found = tuple[Any, str]
"""A value of a document or None, and the unit of speeds there; empty where nothing tells it."""


def _by_name(leaves: Mapping[str, str], quantity: str, common: str) -> _Found:
    """Find a quantity by its usual names, with the unit beside it, in its name, or of all."""
    # Longer names are none, and would stay in the cache.
    looked_at = [name for name in leaves if len(name) <= _LONGEST and name.rpartition('.')[2][1:]]
    # A boat has a speed as well as a wind_speed.
    known = [
        ('wind' not in name.lower(), rank, name.count('.'), name)
        for name in looked_at
        if (rank := rank_of(name, quantity)) is not None
    ]
    if not known:
        return None, ''
    name = min(known)[-1]
    has_parts = name.endswith('.value')
    beside = unit_beside(leaves, name) if has_parts else leaves.get(f'{name}_unit')
    last = name.removesuffix('.value').rpartition('.')[2]
    return leaves[name], beside or unit_in_name(last, quantity) or common


def _sender(leaves: Mapping[str, str]) -> str:
    """Return what a message says of its instrument; empty for nothing."""
    named = {folded(name.rpartition('.')[2]): value for name, value in leaves.items()}
    return next((named[name] for name in SENDERS if named.get(name)), '')[:_LONGEST]
