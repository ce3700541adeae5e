"""
NMEA 0183: the sentences MWV and MWD of a wind instrument, on a mast or a boat.

- ``$--MWV,angle,R|T,speed,K|M|N|S,A|V``: where the wind comes from, clockwise from the bow in
  degrees. R is the apparent wind, as the instrument feels it; T is the true wind, less
  the motion of the boat, and still counted from the bow. On a mast that stands still the
  two are one.
- ``$--MWD,direction,T,direction,M,speed,N,speed,M``: true wind, clockwise from true and from
  magnetic north.

The bow has to be told: option ``heading``. A mast instrument aligned to north has 0. The sentences
carry no time: they are taken as evenly spaced, at option ``rate``. A wrong checksum, a status that
is not A, an empty field: the sentence is refused, and its place in time stays.

"""

from __future__ import annotations

from functools import reduce
from math import pi
from operator import xor
from pathlib import Path

from tree_sway_ros.errors import FormatError, ParameterError
from tree_sway_ros.files.text_file import finite, read_lines
from tree_sway_ros.files.wind.record import WindRecord, WindRows
from tree_sway_ros.files.wind.units import Velocity, degrees_to_bearing, from_bearing

SENTENCES = ("MWD", "MWV T", "MWV R")
"""What can be read, in the order of preference: least depends on the motion of the boat first."""

_KNOT = 1852.0 / 3600.0
_UNITS = {"N": _KNOT, "K": 1.0 / 3.6, "M": 1.0, "S": 0.44704}


def read_nmea_wind(
    path: Path,
    sentence: str = "auto",
    rate: float = 1.0,
    heading: float = 0.0,
    declination: float = 0.0,
) -> WindRecord:
    """
    Read the wind of an NMEA 0183 log.

    Parameters
    ----------
    path
        The file; other sentences in it are passed over.
    sentence
        ``MWD``, ``MWV T``, ``MWV R``, or ``auto``: the first of these with a good sentence.
    rate
        Sentences of that kind a second in [Hz].
    heading
        Of the bow, clockwise from true north, in [rad].
    declination
        Of the magnetic needle, east positive, in [rad]; for a MWD without a true direction.

    Raises
    ------
    FormatError
        If there is no such sentence, or no good one.
    ParameterError
        If an option is not what it can be.

    """
    if sentence not in (*SENTENCES, "auto"):
        raise ParameterError(f"sentence is '{sentence}'", cure=f"use auto, {', '.join(SENTENCES)}")
    if not rate > 0.0:
        raise ParameterError(f"rate is {rate:g} Hz", cure="give more than 0")
    source = str(path)
    found: dict[str, WindRows] = {}
    count = dict.fromkeys(SENTENCES, 0)
    for number, line in enumerate(read_lines(path), start=1):
        fields = _fields(line)
        kind = _kind(fields)
        if kind is None:
            continue
        rows = found.setdefault(kind, WindRows(source))
        time = count[kind] / rate
        count[kind] += 1
        if not _checksum_is_right(line):
            rows.refuse(number, "wrong checksum")
            continue
        result = _mwd(fields, declination) if kind == "MWD" else _mwv(fields, heading)
        if isinstance(result, str):
            rows.refuse(number, result)
        else:
            rows.add(number, time, result)
    wanted = SENTENCES if sentence == "auto" else (sentence,)
    there = [kind for kind in wanted if kind in found]
    if not there:
        raise FormatError(
            f"no sentence {' or '.join(wanted)}",
            where=source,
            cure="log the wind instrument's output",
        )
    best = next((kind for kind in there if found[kind].time), there[0])
    return found[best].record(notes=_notes(best, rate, heading))


def _notes(kind: str, rate: float, heading: float) -> tuple[str, ...]:
    spaced = f"{kind} sentences have no time of their own and are taken at {rate:g} Hz"
    if kind == "MWD":
        return (spaced,)
    return spaced, f"directions count from the bow, taken to head {heading * 180.0 / pi:g} degrees"


def _fields(line: str) -> list[str]:
    """Fields of the sentence in a line; a logger may have put something of its own before it."""
    begin = line.rfind("$")
    return line[begin:].split("*")[0].strip().split(",") if begin >= 0 else []


def _kind(fields: list[str]) -> str | None:
    if not fields or len(fields[0]) != 6:
        return None
    if fields[0].endswith("MWD"):
        return "MWD"
    if fields[0].endswith("MWV") and len(fields) > 2 and fields[2] in ("R", "T"):
        return f"MWV {fields[2]}"
    return None


def _checksum_is_right(line: str) -> bool:
    """Compare the checksum, if there is one: it is optional in the standard."""
    body, star, given = line[line.rfind("$") + 1 :].partition("*")
    if not star:
        return True
    try:
        return int(given.strip()[:2], 16) == reduce(xor, body.encode(), 0)
    except ValueError:
        return False


def _mwv(fields: list[str], heading: float) -> Velocity | str:
    if len(fields) < 6:
        return f"{len(fields) - 1} fields of 5"
    if fields[5] != "A":
        return f"status is '{fields[5][:8]}', not A"
    angle, speed, unit = finite(fields[1]), finite(fields[3]), _UNITS.get(fields[4])
    bearing = None if angle is None else degrees_to_bearing(angle)
    if bearing is None or speed is None or unit is None or speed < 0.0:
        return f"angle '{fields[1][:8]}', speed '{fields[3][:8]}', unit '{fields[4][:8]}'"
    return from_bearing(speed * unit, bearing + heading)


def _mwd(fields: list[str], declination: float) -> Velocity | str:
    if len(fields) < 9:
        return f"{len(fields) - 1} fields of 8"
    true, magnetic, knots, speed = (finite(fields[i]) for i in (1, 3, 5, 7))
    if speed is None and knots is not None:
        speed = knots * _KNOT
    bearing = None if true is None else degrees_to_bearing(true)
    if bearing is None and magnetic is not None:
        needle = degrees_to_bearing(magnetic)
        bearing = None if needle is None else needle + declination
    if bearing is None or speed is None or speed < 0.0:
        return f"direction '{fields[1][:8]}', speed '{fields[7][:8]}'"
    return from_bearing(speed, bearing)
