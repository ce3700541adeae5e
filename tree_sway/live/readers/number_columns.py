# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Numbers in a line, by their order: ``5.3``, ``5.3,270``, and answers of SDI-12.

One number is a speed, two are a speed and a direction in degrees; of more, the option ``columns``
says which is which, as ``columns=direction,speed`` or ``columns=u,v,w``. An answer of SDI-12 has
an address and signed values, ``0+332+000.04+00``; those of Gill are a direction, a speed and a
status, or components and a status (WindSonic manual 1405-PS-0019, 14.5).
"""

from __future__ import annotations

from cmath import rect
from collections.abc import Sequence
from dataclasses import replace
import math
import re

from tree_sway.errors import ParameterError
from tree_sway.files import finite
from tree_sway.files.wind import of_velocity, Reading, reading_of, Refusal, WindReading

COLUMNS = 'speed direction gust u v w -'.split()
"""Meanings of a column; components point east, north and up, the way the air goes."""
_USUAL = {1: ('speed',), 2: ('speed', 'direction')}
"""Meanings of one and of two numbers."""
_BY_ORDER = (
    'taken as speed and direction in degrees by their order: columns=direction,speed in the '
    'address changes it'
)
_SDI12 = re.compile(r'\w((?:[+-]\d+(?:\.\d*)?){2,})(?:[@-\x7f]{3})?')
_SIGNED = re.compile(r'[+-]\d+(?:\.\d*)?')
_GAP = re.compile(r'[,;\s]+')
_LABELS = re.compile(r'^\$|\x02|\x03|m/s', re.IGNORECASE)
_ERROR = 999.0
"""Gill's value for a direction or speed that could not be measured."""


def columns_of(text: str) -> tuple[str, ...]:
    """Read the option ``columns``; a `ParameterError` for an unknown one, or no speed."""
    names = tuple(name.strip() for name in text.split(',')) if text else ()
    unknown = [name for name in names if name not in COLUMNS]
    if unknown or (names and 'speed' not in names and not {'u', 'v'} <= set(names)):
        raise ParameterError(
            f"columns are '{text}'", cure=f'use speed, or u and v, among {", ".join(COLUMNS)}'
        )
    return names


def read_numbers(
    line: str, columns: Sequence[str], heading: float, factor: float, no_unit: str
) -> Reading | None:
    """
    Read a line; None if it has anything but numbers.

    ``no_unit`` is what was assumed of the unit. A reading says so, and by which order numbers
    without ``columns`` were taken.
    """
    answer = _SDI12.fullmatch(line.strip())
    if answer is not None:
        kind = 'SDI-12'
        texts = _SIGNED.findall(answer[1])
        usual = _gill_columns(texts)
    else:
        kind = 'numbers'
        texts = [cell for cell in _GAP.split(_LABELS.sub('', line).strip()) if cell]
        usual = _USUAL.get(len(texts), ())
    values = [finite(text) for text in texts]
    if not values or None in values:
        return None
    names = columns or usual
    if not names:
        return Refusal(kind, f'{len(values)} numbers; say which: columns=speed,direction')
    by_name = dict(zip(names, (value or 0.0 for value in values), strict=False))
    if not set(names) <= {*by_name, '-'}:
        return Refusal(kind, f'{len(values)} numbers for {len(names)} columns')
    reading = _reading(kind, by_name, heading, factor)
    by_order = _BY_ORDER if names == _USUAL[2] and not columns else ''
    has_unit = 'm/s' in line.lower()
    assumed = ', '.join(filter(None, (by_order, '' if has_unit else no_unit)))
    return replace(reading, assumed=assumed) if isinstance(reading, WindReading) else reading


def _gill_columns(texts: Sequence[str]) -> tuple[str, ...]:
    """Meaning of the values of an instrument of Gill; a direction has no point."""
    if len(texts) != 3 or '.' in texts[2]:
        return ()
    # U is from south to north of the instrument, V from east to west.
    return ('v', 'west', 'status') if '.' in texts[0] else ('direction', 'speed', 'status')


def _reading(kind: str, values: dict[str, float], heading: float, factor: float) -> Reading:
    if values.get('status', 0.0) not in (0.0, 60.0):
        return Refusal(kind, f'status is {values["status"]:g}, not 00')
    east = values.get('u', -values.get('west', math.nan))
    if 'v' in values and math.isfinite(east):
        turned = complex(east, values['v']) * rect(factor, -heading)
        return of_velocity(kind, (turned.real, turned.imag, factor * values.get('w', 0.0)))
    speed = values['speed'] if values['speed'] < _ERROR else 'an error'
    gust = factor * values['gust'] if 'gust' in values else None
    direction = values.get('direction')
    return reading_of(kind, speed, direction, factor=factor, turn=heading, gust=gust)
