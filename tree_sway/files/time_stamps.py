# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Time stamps of loggers: ISO 8601 dates with any number of digits after the second."""

from __future__ import annotations

from collections.abc import Sequence
import re

import numpy as np

from tree_sway.core.arrays import Floats

_STAMP = re.compile(
    r'(\d{4}-\d\d-\d\d[ T]\d\d:\d\d(?::\d\d(?:\.\d{1,9})?)?)(Z|[+-]\d\d:?\d\d)?', re.ASCII
)

_NONE = np.iinfo(np.int64).min


def seconds_of_stamps(stamps: Sequence[str]) -> tuple[Floats, float]:
    """
    Seconds of each stamp after the first good one, to the microsecond; NaN for another text.

    Stamps are such as ``2012-06-07 12:45:00.05`` or ``2012-06-07T12:45:00Z``; one without a zone
    is taken as UTC.

    Returns
    -------
    tuple
        The seconds, (n,), and the first good stamp in seconds after 1970-01-01; 0 if there is
        none.

    """
    microseconds = np.fromiter(map(_microseconds, stamps), np.int64, len(stamps))
    is_good = microseconds != _NONE
    # Differences in whole numbers first: a date in float64 seconds is good to 0.2 us only.
    first = int(microseconds[is_good][0]) if is_good.any() else 0
    seconds = np.full(len(stamps), np.nan)
    seconds[is_good] = (microseconds[is_good] - first) / 1e6
    return seconds, first / 1e6


def _microseconds(stamp: str) -> int:
    """Microseconds after 1970-01-01, `_NONE` for other text than a stamp."""
    match = _STAMP.fullmatch(_iso(stamp.strip()))
    if match is None:
        return _NONE
    try:
        microseconds = int(np.datetime64(match[1], 'us').astype(np.int64))
    except ValueError:  # a month 13 or a February 30
        return _NONE
    return microseconds - 1_000_000 * (_offset(match[2]) if match[2] else 0)


def _iso(stamp: str) -> str:
    """Year, month and day in the order of ISO 8601, from 2024/03/01 and 01.03.2024."""
    if stamp[4:5] == '/' or stamp[2:3] == stamp[5:6] == '.':
        stamp = stamp.replace('/', '-', 2)
        day, month, rest = [*stamp.split('.', 2), '', ''][:3]
        return f'{rest[:4]}-{month}-{day}{rest[4:]}' if '.' in stamp[:3] else stamp
    return stamp


def _offset(zone: str) -> int:
    """Seconds that a zone is ahead of UTC."""
    if zone == 'Z':
        return 0
    sign = -1 if zone[0] == '-' else 1
    return sign * (3600 * int(zone[1:3]) + 60 * int(zone[-2:]))
