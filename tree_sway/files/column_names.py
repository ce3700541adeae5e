# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Names of columns and their units, compared however they are written.

``Baumhöhe [m]``, ``BAUMHOEHE (M)`` and ``baumhoehe_m`` are one name with one unit: letters are
folded to lower case without accents, and all but letters and digits is left out. Other names are
known by the words that they consist of, as ``Vitesse moyenne du vent``. A unit is in
brackets, behind ``-`` or a comma, or the last word, as in ``height_m`` and ``Height in metres``. A
name of ten letters may be the beginning of a known one, as shapefiles cut it: ``TREE_HEIGH``.
"""

from __future__ import annotations

from functools import lru_cache
from importlib.resources import files
import json
import re
from typing import Any
import unicodedata

_KNOWN = json.loads(files('tree_sway.files').joinpath('columns.json').read_text('utf-8'))

MOTIONS = {quantity: re.compile(pattern) for quantity, pattern in _KNOWN['motions'].items()}
"""Names of columns of a tree's motion, folded; each quantity has its own kind of unit."""

COLUMNS: dict[str, dict[str, Any]] = {
    **_KNOWN['columns'],
    **{quantity: {'unit': quantity, 'names': []} for quantity in MOTIONS},
}
"""Names of the column of a quantity, and its kind of unit."""

FILES_OF = {quantity: re.compile(words) for quantity, words in _KNOWN['files_of'].items()}
"""Words in the names of files, folded, and the motion that they have; empty for none."""

TOLD_BY_SIZE: dict[str, Any] = _KNOWN['told_by_size']
"""
Unit of SI of a motion, its largest usual value, another unit, its own largest value where size
tells it, and the share of values that is compared with these: a few may be faults.
"""

ANGLES = re.compile(_KNOWN['angles'])
"""Names of angles, folded, which a table has in one unit."""

INVENTORY: dict[str, list[str]] = _KNOWN['inventory']
"""Columns that an inventory needs: what they say, and the quantities that do together."""

COMPASS: dict[str, str] = _KNOWN['compass']
"""Words for north, east, south and west."""

TIME_PARTS: dict[str, str] = _KNOWN['time_parts']
"""Columns that make a time together, and how."""

CODES: dict[str, dict[str, str]] = _KNOWN['codes']
"""Columns of codes, and the quantities of the wind among them."""

ZONES: dict[str, float] = _KNOWN['zones']
"""Letters of zones of time, and the hours that each is ahead of UTC."""

HEADER: list[str] = _KNOWN['header']
"""Quantities whose names tell the header of a table."""

_AXES: dict[str, str] = _KNOWN['axes']
"""Words for axes, and numbers and letters of quaternions behind their quantity."""
_SAME_MOTIONS: dict[str, str] = _KNOWN['same_motions']

