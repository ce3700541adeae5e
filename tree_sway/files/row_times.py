# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Times of the rows of a table: in one column, or in columns of their parts."""

from __future__ import annotations

from collections.abc import Sequence
import re

import numpy as np

from tree_sway.files.column_names import folded, is_named, name_and_unit, TIME_PARTS
from tree_sway.files.makers import maker_of
from tree_sway.files.table_file import TextTable
from tree_sway.files.text_file import finite
from tree_sway.files.time_stamps import dates, lacks_zone, TIME_OF_DAY, Times, times_of, unwrapped
from tree_sway.files.time_zone import in_utc

Clock = tuple[list[int], str, float]
"""Columns of the time, the form of several, and the factor to [s]."""
PARTS = {tuple(names.split()): form for names, form in TIME_PARTS.items()}
"""Columns that make a time together, and the form of a date or of seconds with all of them."""
_LOOKED_AT = 20
"""Rows that are looked at for which of several columns has the time."""

_RATE = re.compile(
    r'(?:(?:rate|frequency)\W*|\bat )(\d+\.?\d*)\s*Hz|Delta_X\s+(\d+[.,]\d+)', re.IGNORECASE
)
"""Samples per second, or the seconds of one as in files of LabVIEW."""

_MIDNIGHT = re.compile('[T ]00:')


def time_columns(table: TextTable) -> Clock | None:
    """Columns of the time, the form of several, and the factor to [s]; None without a time."""
    names = [folded(name_and_unit(column, 'time')[0]) for column in table.columns]
    for wanted, form in PARTS.items():
        places = [names.index(name) for name in wanted if name in names]
        if len(places) == len(wanted):
            return places, form, 1.0
    first = table.rows[:_LOOKED_AT]
    columns = range(len(table.columns))  # of any name, or without one as an index
    texts = [[*filter(None, map(str.strip, table.cells(each, first)))] for each in columns]
    of_day = [i for i in columns if texts[i] and all(map(TIME_OF_DAY.fullmatch, texts[i]))]
    clocks = table.find_all('time')
    clocks.sort(key=lambda each: (not _run_on(texts[each]), each in of_day))
    dated = [each for each in columns if _are_dates(texts[each])]
    is_letter = [len(names[each]) == 1 and _run_on(texts[dated[0]]) for each in clocks if dated]
    if not clocks or not _run_on(texts[clocks[0]]) or any(is_letter[:1]):  # as T, a temperature
        clocks = dated[:1] or clocks
    if not clocks:
        return None
    days = [each for each in dated if not any(':' in cell for cell in texts[each])]
    if days and of_day and clocks[0] in (*days, *of_day):
        return [days[0], of_day[0]], '{0} {1}', 1.0
    if clocks[0] in dated:  # what is in brackets is no unit then
        return [clocks[0]], '', 1.0
    unit = table.unit_of(clocks[0], 'time') or maker_of(table).get('time')
    return [clocks[0]], '', table.known_factor('time', unit) if unit else 1.0


def by_own_clock(
    table: TextTable, clock: Clock, columns: Sequence[int]
) -> tuple[TextTable, Clock]:
    """
    Return the rows of some channels of those that have times of their own, and these times.

    They are in the last column before each one of those of the name of the clock. A `FormatError`
    refuses channels whose times differ by more than half a step.
    """
    name = table.columns[clock[0][0]]
    alike = [index for index, each in enumerate(table.columns) if each == name]
    clocks = [index for index in alike if any(table.cells(index, table.rows[:_LOOKED_AT]))]
    if len(clocks) < 2 or len(clock[0]) > 1 or not columns:
        return table, clock
    own = sorted({max([clocks[0], *filter(column.__gt__, clocks)]) for column in columns})
    part = table.part(row for row, cell in enumerate(table.cells(own[0], table.rows)) if cell)
    times = part.values(own)
    apart = np.abs(times - times[:, :1]).max(initial=0.0)
    if apart > 0.5 * np.median(np.abs(np.diff(times[:, 0])) if len(times) > 1 else [0.0]):
        raise part.error(f"several times '{name}', which differ", cure='keep one, and its columns')
    return part, (own[:1], *clock[1:])


