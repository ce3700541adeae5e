# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Heights and stem diameters of the trees of an inventory, with their units.

A unit in the header or in the cells counts. Without one, heights are in m and diameters in cm;
they are in m, mm, inches or feet where only that makes trees: by their size, by height over
diameter, or as the trees stand in the United States. What was taken is a note.
"""

from __future__ import annotations

from functools import cache
import math

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.files.column_names import unit_factor
from tree_sway.files.makers import maker_of
from tree_sway.files.scenes.inventory.columns import InventoryColumns
from tree_sway.growth import height_of_stem

_TALLEST = 130.0
"""Height that no tree exceeds [m]; the tallest known is 116 m."""
_THICKEST = 12.0
"""Diameter at breast height that no tree exceeds [m]; the thickest known is 11.6 m."""
_SLENDER = (12.0, 130.0)
"""Usual heights over diameters of trees, for the choice of a unit."""
_THINNEST = 195.0
"""Height over diameter that the middle tree of no inventory exceeds."""
_MIDDLING = 45.0
"""Usual height over diameter of a tree of a city, up to a middling stem."""
_MIDDLING_STEM = 0.25
"""Diameter of a middling stem [m]."""
_HIGHEST_MIDDLE = 60.0
"""Median height that no inventory exceeds [m]."""
_INCH = 0.0254
_FOOT = 0.3048
_CM = 0.01
_MM = 0.001
_SAID = {1.0: 'm', _CM: 'cm', _MM: 'mm', _INCH: 'inches', _FOOT: 'feet'}


def diameters_of(columns: InventoryColumns) -> Floats:
    """Diameters at breast height [m], NaN without one."""
    found = np.full(columns.n_rows, np.nan)
    for quantity, over in (('diameter', 1.0), ('girth', math.pi)):
        stems = columns.table.find_all(quantity)[:1] or columns.numbered(quantity)
        if not stems:
            continue
        index = stems[0]
        name = columns.table.columns[index]
        told, maker = columns.table.unit_of(index, quantity), maker_of(columns.table)
        if not told and maker.get(quantity):
            told = maker[quantity]
            columns.note(f'{name} is in {told}, as of {maker["maker"]}')
        values, unit = columns.numbers(index, stems=True, unit=told)
        for each in stems[1:]:
            values = np.hypot(values, np.nan_to_num(columns.numbers(each, unit=unit)[0]))
        factor = unit_factor('length', unit)
        if factor is None:
            factor, why = _stem_unit(values / over, columns)
            columns.note(f'{name} is taken as {_SAID[factor]}{why}')
        columns.has_inches |= factor == _INCH
        own = values * factor / over
        _note_impossible(columns, index, own)
        own[~((own > 0.0) & (own <= _THICKEST))] = np.nan
        found = np.where(np.isnan(found), own, found)
    return found


def _note_impossible(columns: InventoryColumns, index: int, diameter: Floats) -> None:
    """Say which stems are thicker than any tree's and so do not count."""
    rows = np.flatnonzero(diameter > _THICKEST).tolist()
    if not rows:
        return
    first = rows[0]
    columns.note(
        f'{len(rows)} cells of {columns.table.columns[index]} do not count: {columns.line(first)} '
        f"is '{columns.cell(index, first)}', a stem of {diameter[first]:.3g} m"
    )


def _stem_unit(values: Floats, columns: InventoryColumns) -> tuple[float, str]:
    """Choose the unit of diameters that have none, and say why if it is inches."""
    positive = values[values > 0.0]
    middle = _middle(values)
    # Metres have fractions; a stem of 3 in whole numbers is a young tree's in inches or cm.
    has_fractions = bool((positive != np.round(positive)).any())
    if has_fractions and float(np.quantile(positive, 0.9)) <= 3.0:
        return 1.0, ''
    thin, thick = np.quantile(positive, (0.1, 0.9)) if len(positive) else (0.0, 0.0)
    if middle > 250.0 or thick > 250.0 > 4.0 * thin:  # no saplings among old giants
        return _MM, ''
    if columns.is_in_states:
        return _INCH, ', as the trees stand in the United States'
    heights = _read_heights(columns)
    if heights is None:
        return _CM, ''
    _, height, unit = heights
    factor = unit_factor('length', unit)
    if factor == _FOOT:
        return _INCH, ', as heights are in feet'
    ratio = _slenderness(height * (factor or 1.0), values * _CM)
    if ratio * _CM / _MM > _SLENDER[0] > ratio > 0.0:
        return _MM, ', by height over it'
    in_inches = ratio * _CM / _INCH
    if ratio > _SLENDER[1] and _SLENDER[0] < in_inches < _SLENDER[1]:
        return _INCH, ', by height over it'
    if factor is None and _SLENDER[0] < in_inches * _FOOT < _SLENDER[1]:
        # Feet and inches for metres and cm: nearly all trees would be too slender.
        if _slenderness(height, values * _CM, quantile=0.1) > _SLENDER[1]:
            return _INCH, ', by height in feet over it'
    return _CM, ''


def _middle(values: Floats) -> float:
    """Median of the positive values; 0 without one."""
    positive = values[values > 0.0]
    return float(np.median(positive)) if len(positive) else 0.0


def _slenderness(height: Floats, diameter: Floats, quantile: float = 0.5) -> float:
    known = (height > 0.0) & (diameter > 0.0)
    return float(np.quantile(height[known] / diameter[known], quantile)) if known.any() else 0.0


