# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Times of loggers, stations and services: dates in any usual order, 12-hour clocks, and numbers.

A date is ISO 8601, ``2024/03/01``, ``01.03.2024``, ``3/1/24``, ``1 Mar 2024``, ``202403011200`` or
the day of a year, ``2024-061``, with a time of 24 or of 12 hours, and maybe a zone. Whether
``3/1/24`` has the month first is seen in the whole column. Numbers are seconds, or if they are as
large as the time since 1970 in s, ms, us or ns, that; or the days of Excel, of MATLAB, or Julian
ones.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from datetime import date, timedelta
from itertools import pairwise
import math
import re
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.files.text_file import finite
from tree_sway.tables import table_beside

_STAMP = re.compile(
    r'(\d{4}-\d\d-\d\d[ T]\d\d:\d\d(?::\d\d(?:\.\d{1,9})?)?)(Z|[+-]\d\d:?\d\d)?', re.ASCII
)
_MONTHS = 'jan feb mar apr may jun jul aug sep oct nov dec'.split()
_DATES = (
    r'(?P<year>\d{4})[-/.](?P<month>\d\d?)[-/.](?P<day>\d\d?)',
    r'(?P<first>\d\d?)(?P<sign>[-/. ])(?P<second>\d\d?)[-/. ](?P<year>\d{4}|(?<! )\d\d)',
    r'(?P<year>\d{4})(?P<month>\d\d)(?P<day>\d\d)',
    r'(?P<day>\d\d)(?P<month>\d\d)(?P<year>(19|20)\d\d)',
    r'(?P<day>\d\d?)[- ](?P<month>[A-Za-z]{3})[a-z]*[-, ]+(?P<year>\d{4}|\d\d)',
    r'(?P<month>[A-Za-z]{3})[a-z]* (?P<day>\d\d?),? (?P<year>\d{4})',
    r'(?P<year>\d{4})-(?P<of_year>\d{3})(?!\d)',
)
_CLOCK = (
    r'(?:[T,_: ]*(?P<hour>\d\d?)(?::?(?P<minute>\d\d))?(?::?(?P<seconds>\d\d(?:[.,:]\d+)?))?'
    r'\s*(?P<half>[apAP]\.?(?:[mM]\.?)?)?)?'
)
_ZONE = r'\s*(?P<zone>Z|UTC|GMT|[+-]\d\d(?::?\d\d)?)?'
_FORMS = tuple(re.compile(date + _CLOCK + _ZONE, re.ASCII) for date in _DATES)
_ORDERED = _FORMS[1]
"""Dates such as 3/1/24, of which the order tells day and month."""
_DIGITS = re.compile(r'(19|20)\d\d(0[1-9]|1[0-2])(0[1-9]|[12]\d|3[01])([01]\d|2[0-4])?(\d\d){0,2}')
_SINCE_1970 = ((1e17, 1e-9), (1e14, 1e-6), (1e11, 1e-3), (5e8, 1.0))
"""Least number that is a time since 1970, and its unit in [s]: each is of 1973 or later."""

_DAYS = [tuple(row.values()) for row in table_beside(__file__, 'day_counts.csv')]
"""Least and largest number of a count of days, that of 1970-01-01, and its name."""
_SERIALS = _DAYS[:3]
"""Counts of days whose numbers overlap."""
_MANY_HOURS = 0.2
"""Step of days that counts of seconds have as well, in [d]."""

_COUNTERS = (2.0**16, 2.0**32)
"""Numbers at which counters begin anew."""
_LONGEST_STEP = 100.0
"""Longest step over that number, in usual steps."""

_NONE = np.iinfo(np.int64).min
_1970 = date(1970, 1, 1)


class Times(NamedTuple):
    """
    Times of rows.

    ``seconds`` are after ``epoch``, NaN where there is none; ``epoch`` is in seconds after
    1970-01-01, None if the file has no dates. ``note`` is what was assumed; may be empty.
    """

    seconds: Floats
    epoch: float | None
    note: str = ''


TIME_OF_DAY = re.compile(r'\d{1,2}:\d\d(?::\d\d(?:[.,:]\d+)?)?\s*(?:[AaPp]\.?[Mm]\.?)?')


