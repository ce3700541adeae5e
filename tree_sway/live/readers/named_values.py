# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Wind among values with names, as in JSON, in a form, or in a line of ``name=value``.

Names are those of the columns of tables; one may end with its unit, as ``wind_avg_km_h`` of
rtl_433 or ``windspeedmph`` of Ecowitt.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from tree_sway.files import folded, rank_of, SENDERS, unit_factor, unit_in_name
from tree_sway.files.wind import number, reading_of
from tree_sway.live.readers.json_path import JsonPath
from tree_sway.live.reading import Reading, Refusal

_SHORTEST, _LONGEST = 2, 60
"""Lengths of names that are looked at: one letter may be anything in JSON."""
_MOST = 2000
"""Largest number of values of one message."""


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
        leaves = dict(_leaves(document))
        name, speed = _found(document, leaves, self.speed, 'wind_speed')
        if speed is _ABSENT:
            return []
        unit = self._unit_of(document, leaves, name, 'wind_speed')
        factor = unit_factor('speed', unit)
        if factor is None:
            return [Refusal(kind, f"unknown unit '{unit[:20]}'")]
        _, direction = _found(document, leaves, self.direction, 'wind_direction')
        name, gust = _found(document, leaves, self.gust, 'gust')
        most = None if gust is _ABSENT else number(gust)
        gust_factor = unit_factor('speed', self._unit_of(document, leaves, name, 'gust'))
        has_gust = most is not None and gust_factor is not None
        return [
            reading_of(
                kind,
                speed,
                None if direction is _ABSENT else direction,
                factor=factor,
                gust=most * gust_factor if has_gust else None,  # type: ignore[operator]
                interval=self.interval,
                sender=_sender(leaves),
            )
        ]

    def _unit(self, document: Any) -> str:
        """Text of the unit of speeds."""
        if not self.unit or unit_factor('speed', self.unit) is not None:
            return self.unit or 'm/s'
        found = JsonPath(self.unit).find(document)
        return found if isinstance(found, str) else self.unit

    def _unit_of(self, document: Any, leaves: Mapping[str, Any], name: str, quantity: str) -> str:
        """Return the unit of a speed: that beside it, in its name, or of all."""
        beside = leaves.get(f'{name}_unit') if name else None
        in_name = unit_in_name(name, quantity) if name else ''
        return beside if isinstance(beside, str) else in_name or self._unit(document)


_ABSENT = object()


def _sender(leaves: Mapping[str, Any]) -> str:
    """Return what a message says of its instrument; empty for nothing."""
    named = {folded(name): value for name, value in leaves.items()}
    found = next((named[name] for name in SENDERS if isinstance(named.get(name), str | int)), '')
    return str(found)[:_LONGEST]


def _found(
    document: Any, leaves: Mapping[str, Any], path: JsonPath | None, quantity: str
) -> tuple[str, Any]:
    """Name and value of a quantity; the name is empty where a path says where it is."""
    if path is not None:
        found = path.find(document)
        return '', _ABSENT if found is None else found
    # Longer names are none, and would stay in the cache.
    short = (name for name in leaves if _SHORTEST <= len(name) <= _LONGEST)
    ranked = ((rank_of(name, quantity), name) for name in short)
    # A boat has a speed as well as a wind_speed.
    known = [('wind' not in name.lower(), rank, name) for rank, name in ranked if rank is not None]
    if not known:
        return '', _ABSENT
    name = min(known)[2]
    return name, leaves[name]


def _leaves(document: Any) -> Iterator[tuple[str, Any]]:
    """
    Yield the values of a document by the last part of their name, inner levels first.

    What is inside of ``wind`` is called so, as ``wind_deg``; an object with a ``value`` stands for
    that value, with its unit beside it.
    """
    level: list[tuple[str, Any]] = [('', document)]
    found = list[tuple[str, Any]]()
    while level and len(found) < _MOST:
        inner: list[tuple[str, Any]] = []
        for key, value in level[:_MOST]:
            if isinstance(value, Mapping):
                inner += _inside(key, value)
            elif isinstance(value, list):
                inner += [(key, each) for each in value if isinstance(each, Mapping | list)]
            else:
                found.append((key, value))
        level = inner
    return reversed(found)


def _inside(key: str, value: Mapping[Any, Any]) -> list[tuple[str, Any]]:
    """Return the values inside of an object, by their names."""
    if 'value' in value and not isinstance(value['value'], Mapping | list):
        unit = value.get('unit', value.get('unitCode'))
        return [(key, value['value']), (f'{key}_unit', unit)]
    names = [str(each) for each in value]
    if key.lower() == 'wind':
        names = [name if 'wind' in name.lower() else f'wind_{name}' for name in names]
    return list(zip(names, value.values(), strict=True))
