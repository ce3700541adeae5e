# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
METAR, the reports of airports: ``EDDF 221150Z 24015G27KT ...``, a line each.

The group of the wind is where it comes from in degrees, its mean speed and maybe its gust (WMO
Manual on Codes 306, FM 15). A report has the day of the month and no month: one whose day is
smaller than that of the report before is on the next day. The newest may be first. A date beside
the first one, as of Ogimet, is that of the record.
"""

from __future__ import annotations

from dataclasses import replace
from math import radians
from pathlib import Path
import re

import numpy as np

from tree_sway.core.wind import velocity_of_bearing
from tree_sway.files.column_names import unit_factor
from tree_sway.files.text_file import read_lines
from tree_sway.files.time_stamps import dates
from tree_sway.files.wind.record import WindRecord, WindRows
from tree_sway.files.wind.station_means import filled_means

METAR = re.compile(
    r'\b(\d\d)(\d\d)(\d\d)Z\b.*?\b(\d{3}|VRB|///)(\d\d\d?|//)(?:G(\d\d\d?))?(KT|MPS|KMH)\b',
    re.ASCII,
)
_DATE = re.compile(r'\b20\d\d-?\d\d-?(\d\d)')
"""Year, month and day beside a report."""
_HALF_MONTH = 150_000
"""Half a month as a difference of days, hours and minutes in one number."""
_MEAN = 600.0
"""Length of the mean of a report in [s] (WMO Manual on Codes 306, FM 15)."""


def read_metar_wind(path: Path, turbulence: bool = True, seed: float = 0) -> WindRecord:
    """
    Read the wind of METAR reports, with turbulence about them as in `filled_means`.

    A `FormatError` reports a missing one.
    """
    rows = WindRows(str(path))
    gusts = list[float]()
    day = 0
    passed = 0
    epoch = None
    lines = enumerate(map(METAR.search, read_lines(path)), start=1)
    reports = [(number, report) for number, report in lines if report]
    steps = np.diff([int(''.join(report.groups()[:3])) for _, report in reports])
    # The newest one may be first; a step of many days is the end of a month.
    steps = steps[np.abs(steps) < _HALF_MONTH]
    for number, report in reports[:: -1 if (steps < 0).sum() > (steps > 0).sum() else 1]:
        today, hour, minute = (int(report[i]) for i in (1, 2, 3))
        date = None if day else _DATE.search(report.string)
        if date and int(date[1]) == today:
            epoch = dates([date[0]]).epoch
        if today != day:
            passed += max(today - day, 1) if day else 0
            day = today
        if not report[5].isdigit() or not (report[4].isdigit() or report[5] == '00'):
            rows.refuse(number, f"no direction or speed in '{report[4]}{report[5]}'")
            continue
        unit = unit_factor('speed', report[7]) or 1.0
        bearing = radians(float(report[4])) if report[4].isdigit() else 0.0
        time = 86400.0 * passed + 3600.0 * hour + 60.0 * minute
        gusts.append(unit * float(report[6]) if report[6] else np.nan)
        rows.add(number, time, velocity_of_bearing(unit * float(report[5]), bearing))
    rows.gust = np.array(gusts)
    record = rows.record(epoch=epoch)
    if len(record.time) == 1:
        record = _ten_minutes(record)
    return filled_means(record, turbulence, seed, least=2)


def _ten_minutes(record: WindRecord) -> WindRecord:
    """Return the wind of one report over the ten minutes that its mean is taken of."""
    twice = replace(
        record,
        time=np.array([0.0, _MEAN]),
        velocity=np.repeat(record.velocity, 2, axis=0),
        gust=None if record.gust is None else np.repeat(record.gust, 2),
    )
    return twice.with_note('one report, of the mean over ten minutes: a record of that length')
