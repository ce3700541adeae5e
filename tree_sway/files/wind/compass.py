# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Directions of the wind as they are written, and the velocity of a wind from there."""

from __future__ import annotations

from collections.abc import Sequence
import re

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.files.column_names import COMPASS
from tree_sway.files.text_file import finite

_CALM = 1e-9
_FULL_CIRCLE = 401.0
"""Largest direction in degrees: a little more than a circle, and less than the codes of errors."""

_POINTS = 'N NNE NE ENE E ESE SE SSE S SSW SW WSW W WNW NW NNW'.split()
_DEGREES = {point: 22.5 * number for number, point in enumerate(_POINTS)}
_WORD = re.compile('|'.join(sorted(COMPASS, key=len, reverse=True)))


def degrees_of(cells: Sequence[str]) -> Floats:
    """
    Return the directions of texts in degrees, (n,), NaN for another text.

    A point is such as ``WNW``, ``West`` or ``Noroeste``. ``O`` is east where others have a W, as
    in German, and west where others have an E, as in French and Spanish.
    """
    plain = [finite(cell.removesuffix('°').removesuffix('º')) for cell in cells]
    numbers = np.array(plain, dtype=np.float64)
    if np.isfinite(numbers).all():
        return numbers
    points = [_point(cell) for cell in cells]
    letters = set(''.join(points))
    east_or_west = 'E' if 'W' in letters else 'W' if 'E' in letters else 'O'
    named = [_DEGREES.get(point.replace('O', east_or_west), np.nan) for point in points]
    return np.where(np.isnan(numbers), named, numbers)


def velocity_from(speed: Floats, degrees: Floats, turn: float = 0.0) -> Floats:
    """
    Return the wind of speeds [m/s] and directions that it comes from, east, north, up, (n, 3).

    It is NaN where either is none; in a calm the direction may be missing. Directions are counted
    from a ``turn`` [rad] before north.
    """
    degrees = np.where(np.isnan(degrees) & (np.abs(speed) < _CALM), 0.0, degrees)
    is_good = (speed >= 0.0) & (np.abs(degrees) < _FULL_CIRCLE)
    bearing = np.radians(np.where(is_good, degrees, np.nan)) - turn
    return -np.column_stack([speed * np.sin(bearing), speed * np.cos(bearing), 0.0 * bearing])


def _point(cell: str) -> str:
    plain = cell.partition('(')[0].strip().lower()  # WSW (247°)
    text = _WORD.sub(lambda word: COMPASS[word[0]], plain)
    text = text.replace('-', '').replace(' ', '').upper()
    return text if len(text) <= 3 and set(text) <= set('NESWO') else ''