def times_of(stamps: Sequence[str], factor: float = 1.0) -> Times:
    """
    Return the times of texts: numbers of a unit ``factor`` in [s], or dates.

    Whether they are numbers is decided by the first that is neither empty nor not a number.
    """
    first = next(
        (text for stamp in stamps if (text := stamp.strip()).lower() not in ('', 'nan')), ''
    )
    if first.endswith(' sec'):  # durations of MATLAB
        return times_of([stamp.removesuffix(' sec') for stamp in stamps], factor)
    if finite(first) is None or _DIGITS.fullmatch(first):
        return dates(stamps)
    values = unwrapped(np.array([*map(finite, stamps)], dtype=np.float64))
    origin = float(values[np.isfinite(values)][0])
    size = abs(origin)  # what begins at 0 is no date
    days = _days(values, factor)
    if days is not None and days.epoch is not None:
        return days
    note = '' if days is None else days.note
    if factor == 1.0:
        factor = next((unit for least, unit in _SINCE_1970 if size >= least), 1.0)
    if size * factor < _SINCE_1970[-1][0]:
        return Times(values * factor, None, note)
    return Times((values - origin) * factor, origin * factor)


def unwrapped(counts: Floats) -> Floats:
    """Return counts of 16 or 32 bits that begin anew at 0 without their steps back."""
    steps = np.diff(counts)
    forth = steps[steps > 0.0]
    is_back = steps < 0.0
    if not is_back.any() or not len(forth):
        return counts
    most = _LONGEST_STEP * float(np.median(forth))
    for size in _COUNTERS:
        over = steps[is_back] + size
        if bool(((over > 0.0) & (over <= most)).all()):
            return counts + size * np.concatenate([[0.0], np.cumsum(is_back)])
    return counts


def _days(values: Floats, factor: float) -> Times | None:
    """
    Return the times of counts of days; None if they are none.

    Without a unit, the step tells them from seconds: 10 min are 0.00694 d, and loggers' steps are
    whole milliseconds. Where both may be, there is no epoch but a note.
    """
    known = values[np.isfinite(values)]
    if not len(known) or factor not in (1.0, 86400.0):
        return None
    least, most = float(known.min()), float(known.max())
    kind = next((each for each in _DAYS if each[0] <= least and most < each[1]), None)
    if kind is None:
        return None
    _, _, of_1970, title = kind
    step = float(np.median(np.abs(np.diff(known)))) if len(known) > 1 else 0.0
    is_round = abs(step * 1e3 - round(step * 1e3)) < 1e-3 and step >= 1e-3
    if factor == 1.0 and (is_round or not 0.0 < step < _MANY_HOURS):
        return Times(values, None, f'times are taken as seconds, not as {title}')
    first = float(known[0])
    seconds = np.round((values - first) * 86400.0, 3)
    note = f'times are taken as {title}, from {_day(first - of_1970)}'
    if kind in _SERIALS:
        others = [each for each in _SERIALS if each != kind]
        note += ''.join(f'; as {each[3]} from {_day(first - each[2])}' for each in others)
    return Times(seconds, (first - of_1970) * 86400.0, note)


def _day(days: float) -> str:
    """Return the date of a number of days after 1970-01-01."""
    return (_1970 + timedelta(days=math.floor(days))).isoformat()


def dates(stamps: Sequence[str]) -> Times:
    """Return the times of dates, NaN for other texts; those without a zone are taken as UTC."""
    texts = [stamp.strip() for stamp in stamps]
    if all(TIME_OF_DAY.fullmatch(text) for text in texts if text) and any(texts):
        return _clocks(texts)
    is_month_first, note = _order(texts)
    found = (_microseconds(text, is_month_first) for text in texts)
    microseconds = np.fromiter(found, np.int64, len(texts))
    is_good = microseconds != _NONE
    # Differences in whole numbers first: a date in float64 seconds is good to 0.2 us only.
    first = int(microseconds[is_good][0]) if is_good.any() else 0
    seconds = np.full(len(texts), np.nan)
    seconds[is_good] = (microseconds[is_good] - first) / 1e6
    return Times(seconds, first / 1e6, note)


