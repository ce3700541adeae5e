# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The zone of times that do not say it: from the name of their column, a column, or a line above.

It is a name of the tz database, letters that are those of one zone alone, or how far the clock is
ahead of UTC: ``UTC+2``, or behind a word for the zone in hours or in seconds.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from datetime import datetime, timedelta, timezone, tzinfo
import re
from zoneinfo import ZoneInfo, ZoneInfoNotFoundError

import numpy as np

from tree_sway.files.column_names import ZONES
from tree_sway.files.table_file import TextTable
from tree_sway.files.time_stamps import Times

_AREAS = 'Africa|America|Asia|Atlantic|Australia|Europe|Indian|Pacific'
_SIZE = r'\d+(?:[.:]\d+)?'
_ANYWHERE = rf'\b((?:{_AREAS})/[\w/]+)|(?<![\w/])(?<!\d )(?:UTC|GMT) ?\(?([-+]{_SIZE})'
_LETTERS = rf'(?<![^\W_])({"|".join(ZONES)})(?![^\W_]|\s?[-+]\d)'
_IN_NAME = re.compile(f'{_ANYWHERE}|{_LETTERS}|((?i:utc|gmt|zulu))')
_TOLD = re.compile(
    rf'{_ANYWHERE}|(?:time.?zone|utc.?offset|zeitzone)(?:[\s_a-z()]{{0,20}}[:=]|\s*[,;])\s*"?'
    rf'(?:{_LETTERS}|([-+]?{_SIZE})(?=\s*(?:h|hours?|s)?\s*(?:[,;")]|$)))'
    rf'|^LOCATION,(?:[^,]*,){{7}} *([-+]?{_SIZE})',
    re.IGNORECASE,
)
"""The last is that of the weather of EnergyPlus, in hours."""
_QUARTER = 900.0
"""Zones are whole quarters of an hour from UTC [s]."""
_FARTHEST = 14.0
"""Hours that a zone is ahead of UTC at most."""


def in_utc(table: TextTable, columns: Sequence[int], times: Times) -> Times:
    """Return dates of columns in UTC, if their table says on the clock of which zone they are."""
    told = [each for each in _told(table, columns) if each]
    name = next((each for each in told if _zone_of(each)), ''.join(told[:1]))
    zone = _zone_of(name)
    if not name or zone == timezone.utc:
        return times
    note = f'zone {name} is not known here; times are left as they are'
    if zone is not None:
        note = f'times are on the clock of {zone}'
        times = _moved(times, zone)
    return times._replace(note='; '.join(filter(None, (times.note, note))))


def _told(table: TextTable, columns: Sequence[int]) -> Iterator[str]:
    """Yield the zones that a table tells, and empty texts."""
    yield _first(_IN_NAME, ' '.join(table.columns[each] for each in columns))
    for index in table.find_all('time_zone')[:1]:
        zones = sorted({*table.cells(index, table.rows)} - {''})
        yield _first(_TOLD, f'time zone: {zones[0]}') if len(zones) == 1 else ' and '.join(zones)
    for line in table.above:
        yield _first(_TOLD, line)


def _first(form: re.Pattern[str], text: str) -> str:
    found = form.search(text.replace('−', '-'))
    return next(filter(None, found.groups()), '') if found else ''


def _zone_of(name: str) -> tzinfo | None:
    """Return a zone by its name, its letters, or how far it is ahead of UTC; None for another."""
    text = str(ZONES.get(name.upper(), name))
    if re.fullmatch(f'[-+]?{_SIZE}', text):
        ahead = _seconds(text)
        is_one = ahead % _QUARTER == 0.0 and abs(ahead) <= 3600.0 * _FARTHEST
        return timezone(timedelta(seconds=ahead)) if is_one else None
    try:
        return ZoneInfo(name)
    except (ZoneInfoNotFoundError, ValueError, OSError):
        return None


def _seconds(text: str) -> float:
    """Read an offset: ``+02:00``, ``-0330``, hours such as ``5.5``, or larger numbers of [s]."""
    hours, _, minutes = text.lstrip('+-').partition(':')
    if len(hours) == 4 and hours.isdecimal() and float(hours[:2]) <= _FARTHEST:
        hours, minutes = hours[:2], hours[2:]
    size = float(hours)
    seconds = size if size > _FARTHEST else 3600.0 * size + 60.0 * float(minutes or 0.0)
    return -seconds if text.startswith('-') else seconds


def _moved(times: Times, zone: tzinfo) -> Times:
    """Return times on the clock of a zone as those of UTC."""
    epoch = times.epoch or 0.0
    if (fixed := zone.utcoffset(None)) is not None:  # without summer time
        return times._replace(epoch=epoch - fixed.total_seconds())
    begin = datetime(1970, 1, 1, tzinfo=zone) + timedelta(seconds=epoch)
    passed = [0.0, *np.nan_to_num(times.seconds).tolist()]
    moments = (begin + timedelta(seconds=each) for each in passed)
    shift, *shifts = ((each.utcoffset() or timedelta()).total_seconds() for each in moments)
    return times._replace(seconds=times.seconds - shifts + shift, epoch=epoch - shift)