_UMLAUTS = str.maketrans(_KNOWN['umlauts'])
_BRACKETS = re.compile(r'[\[(]\s*((?:[^\[\]()]|\([^()]*\))*?)\s*[\])]')
_BEHIND = re.compile(r'(?:\s-\s|,)\s*([^,(\[]+)')
_NAME_ENDS = re.compile(r'(?<=.)(?:\s*[\[(,]|\s-\s|\s@\s).*', re.DOTALL)
_ZONE = re.compile(r'[A-Z][a-z]+/[\w/]+|(?:UTC|GMT) ?[+-]\d\d?(?::?\d\d)?|[+-]?\d\d:\d\d')
_SCALED = re.compile(r'(\d+(?:\.\d+)?(?:e[-+]\d+)?)( ?)(\D.*)')
_ELEMENT = re.compile(r'\d+|[xyzXYZ]')
_MAP = re.compile(r'(UTM|ETRS|EPSG|WGS|GK|LV|RD|OSGB|SWEREF|Lambert|Gau(ß|ss).?Kr)', re.IGNORECASE)
"""System of places on a map, in brackets behind one of them: it is no unit."""
_IN_BRACKETS = re.compile(r'(?:[\[(]|\s-\s)([xyzXYZ])(?:[\])]|(?=\s|$))')
"""Axis in brackets or behind a sign, as in ``Acceleration - x (m/s²)``."""
_AXIS_WORD = re.compile(_KNOWN['axis_word'])
"""Folded name with its axis in front, as ``xacc`` and ``nstilt``, or with a word as its end."""
_GROUP = re.compile(
    r'^(?:[^:(\[]*:|\w+ \d+ -)\s*(?=[A-Z])|^\{__name__="|(?<=\w)(?:", | ?\{).{0,500}\}$'
)
"""
Name of a group or channel before that of a column, as in ``Set 1:Time (s)`` and ``Aux 1 - U``, and
the labels of a series of Prometheus about it.
"""
_VALUE = re.compile(r'\.value$', re.IGNORECASE)
"""Last name of a value that has others beside it, as its unit."""
_INNER = re.compile(r'\.(?=\S)(?<!\d\.(?=\d))')
"""Sign between the names of groups, and not that of a decimal."""
_YEAR = re.compile(r'(?<=[^\W\d])[_ .-]?((?:19|20)\d\d)(?!\d)')
"""Year of a measurement behind the name of what was measured."""
_SHORTEST_GLUED = 4
"""Letters of the shortest name that a unit follows without a sign, as in windspeedmph."""
_SHAPEFILE_NAME = 10
"""Length at which the names of columns of shapefiles are cut off."""
_SHORTEST_CUT = 8
"""Letters that the beginning of a known name has at least."""
_LONGEST_NAME = 200
"""Characters of the longest name whose words are compared with units."""
_ENDLESS = 2000
"""Characters above which a header has no end and is no name."""
_LAST = re.compile('in|[a-z]')
"""Units that are so only at the end of a name."""
_IN = re.compile(r'^(in|en)(?=\w)')
"""Word between a name and its unit."""


def folded(text: str) -> str:
    """Letters and digits of a text in lower case, without accents, umlauts as ae, oe and ue."""
    return (_letters if len(text) > _ENDLESS else _letters_of_name)(text)


def _letters(text: str) -> str:
    lower = unicodedata.normalize('NFC', text).lower().translate(_UMLAUTS)
    plain = unicodedata.normalize('NFKD', lower)
    return ''.join(letter for letter in plain if letter.isalnum())


_letters_of_name = lru_cache(8192)(_letters)
"""The same, kept: a file asks for the names of its columns again and again."""


def _folded_unit(text: str) -> str:
    """Return a unit in lower case without spaces, with one sign for each of its parts."""
    unit = text.strip().lower().replace('º', '°').replace('ø', '°')
    unit = '°' if unit == '*' else unicodedata.normalize('NFKC', unit)  # HOBOlink has a star
    return re.sub(r'[\s._·⋅*^]|wmounit:', '', unit).replace('μ', 'u').replace('−', '-')


UNITS: dict[str, dict[str, float]] = {
    kind: {_folded_unit(unit): factor for unit, factor in units.items()}
    for kind, units in _KNOWN['units'].items()
}
"""Units of each kind of quantity as `_folded_unit` writes them, and their factors to SI."""

SENDERS = tuple(map(folded, _KNOWN['senders']))
"""Names of what tells an instrument from another, folded."""

_NAMES = {
    quantity: tuple(dict.fromkeys(map(folded, known['names'])))
    for quantity, known in COLUMNS.items()
}
"""Names of each quantity, best first: those of one letter last, as t may be a temperature."""

_PATTERNS = {
    quantity: [*map(re.compile, known.split())] for quantity, known in _KNOWN['patterns'].items()
}
"""Names that vary, folded or by their `_roles`, as by the number of an instrument; best first."""

_ROLES = {folded(word): role for role, words in _KNOWN['words'].items() for word in words.split()}
"""Words of many languages that names consist of, folded, and letters for what they say."""
_WORD = re.compile('|'.join(sorted(_ROLES, key=len, reverse=True)))
_WORD_ENDS = re.compile(r'[\s_]+|\.(?=\D)|(?<=[a-z])(?=[A-Z][a-z]{2})')
"""Between the words of a name, as in ``pitchDegrees``."""
_SPAN = re.compile(r'\d+(minutes?|mins?|mn|hours?|hr|m|(?=\D|$))')
"""Number, height or length of time in a name."""