def lacks_zone(stamp: str) -> bool:
    """Whether a text is a date without a zone, on some clock or on that of UTC."""
    text = stamp.strip()
    found = [each for form in _FORMS if (each := form.fullmatch(text))]
    is_date = finite(text) is None or _DIGITS.fullmatch(text) is not None
    return is_date and bool(found) and not any(each['zone'] for each in found)


def _clocks(texts: Sequence[str]) -> Times:
    """Return the times of a clock without dates, a day later where it begins anew."""
    days = dates([f'2000-01-01 {text}' if text else '' for text in texts])
    seconds = days.seconds.copy()
    known = np.isfinite(seconds)
    steps = np.diff(seconds[known], prepend=seconds[known][:1])
    seconds[known] += 86400.0 * (np.cumsum(steps < -43200.0) - np.cumsum(steps > 43200.0))
    return Times(seconds, None, 'the times have no date')


def _order(texts: Sequence[str]) -> tuple[bool, str]:
    """Whether dates such as 3/1/24 have the month first, and what was assumed."""
    first = next((text for text in texts if text), '')
    match = _ORDERED.fullmatch(first)
    if match is None or match['sign'] == '.':
        return False, ''
    found = [each for text in texts if (each := _ORDERED.fullmatch(text))]
    if any(int(each['first']) > 12 for each in found):
        return False, ''
    if any(int(each['second']) > 12 for each in found):
        return True, ''
    steps = []  # the sum of all is smallest in the right order
    for is_month_first in (True, False):
        times = [_general(each, is_month_first) for each in found]
        steps.append(sum(abs(b - a) for a, b in pairwise(times)))
    if steps[0] != steps[1]:
        return steps[0] < steps[1], ''
    is_american = any(each['half'] for each in found)
    order = 'month, day' if is_american else 'day, month'
    return is_american, f'dates such as {first[:20]} are taken as {order}'


def _microseconds(stamp: str, is_month_first: bool) -> int:
    """Microseconds after 1970-01-01, `_NONE` for other text than a date."""
    match = _STAMP.fullmatch(stamp)
    if match is not None:
        with suppress(ValueError):  # 24:00, a month 13 or a February 30
            microseconds = int(np.datetime64(match[1], 'us').astype(np.int64))
            return microseconds - 1_000_000 * _offset(match[2])
    forms = (form.fullmatch(stamp) for form in _FORMS)
    return max((_general(each, is_month_first) for each in forms if each), default=_NONE)


def _general(match: re.Match[str], is_month_first: bool) -> int:
    """Microseconds after 1970-01-01 of a date in any order; `_NONE` if it is impossible."""
    try:
        day = _date(match, is_month_first)
    except (ValueError, OverflowError):
        return _NONE
    hour = int(match['hour'] or 0)
    minute = int(match['minute'] or 0)
    seconds = float((match['seconds'] or '0').replace(',', '.').replace(':', '.'))
    if match['half']:
        if not 1 <= hour <= 12:
            return _NONE
        hour = hour % 12 + (12 if match['half'][0] in 'pP' else 0)
    if hour > 24 or minute > 59 or seconds >= 60.0 or (hour == 24 and minute):
        return _NONE
    days = (day - _1970).days
    whole = 86400 * days + 3600 * hour + 60 * minute - _offset(match['zone'])
    return whole * 1_000_000 + round(seconds * 1e6)


def _date(match: re.Match[str], is_month_first: bool) -> date:
    year = int(match['year'])
    if len(match['year']) == 2:
        year += 2000 if year < 70 else 1900
    if match.re is _ORDERED:
        one, two = int(match['first']), int(match['second'])
        return date(year, one, two) if is_month_first else date(year, two, one)
    if 'of_year' in match.re.groupindex:
        return date(year, 1, 1) + timedelta(days=int(match['of_year']) - 1)
    month = match['month'].lower()
    number = _MONTHS.index(month) + 1 if month.isalpha() else int(month)
    return date(year, number, int(match['day']))


def _offset(zone: str | None) -> int:
    """Seconds that a zone is ahead of UTC; 0 without one."""
    if not zone or zone[0] not in '+-':
        return 0
    sign = -1 if zone[0] == '-' else 1
    minutes = int(zone[-2:]) if len(zone) > 3 else 0
    return sign * (3600 * int(zone[1:3]) + 60 * minutes)