def _usual_slenderness(diameter: Floats) -> float:
    """
    Return the usual height over diameter of city trees with these stems.

    Trees in the open go on to thicken when they hardly grow higher: from middling stems on, the
    height goes as the square root of the diameter.
    """
    return _MIDDLING * math.sqrt(_MIDDLING_STEM / max(_MIDDLING_STEM, _middle(diameter)))


def _read_heights(columns: InventoryColumns) -> tuple[int, Floats, str] | None:
    """Column of heights whose name comes first, of those with a number; its numbers and unit."""
    first = None
    for index in columns.table.find_all('height'):
        unit = columns.table.unit_of(index, 'height')
        read = index, *columns.numbers(index, unit=unit)
        if np.isfinite(read[1]).any():
            return read
        first = first or read
    return first


def heights_of(columns: InventoryColumns, diameter: Floats) -> Floats:
    """Heights [m], NaN without one."""
    heights = _read_heights(columns)
    if heights is None:
        return np.full(columns.n_rows, np.nan)
    index, values, unit = heights
    factor = unit_factor('length', unit)
    name = columns.table.columns[index]
    is_in_states = columns.is_in_states
    if factor is None:
        factor = 1.0
        if unit:
            columns.note(f"{name}: '{unit[:40]}' is no known unit")
        ratio = _slenderness(values, diameter)
        # In the United States, and beside inches, heights are in feet or in metres.
        may_be_feet = is_in_states or columns.has_inches
        most = _usual_slenderness(diameter) / math.sqrt(_FOOT) if may_be_feet else _SLENDER[1]
        if ratio > most and _SLENDER[0] < ratio * _FOOT < _SLENDER[1]:
            factor = _FOOT
            columns.note(f'{name} is taken as feet, by height over diameter')
        elif not ratio and (is_in_states or _HIGHEST_MIDDLE < _middle(values) < _TALLEST / _FOOT):
            factor = _FOOT
            why = 'as the trees stand in the United States' if is_in_states else 'by their size'
            columns.note(f'{name} is taken as feet, {why}; call it {name} [m] if it is')
        elif not unit:
            columns.note(f'{name} is taken as m')
    height = values * factor
    ratio = _slenderness(height, diameter)
    if unit and ratio > _THINNEST:
        raise columns.table.error(
            f'stems in {name} are {ratio:.0f} times as high as they are thick: are height and '
            'diameter swapped?',
            cure='correct the names or the units in the header',
        )
    for row in np.flatnonzero(height > _TALLEST).tolist():
        detail = f'{name} is {values[row]:g}, a height of {height[row]:g} m'
        columns.leave_out(row, 'too high', f'{detail}; give its unit, as in height [cm]')
    for row in np.flatnonzero(height < 0.0).tolist():
        columns.leave_out(row, 'no height', f'a height of {height[row]:g} m')
    height[~((height > 0.0) & (height <= _TALLEST))] = np.nan
    return height


def refuse_list_of_species(columns: InventoryColumns, diameter: Floats) -> None:
    """Raise a `FormatError` for heights that are all ranges, without a stem or name of a tree."""
    cells = [cell for cell in columns.texts_of('height') if any(map(str.isdigit, cell))]
    has_trees = np.isfinite(diameter).any() or columns.table.find_all('tree_name')
    if cells and not has_trees and all('-' in cell or '–' in cell for cell in cells):
        raise columns.table.error(
            f"a list of species and no inventory: heights are ranges, as '{cells[0][:40]}', and "
            'there is no stem, place or name of a tree',
            cure='give a row for each tree, with its own height or stem',
        )


def leave_out_without_size(columns: InventoryColumns, height: Floats, diameter: Floats) -> None:
    """Leave out the rows without a height and without a stem."""
    for row in np.flatnonzero(np.isnan(height) & np.isnan(diameter)).tolist():
        columns.leave_out(row, 'no height and no stem', _why_no_size(columns, row))


def fill_heights(
    columns: InventoryColumns, height: Floats, diameter: Floats, keys: list[str]
) -> list[bool]:
    """
    Give each kept row without a height that of a grown tree of its stem, in place.

    Returns whether a row's height is such.
    """
    is_found = np.isnan(height) & columns.is_kept
    grown = cache(height_of_stem)
    rows = np.flatnonzero(is_found).tolist()
    for row in rows:
        height[row] = grown(keys[row], float(diameter[row]))
    n_kept = int(columns.is_kept.sum())
    if rows:
        which = 'heights' if len(rows) == n_kept else f'{len(rows)} of {n_kept} heights'
        columns.note(
            f'{which} are those of grown trees of these stems, as the table has none'
            f'{_unread_height(columns, rows)}'
        )
    return is_found.tolist()


def _unread_height(columns: InventoryColumns, rows: list[int]) -> str:
    """Tell the first height with digits that is no number, such as a date; empty without one."""
    heights = _read_heights(columns)
    if heights is None:
        return ''
    index, numbers, _ = heights
    for row in rows:
        if np.isnan(numbers[row]) and any(map(str.isdigit, columns.cell(index, row))):
            return f' that can be read; {columns.line(row)}: {columns.told(index, row)}'
    return ''


def _why_no_size(columns: InventoryColumns, row: int) -> str:
    places = map(columns.index_of, ('height', 'diameter', 'girth'))
    cells = [columns.told(index, row) for index in places if index is not None]
    return ' and '.join(cells) or 'no column of a size'