STATION = re.compile(r'(?:sensor\.)?(?:.*[_/])?(?=(?:avg_)?wind|gust)')
"""Name of a station, or path of a topic, before that of a quantity of the wind."""
WIND = ('wind_speed', 'wind_direction', 'gust')

_ALL_NAMES = frozenset(name for names in _NAMES.values() for name in names)


def unit_factor(kind: str, unit: str) -> float | None:
    """
    Factor from a unit to SI; None if it is not one of this kind.

    A number may be before it, as in ``0.1 m/s``. A zone of time, as in
    ``Date (Europe/Berlin)``, stands for dates, of factor 1.
    """
    if kind == 'time' and _ZONE.fullmatch(unit.strip()):
        return 1.0
    known = UNITS.get(kind, {}).get(_folded_unit(unit))
    scaled = _SCALED.fullmatch(unit.strip())
    # Without a space only times have one: DIAMETRE_1M is no diameter in units of 1 m.
    if known is not None or scaled is None or not (scaled[2] or kind == 'time'):
        return known
    of_one = unit_factor(kind, scaled[3])
    return None if of_one is None else float(scaled[1]) * of_one


def name_and_unit(column: str, kind: str) -> tuple[str, str]:
    """
    Split the name of a column from its unit, of a kind in `UNITS`.

    The unit is in brackets, or behind ``-`` or a comma. If none of these is a unit of the kind, it
    is the text in the first brackets, or empty without them. A number or an axis in brackets, as
    in ``u(1)``, tells the element of a logger's array.
    """
    text = _GROUP.sub('', column.strip().strip('"').strip())
    in_brackets = [found for found in _BRACKETS.findall(text) if not _ELEMENT.fullmatch(found)]
    behind = [found.strip() for found in _BEHIND.findall(text)]
    name = _NAME_ENDS.sub('', text, count=1).strip() or text
    for unit in (*in_brackets, *behind):
        if unit_known(kind, unit):
            return name, unit
    if in_brackets:
        is_map = kind == 'length' and _MAP.match(in_brackets[0])
        return name, '' if is_map else in_brackets[0]
    return text, ''


@lru_cache(8192)
def rank_of(column: str, quantity: str) -> int | None:
    """
    Place of a column's name among the names of a quantity; None if it is not one of them.

    Of a name within groups, as ``metric.windSpeed.value``, the last part counts alone; a year in
    it, as in ``DBH_2019``, does not count.
    """
    if len(column) > _ENDLESS:
        return None
    kind = COLUMNS[quantity]['unit']
    column = _YEAR.sub('', column) or column
    name, _ = name_and_unit(column, kind)
    inner = _INNER.split(_VALUE.sub('', name))[-1]
    found = (folded(name), folded(column), folded(inner), _without_unit(inner, kind)[0])
    for rank, known in enumerate(_NAMES[quantity]):
        if known in found or _glued_unit(inner, known, kind) or _is_cut(column, known):
            return rank
    forms = [*filter(None, (*found, *map(_roles, found)))]
    for rank, pattern in enumerate(_PATTERNS.get(quantity, ()), start=len(_NAMES[quantity])):
        if any(map(pattern.fullmatch, forms)):
            return rank
    return None


def is_named(column: str, *quantities: str) -> bool:
    """Whether a column's name is one of those of some quantities, as by `rank_of`."""
    return any(rank_of(column, each) is not None for each in quantities)


def is_wind(name: str) -> bool:
    """Whether a text is the name of a quantity of the wind, maybe behind that of a station."""
    plain = STATION.sub('', name, count=1)
    return is_named(plain, *WIND)


@lru_cache(8192)
def _roles(name: str) -> str:
    """Return a folded name with a capital letter in place of each word that is known."""
    words = _WORD.sub(lambda word: _ROLES[word[0]], _SPAN.sub('', name))
    return words.replace('_', '')


def year_of(column: str) -> int:
    """Return the year in a column's name; 0 without one."""
    year = _YEAR.search(column)
    return int(year[1]) if year else 0