def counted_times(table: TextTable) -> Times | None:
    """Return times by the rate that is told above the header; None without one."""
    told = _RATE.search('\n'.join(table.above))
    if told is None:
        return None
    rate, step = (float((each or '0').replace(',', '.')) for each in told.groups())
    hertz = 1.0 / step if step else rate
    if hertz <= 0.0:
        return None
    counts = np.array(table.rows, dtype=np.float64)
    for index in table.find_all('counter')[:1]:
        told_counts = table.values([index])[:, 0]
        counts = counts if np.isnan(told_counts).any() else unwrapped(told_counts)
    return Times((counts - counts[:1]) / hertz, None, f'times are by the rate of {hertz:g} Hz')


def _are_dates(cells: Sequence[str]) -> bool:
    """Whether cells are dates; none is a number."""
    has_numbers = any(finite(cell) is not None for cell in cells)
    return not has_numbers and dates(cells).epoch != 0.0


def _run_on(cells: Sequence[str]) -> bool:
    """Tell whether cells are times that run one way, as temperatures called Ts do not."""
    if not cells:
        return False
    seconds = times_of(cells).seconds
    seconds = seconds[np.isfinite(seconds)]
    if len(seconds) < 2:
        return len(seconds) == 1
    steps = np.diff(seconds)
    return bool((steps > 0.0).any() != (steps < 0.0).any())


def row_times(
    table: TextTable, columns: Sequence[int], form: str, factor: float, rows: Sequence[int]
) -> Times:
    """Return the times of some rows, in UTC where the table says its zone."""
    cells = [table.cells(column, rows) for column in columns]
    stamps = cells[0]
    if form:  # a date alone may have a midnight behind it
        parts = zip(*cells, strict=True)
        stamps = [form.format(_MIDNIGHT.split(day)[0], *others) for day, *others in parts]
    times = _of_one_year(times_of(stamps, factor))
    has_unit = form or factor != 1.0
    is_dated = times.epoch is not None
    if not (has_unit or is_dated or times.note):
        note = _doubt(table, columns[0], times)
        times = times._replace(note=note)
    names = [table.columns[column] for column in columns]
    if not form and names[0] and not is_named(names[0], 'time'):
        said = f'{names[0]} is taken as the time, by its dates'
        times = times._replace(note='; '.join(filter(None, (said, times.note))))
    first = next(filter(None, stamps), '')
    return in_utc(table, columns, times) if is_dated and lacks_zone(first) else times


def _of_one_year(times: Times) -> Times:
    """Return the months of a typical year, which are of several, in the first of these years."""
    known = np.isfinite(times.seconds)
    if times.epoch is None or not known.any():
        return times
    since_1970 = times.epoch + times.seconds[known]
    months = since_1970.astype('datetime64[s]').astype('datetime64[M]')
    years = months.astype('datetime64[Y]')
    moved = years[0].astype('datetime64[M]') + months.astype(np.int64) % 12
    shift = moved.astype('datetime64[s]') - months.astype('datetime64[s]')
    seconds = times.seconds.copy()
    seconds[known] += shift.astype(np.float64)
    goes_back = (np.diff(since_1970) < 0.0).any()
    is_apart = goes_back or len(np.unique(years)) > 2
    rises = (np.diff(seconds[known]) > 0.0).all()
    if not (is_apart and rises):
        return times
    note = f'months of several years are taken as those of {years[0]}'
    return times._replace(seconds=seconds, note=note)


def _doubt(table: TextTable, column: int, times: Times) -> str:
    """Return a note on whole seconds that no header tells, as they may be hours or days."""
    known = np.isfinite(times.seconds)
    steps = np.diff(times.seconds[known])
    name = table.columns[column]
    has_unit = 'sec' in name.lower() or table.unit_of(column, 'time')
    if has_unit or not len(steps):
        return ''
    step = float(np.median(np.abs(steps)))
    if step < 1.0 or step % 1.0:
        return ''
    last = float(times.seconds[known].max())
    if (steps % 100.0 == 0.0).all() and last < 2400.0:
        raise table.error(
            f'{name} goes by {step:g} up to {last:g}: hours and minutes, or seconds',
            cure=f'write 01:00 for 100, with the date, or call it {name} [s]',
        )
    return f'no unit of {name} in the header: taken in s; call it time [h] or time [days] if it is'
