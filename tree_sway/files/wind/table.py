# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Wind in tables: CSV with a header, and the layouts of loggers, stations and services.

A table has a time, and either components ``u, v`` and perhaps ``w``, or a speed and a direction in
degrees clockwise from north or as a point of the compass. Names and units are compared however
they are written (`column_names`). Components point where the wind blows to, a direction is where
it comes from; ``direction_convention`` changes that.

Rows 20 s and more apart are means of a station or of a reanalysis: turbulence is added to them, by
the column of gusts if there is one (`filled_means`). A row that is not numbers is refused.
"""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from dataclasses import replace
from math import inf
from pathlib import Path
import re

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.wind import WindConvention
from tree_sway.errors import ParameterError
from tree_sway.files.column_names import FILES_OF, folded, is_named, rank_of
from tree_sway.files.layouts.known import looks_like_wind, table_of
from tree_sway.files.makers import maker_of
from tree_sway.files.row_times import row_times, time_columns
from tree_sway.files.table_file import Column, TextTable
from tree_sway.files.text_file import finite
from tree_sway.files.wind.cell_units import with_units_in_head
from tree_sway.files.wind.record import WindRecord, WindRows
from tree_sway.files.wind.row_winds import winds_of_components, winds_of_directions
from tree_sway.files.wind.speed_units import speed_factor
from tree_sway.files.wind.station_means import filled_means
from tree_sway.files.zipped import table_in

_COMPONENTS = ('wind_x', 'wind_y', 'wind_z')
_BACK = 0.9
"""Least share of a wind that is along where it comes from, of components that tell this."""
_HEIGHT = re.compile(
    r'(?:^|(?<=[ _@]))\W?(?:at? )?(\d+(?:\.\d+)?) ?m(?:[\])](?: |$)|_|(?: |$))|'
    r'(?<=[a-z])(\d+)m[NESW]{0,2}(?=$| ?[\[(])'
)
"""Height before, in or behind a name: ``40m Wind Speed``, ``Wind Speed (m/s) at 39m``, Spd80mN."""
_WIND = ('wind_speed', 'wind_direction', *_COMPONENTS, 'gust')
_PLACES = ('x', 'east')
"""Names of a first component that is a place where a table has a speed and a direction."""
_WANTED = {'the time': 'time', 'the speed': 'speed [m/s]', 'the direction': 'direction [deg]'}
"""What a table of wind needs, and how to name the column of it."""
_CIRCLE = 2.0 * np.pi
_USUAL = 10.0
"""Height of the wind of stations and services [m]."""


def read_table_wind(
    path: Path,
    columns: tuple[str, ...] | None = None,
    direction_convention: str | None = None,
    yaw: float = 0.0,
    turbulence: bool = True,
    seed: float = 0,
    speed_unit: str | None = None,
    direction: float | None = None,
) -> WindRecord:
    """
    Read the wind of a table, given as components (``to``) or as a direction (``from``).

    ``columns`` are the two or three of the components, found by their usual names if None. ``yaw``
    is from east to the sensor's x axis, counter-clockwise, in [rad]; for a direction, from north
    to the sensor's zero, likewise. Means get ``turbulence`` of a ``seed``. ``speed_unit`` is for
    speeds without one, ``direction`` in degrees for a table without one. A `FormatError` reports a
    missing column, an unknown unit, or no good row.
    """
    WindConvention(direction_convention or 'to')  # refused before the file is read
    if direction is not None and not 0.0 <= direction <= 360.0:
        raise ParameterError(f'direction is {direction:g} degrees', cure='give 0 to 360')
    name, lines = table_in(path, looks_like_wind)
    whole = table_of(lines, name)
    whole.refuse_several()
    table, at_height = _at_one_height(whole)
    table = with_units_in_head(table)
    rows = WindRows(table.source)
    time = time_columns(table)
    places = _components(table, columns)
    if time is not None and places:
        told = [speed_factor(table, place, 'wind_x', speed_unit) for place in places]
        components = [Column(at, factor) for at, (factor, _) in zip(places, told, strict=True)]
        notes = [at_height, told[0][1], _repeated(table, components[0], 'wind_x')]
        winds = winds_of_components(table, components, rows)
        back = '' if direction_convention else _points_back(table, time[0], winds)
        notes.append(back)
        convention = direction_convention or ('from' if back else 'to')
    else:
        found = table.find('wind_speed')
        taken = list(time[0]) if time else []  # of which DD is a day and no direction
        if found is not None:
            taken.append(found.index)
        from_where, usual = _direction(table, taken, direction)
        _refuse_missing(whole, time, *(places[:2] or (found, from_where)))
        assert found is not None
        assert from_where is not None
        factor, in_unit = speed_factor(table, found.index, 'wind_speed', speed_unit)
        speed = Column(found.index, factor)
        convention = direction_convention or usual
        winds = winds_of_directions(table, speed, from_where, rows, yaw, convention)
        repeated = _repeated(table, speed, 'wind_speed')
        notes = [at_height, in_unit, repeated, _doubt(table, from_where)]
        yaw, convention = 0.0, 'to'
    assert time is not None
    stored = np.flatnonzero(np.isfinite(winds).all(axis=1))
    times = row_times(table, *time, stored.tolist())
    steps = np.diff(times.seconds)
    if np.count_nonzero(steps < 0.0) > np.count_nonzero(steps >= 0.0):
        # The newest row first, as services export them, maybe with one twice.
        stored = stored[::-1]
        times = row_times(table, *time, stored.tolist())
    _fill(rows, table, winds[stored], stored, times.seconds, speed_unit)
    record = rows.record(
        epoch=times.epoch,
        yaw=yaw,
        direction_convention=convention,
        notes=(*notes, times.note, whole.note),
    )
    return filled_means(record, turbulence, seed)


def _at_one_height(table: TextTable) -> tuple[TextTable, str]:
    """Return a table with the columns of the lowest height of each wind alone, and which it is."""
    for index in table.find_all('height')[:1]:
        rows = table.rows_by(index)
        sizes = {*map(len, rows.values())}
        if len(rows) > 1 and len(sizes) == 1 and sizes != {1}:
            least = min(rows, key=lambda height: finite(height) or inf)
            note = f'the wind at {least} of the heights {", ".join(rows)[:80]}'
            return table.part(rows[least]), note
    heights = list[tuple[str, int, float]]()
    lowest: dict[str, float] = {}
    names = list(table.columns)
    for index, name in enumerate(names):
        if at := _HEIGHT.search(name):
            plain = f'{name[: at.start()]} {name[at.end() :]}'.strip()
            for quantity in [each for each in _WIND if is_named(plain, each)][:1]:
                names[index] = plain
                height = float(at[1] or at[2])
                heights.append((quantity, index, height))
                lowest[quantity] = min(height, lowest.get(quantity, height))
    if not heights:
        return table, ''
    for quantity, index, height in heights:
        names[index] = names[index] if height == lowest[quantity] else ''
    known = {height for quantity, _, height in heights if quantity != 'wind_direction'}
    first = lowest.get('wind_speed', next(iter(lowest.values())))
    others = sorted(known - {first})
    more = f'; there is one at {", ".join(f"{each:g}" for each in others)} m' if others else ''
    note = '' if known == {_USUAL} else f'the wind at {first:g} m{more}'
    return replace(table, columns=tuple(names)), note


def _direction(
    table: TextTable, taken: Sequence[int], given: float | None
) -> tuple[Column | float | None, str]:
    """Column of the direction, else the given one, and whether it is ``from`` or ``to`` there."""
    quantity = 'wind_direction' if table.find_all('wind_direction') else 'wind_to'
    for place in table.find_all(quantity):
        if place not in taken:
            return _angle_in(table, place), 'to' if quantity == 'wind_to' else 'from'
    return given, 'from'


def _angle_in(table: TextTable, place: int) -> Column:
    """Return a column of angles with the factor of its unit, which is degrees if nothing tells."""
    unit = table.unit_of(place, 'wind_direction') or maker_of(table).get('direction')
    return Column(place, table.known_factor('angle', unit or 'deg'))


def _points_back(table: TextTable, taken: Sequence[int], winds: Floats) -> str:
    """Return a note on components to where the wind comes from, by the direction beside them."""
    told = (*table.find_all('wind_direction'), *table.find_all('azimuth'))
    for place in [each for each in told if each not in taken][:1]:
        angle = table.values([place])[:, 0] * _angle_in(table, place).factor
        along = winds[:, 0] * np.sin(angle) + winds[:, 1] * np.cos(angle)
        known = np.isfinite(along)
        if along[known].sum() > _BACK * np.hypot(*winds[known, :2].T).sum() > 0.0:
            return f'by {table.columns[place]} the components tell where the wind comes from'
    return ''


def _repeated(table: TextTable, used: Column, quantity: str) -> str:
    """Return a note on a used column of which there are more with names as good."""
    name = table.columns[used.index]
    rank = rank_of(name, quantity)
    alike = [each for each in table.columns if each and rank_of(each, quantity) == rank]
    if len(alike) < 2 or rank is None:
        return ''
    names = list(dict.fromkeys(alike))
    which = 'the first' if len(names) == 1 else name
    return f'of {len(alike)} columns {", ".join(names)} {which} is read'


def _components(table: TextTable, names: tuple[str, ...] | None) -> list[int]:
    """Places of the components: of given names or the usual ones; none without two of them."""
    if names is not None:
        return [table.index_of(name) for name in names]
    found = [table.find(each) for each in _COMPONENTS]
    if found[0] is None or found[1] is None:
        return []
    is_place = folded(table.columns[found[0].index]) in _PLACES
    is_wind = table.find('wind_speed') and table.find('wind_direction')
    stem = folded(Path(table.source).stem)  # as Accelerometer.csv of a phone
    if is_place and (is_wind or any(words.search(stem) for words in FILES_OF.values())):
        return []
    return [column.index for column in found if column is not None]


def _refuse_missing(table: TextTable, *found: object) -> None:
    """Raise a `FormatError` that names the columns of `_WANTED` that are None."""
    missing = [each for each, column in zip(_WANTED, found, strict=True) if column is None]
    if not missing:
        return
    what = f'no column for {" and none for ".join(missing)} among {", ".join(table.columns[:20])}'
    cure = f'call it {" and ".join(_WANTED[each] for each in missing)} in the header'
    if 'the speed' in missing:
        cure += ', or name the components: --wind-option columns=u,v'
    elif missing == ['the direction']:
        cure += ', or give one for all rows: --wind-option direction=270'
    raise table.error(what, cure=cure)


def _doubt(table: TextTable, direction: Column | float) -> str:
    """Return a note on directions without a unit that may be radians."""
    if isinstance(direction, float) or table.unit_of(direction.index, 'wind_direction'):
        return ''
    values = table.values([direction.index])
    known = np.abs(values[np.isfinite(values)])
    is_told = maker_of(table).get('direction')
    if is_told or (known > _CIRCLE).any() or not (known % 1.0).any():
        return ''
    name = table.columns[direction.index]
    return f'no {name} is above 6.3: taken in degrees; call it {name} [rad] if it is'


def _fill(
    rows: WindRows, table: TextTable, winds: Floats, stored: Ints, seconds: Floats,
    unit: str | None,
) -> None:  # fmt: skip
    """Put good rows, in the order of their times, into a record's rows, with their gusts."""
    rows.number = array('q', [table.numbers[row] for row in stored.tolist()])
    rows.velocity = array('d', winds.ravel())
    rows.time = array('d', seconds)
    speeds = table.find_all('wind_speed')[:1]
    for gust in [each for each in table.find_all('gust') if each not in speeds][:1]:
        factor, _ = speed_factor(table, gust, 'gust', unit)
        values = table.values([gust])[stored, 0] * factor
        rows.gust = np.where((values >= 0.0) & (values <= 150.0), values, np.nan)
