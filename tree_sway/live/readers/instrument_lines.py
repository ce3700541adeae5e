# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Lines of instruments of any maker, read by the first reader that recognises them.

Sentences with a mark or a checksum come first, then JSON, then the makers' own lines; numbers and
``name=value``, which many lines resemble, come last. Those of a maker are rows of
`instruments`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from operator import itemgetter

from tree_sway.core.wind import is_wind
from tree_sway.files import object_of, pairs_of, unit_factor
from tree_sway.files.wind import (
    INSTRUMENTS,
    LOGGED,
    parse_nmea,
    read_instrument,
    Reading,
    Readings,
    Refusal,
    SENTENCES,
    WindReading,
)
from tree_sway.live.readers.documents import read_document
from tree_sway.live.readers.json_path import parse_json
from tree_sway.live.readers.named_values import names_of, NO_UNIT, WindNames
from tree_sway.live.readers.number_columns import columns_of, read_numbers
from tree_sway.live.readers.signalk import SignalKWind
from tree_sway.live.source_address import SourceAddress
from tree_sway.live.transports.transport import Message

_LINE_KINDS = ('auto', *SENTENCES, *LOGGED)
"""Sentences that may be chosen where an instrument sends several."""
_MOST_LINES = 64
"""Number of lines of a datagram that are read."""
EXPECTS = ', '.join(
    (
        'NMEA 0183 (MWV, MWD, MDA, VWR, VWT, XDR)',
        *dict.fromkeys(map(itemgetter('name'), INSTRUMENTS)),
        'SDI-12, JSON, name=value, or numbers as 5.3,270',
    )
)


@dataclass
class InstrumentLines:
    """
    Reader of lines.

    It keeps to the kind of the first good line, as others may measure from another direction.

    Parameters
    ----------
    sentence
        One of `_LINE_KINDS` to read; ``auto`` is the kind of the first good line.
    heading
        Bearing of the bow or the north mark, clockwise from true north [rad].
    declination
        Magnetic declination, east positive [rad].
    columns
        Meaning of numbers in a line, as `columns_of`.
    names
        Where the wind is in a line of JSON, and the unit of a speed without one.

    """

    sentence: str = 'auto'
    heading: float = 0.0
    declination: float = 0.0
    columns: Sequence[str] = ()
    names: WindNames = field(default_factory=WindNames)
    found: str = field(default='', init=False)
    """First good kind; empty before it."""

    def __post_init__(self) -> None:
        """Prepare what all lines share."""
        self._factor = unit_factor('speed', self.names.unit or 'm/s') or 1.0
        self._no_unit = '' if self.names.unit else NO_UNIT
        self._signalk = SignalKWind(self.heading)

    @property
    def reading(self) -> str:
        """Kind that is read; empty before it is known."""
        return self.found if self.sentence == 'auto' else self.sentence

    def __call__(self, message: Message) -> Readings:
        """Read the lines of a message."""
        found = list[Reading]()
        lines = message.data.decode('utf-8', 'replace').splitlines()
        if len(lines) > _MOST_LINES:
            found.append(Refusal('lines', f'more than {_MOST_LINES} lines in a message'))
        for line in filter(str.strip, lines[:_MOST_LINES]):
            for each in self._read(line):
                is_good = isinstance(each, WindReading) and is_wind(each.speed, each.up, 0.0)
                if is_good and not self.reading:
                    self.found = each.kind
                if self.reading in ('', each.kind):
                    found.append(each)
        return found

    def _read(self, line: str) -> Iterator[Reading]:
        """Read a line; nothing if no reader recognises it."""
        if line.lstrip().startswith(('{', '[')):
            message = Message(line.encode())
            document = parse_json(message.data)
            is_delta = 'updates' in object_of(document)  # of Signal K, as its own source reads it
            yield from self._signalk(message) if is_delta else read_document(document, self.names)
            return
        heading = self.heading
        reading = (
            parse_nmea(line, heading, self.declination)
            or read_instrument(line, heading, self._factor)
            or read_numbers(line, self.columns, heading, self._factor, self._no_unit)
        )
        if reading is not None:
            yield reading
        elif named := pairs_of(line):
            yield from self.names.read(named, 'name=value')


def lines_of(address: SourceAddress) -> InstrumentLines:
    """Make a reader from the options of an address; a `TreeSwayError` for a wrong one."""
    sentence = address.text_of('sentence', 'auto')
    if sentence not in _LINE_KINDS:
        raise address.error(f"sentence is '{sentence}'", f'use {", ".join(_LINE_KINDS)}')
    names = names_of(address)
    if names.unit and unit_factor('speed', names.unit) is None:
        raise address.error(f"unknown unit '{names.unit}'", 'use m/s, km/h, kn, mph or ft/s')
    return InstrumentLines(
        sentence,
        address.angle('heading_degrees'),
        address.angle('declination_degrees'),
        columns_of(address.text_of('columns')),
        names,
    )
