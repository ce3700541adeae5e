# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Wind among values with names, as in JSON, in a form, or in a line of ``name=value``.

Names are those of the columns of wind tables, and what gateways and decoders add to them; a name
may end with its unit, as ``wind_avg_km_h`` of rtl_433 or ``windspeedmph`` of Ecowitt.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
import re
from typing import Any

from tree_sway.files.table_file import COLUMNS, UNITS
from tree_sway.sensors.readers.json_path import JsonPath
from tree_sway.sensors.readers.values import bearing_of, is_calm, number, speed_factor
from tree_sway.sensors.reading import Reading, Refusal, WindReading

_MORE = {
    'wind_speed': (
        'wind_avg',
        'windspeed_avg',
        'wind_speed_last',
        'native_wind_speed',
        'anemometer',
    ),
    'wind_direction': ('wind_bearing', 'windbearing', 'wind_dir_last', 'wind_angle'),
    'gust': ('wind_max', 'wind_gust_speed', 'wind_speed_hi_last_2_min', 'native_wind_gust_speed'),
}
"""Names that gateways use beside those of tables."""
_SHORTEST = 2
"""Length of the shortest name: one letter may be anything in JSON."""
_MOST = 2000
"""Largest number of values of one message."""
_OTHER = re.compile(r'[^a-z0-9]+')


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
        names = named(document)
        speed, factor = self._speed(document, names, self.speed, 'wind_speed')
        if speed is _ABSENT:
            return []
        if factor is None:
            return [Refusal(kind, f"unknown unit '{self._unit_text(document)[:20]}'")]
        value = number(speed)
        if value is None or value < 0.0:
            return [Refusal(kind, f"speed is '{str(speed)[:20]}'")]
        direction = _found(document, names, self.direction, 'wind_direction')
        bearing = None if direction is _ABSENT else bearing_of(direction)
        is_known = direction is _ABSENT or bearing is not None or is_calm(value * factor)
        if not is_known and direction is not None:
            return [Refusal(kind, f"direction is '{str(direction)[:20]}'")]
        gust, gust_factor = self._speed(document, names, self.gust, 'gust')
        most = None if gust is _ABSENT else number(gust)
        return [
            WindReading(
                kind,
                value * factor,
                bearing,
                gust=None if most is None or gust_factor is None else most * gust_factor,
                interval=self.interval,
            )
        ]

    def _unit_text(self, document: Any) -> str:
        """Text of the unit, empty where the option is neither a unit nor a path of one."""
        if not self.unit or speed_factor(self.unit) is not None:
            return self.unit or 'm/s'
        found = JsonPath(self.unit).find(document)
        return found if isinstance(found, str) else self.unit

    def _speed(
        self, document: Any, names: Mapping[str, Any], path: JsonPath | None, quantity: str
    ) -> tuple[Any, float | None]:
        """Value of a speed and the factor of its unit, None for an unknown unit."""
        usual = speed_factor(self._unit_text(document))
        if path is not None:
            found = path.find(document)
            return (_ABSENT if found is None else found), usual
        for name in _names(quantity):
            if name in names:
                return names[name], _beside(names, name) or usual
            for unit in _UNIT_SUFFIXES:
                for joined in (f'{name}_{unit}', f'{name}{unit}'):
                    if joined in names:
                        return names[joined], _UNIT_SUFFIXES[unit]
        return _ABSENT, usual


def named(document: Any) -> dict[str, Any]:
    """Return the leaves of a document by the last part of their name; the first of each counts."""
    found: dict[str, Any] = {}
    for count, (name, value) in enumerate(_leaves(document)):
        if count >= _MOST:
            break
        found.setdefault(_OTHER.sub('_', name.lower()).strip('_'), value)
    return found


_ABSENT = object()
_UNIT_SUFFIXES = {
    _OTHER.sub('_', unit).strip('_'): factor
    for unit, factor in UNITS['speed'].items()
    if unit != 'm s^-1'
}
"""Factor of each unit as it ends a name: ``km_h``, ``mph``."""


def _names(quantity: str) -> Iterator[str]:
    known = (*COLUMNS[quantity]['names'], *_MORE[quantity])
    return (name for name in known if len(name) >= _SHORTEST)


def _beside(names: Mapping[str, Any], name: str) -> float | None:
    """Factor of the unit that a value of its own names, as ``wind_speed_unit``."""
    unit = names.get(f'{name}_unit')
    return speed_factor(unit) if isinstance(unit, str) else None


def _found(document: Any, names: Mapping[str, Any], path: JsonPath | None, quantity: str) -> Any:
    if path is not None:
        found = path.find(document)
        return _ABSENT if found is None else found
    for name in _names(quantity):
        for each in (name, f'{name}_deg', f'{name}_degrees'):
            if each in names:
                return names[each]
    return _ABSENT


def _leaves(document: Any, name: str = '') -> Iterator[tuple[str, Any]]:
    """Yield the names and values of a document, those of outer levels first."""
    level: list[tuple[str, Any]] = [(name, document)]
    while level:
        inner: list[tuple[str, Any]] = []
        for key, value in level[:_MOST]:
            if isinstance(value, Mapping):
                inner += [(str(each), value[each]) for each in value]
            elif isinstance(value, list):
                inner += [(key, each) for each in value if isinstance(each, Mapping | list)]
            else:
                yield key, value
        level = inner
