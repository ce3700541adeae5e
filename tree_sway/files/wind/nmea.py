# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
NMEA 0183: the wind sentences of an instrument on a mast or a boat.

- ``$--MWV,angle,R|T,speed,K|M|N|S,A|V``: where the wind comes from, in degrees clockwise from the
  bow. R is the apparent wind at the instrument; T is the true wind, less the motion of the boat,
  with directions from the bow as well. On a mast they are the same.
- ``$--MWD,direction,T,direction,M,speed,N,speed,M``: true wind, clockwise from true and from
  magnetic north.
- ``$--MDA``: weather, the last eight fields of which are those of MWD.
- ``$--XDR,A,angle,D,id,...,S,speed,K|M|N|S,id``: transducers, as weather stations send them; of
  several angles and speeds the second ones, which are the means between least and largest.
- ``$--VWR,angle,L|R,speed,N,speed,M,speed,K`` and ``$--VWT``: apparent and true wind, left
  or right of the bow.

Where the bow points is the option ``heading``. A mast instrument aligned to north has 0. A wrong
checksum, a status that is not A, an empty field: the sentence is refused.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
import math
from pathlib import Path
import re

from tree_sway.errors import ParameterError
from tree_sway.files.text_file import finite
from tree_sway.files.wind.reading import Reading, Refusal
from tree_sway.files.wind.record import WindRecord
from tree_sway.files.wind.sensor_line import read_sensor_log, why_broken
from tree_sway.files.wind.values import bearing_of, reading_of

SENTENCES = ('MWD', 'MDA', 'MWV T', 'VWT', 'MWV R', 'VWR', 'XDR')
"""
Sentences in the order of preference: those that depend least on the motion of the boat first.
"""

_UNITS = {'N': 1852.0 / 3600.0, 'K': 1.0 / 3.6, 'M': 1.0, 'S': 0.44704}
_SENTENCE = re.compile(
    r'\$([A-Z]{2}(MWV|MWD|MDA|VWR|VWT|XDR),([^*]*))(?:\*(.*))?', re.ASCII | re.DOTALL
)
"""Body, name, fields and checksum."""


def parse_nmea(line: str, heading: float = 0.0, declination: float = 0.0) -> Reading | None:
    """
    Parse a line of NMEA 0183 to the wind of a kind of `SENTENCES`; None for any other line.

    A logger may have added a prefix.

    Parameters
    ----------
    line
        The line, without its end.
    heading
        Heading of the bow, clockwise from true north, in [rad].
    declination
        Magnetic declination, east positive, in [rad]; for a MWD without a true direction.

    """
    sentence = _SENTENCE.match(line, max(line.rfind('$'), 0))
    if sentence is None:
        return None
    body, name, content, check = sentence.groups()
    fields = content.strip().split(',')[12 if name == 'MDA' else 0 :]
    kind = f'MWV {"".join(fields[1:2])}' if name == 'MWV' else name
    lacks_wind = name == 'XDR' and not {'A', 'S'} <= set(fields[::4])
    if lacks_wind or kind not in SENTENCES:
        return None
    if why := why_broken(len(line), check and check.strip(), body):
        return Refusal(kind, why)
    try:
        angle, speed, unit, origin = _READERS[name](fields)
    except ValueError as error:
        return Refusal(kind, str(error))
    turn = {'bow': heading, 'magnetic north': declination, 'true north': 0.0}[origin]
    return reading_of(kind, speed, angle, factor=_UNITS[unit], turn=turn, interval=0.0)


def read_nmea_wind(
    path: Path,
    sentence: str = 'auto',
    rate: float = 1.0,
    heading: float = 0.0,
    declination: float = 0.0,
) -> WindRecord:
    """
    Read the wind of an NMEA 0183 log, whose sentences have equal spacing, ``rate`` in [Hz].

    The sentence is one of `SENTENCES`, or ``auto``: the first of these with a good one; others are
    ignored. ``heading`` and ``declination`` are those of `parse_nmea`.

    Raises
    ------
    FormatError
        If there is no such sentence, or no good one.
    ParameterError
        If an option has a wrong value.

    """
    if sentence not in (*SENTENCES, 'auto'):
        raise ParameterError(f"sentence is '{sentence}'", cure=f'use auto, {", ".join(SENTENCES)}')
    wanted: Sequence[str] = SENTENCES if sentence == 'auto' else (sentence,)
    parse = partial(parse_nmea, heading=heading, declination=declination)
    bow = f'directions count from the bow, taken to head {math.degrees(heading):g} degrees'
    kind, record = read_sensor_log(path, parse, wanted, rate)
    return record if kind in ('MWD', 'MDA') else record.with_note(bow)


Parts = tuple[str | float, str, str, str]
"""Angle, speed and its unit as they are sent, and where the angle counts from."""


def _mwv(fields: list[str]) -> Parts:
    if len(fields) < 5:
        raise ValueError(f'{len(fields)} fields of 5')
    angle, _reference, speed, unit, status = fields[:5]
    if status != 'A':
        raise ValueError(f"status is '{status[:8]}', not A")
    if unit not in _UNITS:
        raise ValueError(f"no unit K, M, N or S: '{unit[:8]}'")
    return angle, speed, unit, 'bow'


def _mwd(fields: list[str]) -> Parts:
    if len(fields) < 8:
        raise ValueError(f'{len(fields)} fields of 8')
    true, magnetic, knots, speed = fields[:8:2]
    unit = 'M'
    if finite(speed) is None and finite(knots) is not None:
        speed, unit = knots, 'N'
    if bearing_of(true) is None and magnetic:
        return magnetic, speed, unit, 'magnetic north'
    return true, speed, unit, 'true north'


def _xdr(fields: list[str]) -> Parts:
    """Wind of transducers in groups of kind, value, unit and name."""
    groups = [fields[i : i + 4] for i in range(0, len(fields) - 3, 4)]
    angles = [each[1] for each in groups if each[0] == 'A' and each[2] == 'D']
    speeds = [each[1:3] for each in groups if each[0] == 'S']
    if not angles or not speeds:
        raise ValueError('no angle in degrees with a speed')
    angle = angles[len(angles) > 2]
    return _mwv([angle, 'R', *speeds[len(speeds) > 2], 'A'])


def _vwr(fields: list[str]) -> Parts:
    """Angle up to half a turn, left or right; the first given speed is used."""
    angle, side = [*fields, ''][:2]
    pairs = zip(fields[2::2], fields[3::2], strict=False)
    speeds = [each for each in pairs if finite(each[0]) is not None and each[1] in _UNITS]
    degrees = finite(angle)
    if degrees is None or not 0.0 <= degrees <= 180.0:
        raise ValueError(f"no angle up to 180: '{angle[:8]}'")
    if side not in ('L', 'R'):
        raise ValueError(f"no side L or R: '{side[:8]}'")
    if not speeds:
        raise ValueError('no speed with a unit')
    from_bow = degrees if side == 'R' else 360.0 - degrees
    return from_bow, *speeds[0], 'bow'


_READERS = {'MWV': _mwv, 'MWD': _mwd, 'MDA': _mwd, 'VWR': _vwr, 'VWT': _vwr, 'XDR': _xdr}
"""Readers of the fields of a sentence."""
