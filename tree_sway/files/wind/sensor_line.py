# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Lines of anemometers: the wind, or the reason of a refusal; checksums and log files."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Sequence
from functools import reduce
from operator import xor
from pathlib import Path
import re

from tree_sway.errors import FormatError, ParameterError
from tree_sway.files.text_file import read_lines
from tree_sway.files.time_stamps import times_of
from tree_sway.files.wind.reading import Reading, Refusal
from tree_sway.files.wind.record import WindRecord, WindRows

_MAX_LINE = 1024
"""Largest length of a line [characters]."""
STAMP = re.compile(
    r'(?<!\d)\s*[\[(]?(\d{10}(?:\.\d+)?(?=\D)|\d{13}(?=\D)'
    r'|\d{4}-\d\d-\d\d[ T]\d\d:\d\d:\d\d(?:\.\d+)?Z?)',
    re.ASCII,
)
"""Time since 1970 in s or ms, or date and time, that a logger puts before a line."""

_CLOCK = re.compile(
    r'\$[A-Z]{2}(?:ZDA|RMC),(\d\d)(\d\d)(\d\d(?:\.\d+)?),(?:[^*]*?,)??(\d\d),?(\d\d),?(?:20)?(\d\d)[,*]',
    re.ASCII,
)
"""Time and date of a sentence of a clock or of a satellite receiver."""

ParseLine = Callable[[str], Reading | None]
"""Parse a line; None if it is not about the wind. Never raises."""


def checksum_of(body: str) -> str:
    """Exclusive or of the bytes of a text, as two hexadecimal digits."""
    return f'{reduce(xor, body.encode("utf-8", "replace"), 0):02X}'


def why_broken(length: int, sent_sum: str | None, body: str) -> str:
    """
    Say why a line of a length in characters is broken; empty if it is not.

    Its checksum, None without one, is that of its body, maybe with the marks of begin or end.
    """
    if length > _MAX_LINE:
        return f'a line of {length} characters'
    bodies = (body, f'{body}\x03', f'\x02{body}')
    is_right = sent_sum is None or sent_sum.upper() in map(checksum_of, bodies)
    return '' if is_right else 'wrong checksum'


def read_sensor_log(
    path: Path, parse: ParseLine, kinds: Sequence[str], rate: float, notes: Sequence[str] = ()
) -> tuple[str, WindRecord]:
    """
    Read the wind of a log of an anemometer's lines, which have equal spacing, maybe without times.

    Lines that are not about the wind are ignored; a refused one keeps its time. Of the wanted
    kinds, the best one first, the first with a good line is read; its name is returned before the
    record. ``rate`` is that of its lines in [Hz].

    Raises
    ------
    FormatError
        If there is no such line, or no good one.
    ParameterError
        If the rate is not positive.

    """
    if not rate > 0.0:
        raise ParameterError(f'rate is {rate:g} Hz', cure='give more than 0')
    found = dict[str, tuple[WindRows, list[str]]]()
    clock = ''
    for number, line in enumerate(read_lines(path), start=1):
        if told := _CLOCK.search(line):
            clock = '20{5}-{4}-{3}T{0}:{1}:{2}Z'.format(*told.groups())
        said = parse(line)
        if said is None:
            continue
        rows, stamps = found.setdefault(said.kind, (WindRows(str(path)), []))
        if isinstance(said, Refusal):
            rows.refuse(number, said.reason)
        else:
            rows.add(number, (len(rows.time) + rows.refused) / rate, said.velocity(0.0))
            stamp = STAMP.search(line)
            # Of several sentences of a kind after a clock the first alone has its time.
            stamps.append(stamp[1] if stamp else clock * (clock not in stamps[-1:]))
    there = [kind for kind in kinds if kind in found]
    if not there:
        raise FormatError(
            f'no sentence {" or ".join(kinds)}', cure="log the wind instrument's output"
        )
    best = next((kind for kind in there if found[kind][0].time), there[0])
    rows, stamps = found[best]
    if rows.time and all(stamps):
        times = times_of(stamps)
        rows.time = array('d', times.seconds)
        return best, rows.record(epoch=times.epoch, notes=tuple(notes))
    spaced = f'{best} sentences have no times and are taken at {rate:g} Hz'
    return best, rows.record(notes=(spaced, *notes))