@lru_cache(4096)
def motion_of(column: str) -> tuple[str, str, str] | None:
    """Quantity of a column of a motion, its name and its axis; None for another column."""
    for quantity, pattern in MOTIONS.items():
        name = name_and_unit(_IN_BRACKETS.sub(r' \1', column), quantity)[0]
        plain = _without_unit(name, quantity)[0] or folded(name)
        plain = _SAME_MOTIONS.get(plain, plain)
        turned = _AXIS_WORD.sub(
            lambda word: (word[2] or word[3]) + _AXES[word[1] or word[4]], plain
        )
        for each in (plain, turned):
            if found := pattern.fullmatch(each):
                axis = found['axis'] or ''
                return quantity, each[: found.start('axis')], _AXES.get(quantity + axis, axis)
    return None


def _is_cut(column: str, known: str) -> bool:
    """Whether a column's name is the beginning of a known one, cut off by a shapefile."""
    if len(column.strip()) != _SHAPEFILE_NAME:
        return False
    name = folded(column)
    return len(name) >= _SHORTEST_CUT and known.startswith(name) and name not in _ALL_NAMES


def unit_known(kind: str, unit: str) -> bool:
    """Whether a unit is one of a kind."""
    return bool(unit) and unit_factor(kind, unit) is not None


def is_name(column: str, quantity: str) -> bool:
    """Whether a whole column's name, brackets and all, is one of a quantity."""
    return folded(column) in _NAMES[quantity]


def unit_in_name(name: str, quantity: str) -> str:
    """Return the unit in a column's name, as in ``x_m`` and ``ws_mph_avg``; empty without one."""
    kind = COLUMNS[quantity]['unit']
    inner = name.rpartition('.')[2]
    glued = (_glued_unit(inner, each, kind) for each in _NAMES[quantity])
    return _without_unit(name, kind)[1] or next(filter(None, glued), '')


@lru_cache(4096)
def _without_unit(name: str, kind: str) -> tuple[str, str]:
    """
    Return a name without the words that are a unit, folded, and the unit; both may be empty.

    A unit of one letter, or ``in``, is the last word; the first word is one only before a known
    name or of one, as in ``mph Gust Speed``.
    """
    if len(name) > _LONGEST_NAME:  # a header without end
        return '', ''
    parted = _WORD_ENDS.sub('_', name.strip())
    words = parted.lower().split('_')
    whole = folded(name)
    found = '', ''
    for end in range(len(words), 0, -1):
        for begin in range(end - 1, max(end - 4, -1), -1):
            inside = words[begin:end]
            for unit in ('/'.join(inside), ''.join(inside)):
                is_last = end == len(words) or not _LAST.fullmatch(unit)
                if unit_known(kind, unit) and not unit.isdecimal() and is_last:
                    rest = re.sub(r'\s(in|en)$', '', ' '.join(words[:begin] + words[end:]))
                    if _ALL_NAMES & {folded(rest), whole}:
                        return folded(rest), unit  # dd_10_deg is a dd_10 and no dd in 10 deg
                    found = found if found[1] or not begin else (folded(rest), unit)
    return found


def _glued_unit(name: str, known: str, kind: str) -> str:
    """Return the unit of a kind that follows a known name without a sign: ``windspeedmph``."""
    whole = folded(name)
    end = whole.removeprefix(known)
    if end in ('', whole):
        return ''
    last = re.split(r'[\s_.]+', name)[-1]
    if len(end) > len(folded(last)):
        return ''  # stem_diam_m is in m, and not a 'stem dia' in mm
    if whole not in _WITH_UNIT and (len(known) < _SHORTEST_GLUED or whole in _ALL_NAMES):
        return ''  # stem_diameter is a name of its own, and not a 'stem dia' in meters
    return next((each for each in (end, _IN.sub('', end)) if unit_known(kind, each)), '')


_WITH_UNIT = frozenset(
    folded(name)
    for known in COLUMNS.values()
    for name in known['names']
    if unit_known(known['unit'], re.split(r'[\s_]+', name)[-1])
)
"""Names that end with their unit as their last word, as ``gust_mph``, in any form: gustMph."""
