# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A wind record: velocity over time, as returned by all readers.

Velocities blow TO where they point, in m/s, in the frame east, north, up (REP-103), for all files.
An unusable row is refused and counted, never replaced: a gap stays a gap in the times.
"""

from __future__ import annotations

from array import array
from bisect import bisect_left
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import within
from tree_sway.core.wind import FASTEST_WIND, WindConvention
from tree_sway.drawn import Drawn
from tree_sway.errors import FormatError
from tree_sway.simulation.wind import LEAST_INTERVAL

_GAP_PERIODS, _SHORTEST_GAP = 3.0, 2.0
"""Least gap, in usual times between samples, and in [s]."""

_LEAST_OF_GAPS = 3
"""Number of times between samples of which one may be unusual."""


@dataclass(frozen=True, eq=False)
class WindRecord(Drawn):
    """
    Wind over time.

    Parameters
    ----------
    time
        Time of each sample after the first in [s], increasing, (n,).
    velocity
        Velocity of the wind, east, north, up, in [m/s], (n, 3).
    source
        Name of the file.
    refused
        Number of unusable rows of the file.
    first_refused
        First unusable row, with line and reason; empty if none.
    epoch
        Time of the first sample in seconds after 1970-01-01, in the clock of the file, which need
        not be UTC; None if the file has no dates.
    notes : tuple of str
        Assumptions and choices, one sentence each.
    gust
        Largest speed about each sample in [m/s], (n,), NaN where none is reported; None without.

    """

    time: Floats
    velocity: Floats
    source: str
    refused: int = 0
    first_refused: str = ''
    epoch: float | None = None
    notes: tuple[str, ...] = ()
    gust: Floats | None = None

    def __repr__(self) -> str:
        """Return source, length and mean speed on one line, and each note on one of its own."""
        seconds = float(self.time[-1]) if len(self.time) else 0.0
        speed = float(np.linalg.norm(self.velocity, axis=1).mean()) if len(self.time) else 0.0
        said = (
            f'WindRecord {self.source!r}: {len(self.time)} samples, {seconds:.4g} s, '
            f'mean speed {speed:.3g} m/s'
        )
        return '\n'.join([said, *(f'note: {each}' for each in self.notes)])

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        self.time.setflags(write=False)
        self.velocity.setflags(write=False)

    def with_note(self, note: str) -> WindRecord:
        """Return the record with one more note."""
        return replace(self, notes=(*self.notes, note))

    def after(self, start: float) -> WindRecord:
        """Return the record from a time after its first sample on [s]; wrong ones are errors."""
        kept = self.time >= within('start', start, 0.0, self.duration, 's')
        first = float(self.time[kept][0])
        return replace(
            self,
            time=self.time[kept] - first,
            velocity=self.velocity[kept],
            epoch=None if self.epoch is None else self.epoch + first,
            gust=None if self.gust is None else self.gust[kept],
        )

    @property
    def duration(self) -> float:
        """Time from the first sample to the last in [s]."""
        return float(self.time[-1])

    @property
    def period(self) -> float:
        """Median time between samples in [s]; 1 if there is only one."""
        return float(np.median(np.diff(self.time))) if len(self.time) > 1 else 1.0


@dataclass(slots=True)
class WindRows:
    """
    Rows for a record, and counts of refused ones.

    A row is a line, a sentence or a message by ``row_name``. Times are in [s]; components of the
    velocity are one row after the other in [m/s]; numbers are those of the rows in the file.
    """

    source: str
    row_name: str = 'line'
    # Arrays and not lists: a day at 20 Hz is 1.7 million rows.
    time: array[float] = field(default_factory=lambda: array('d'))
    velocity: array[float] = field(default_factory=lambda: array('d'))
    number: array[int] = field(default_factory=lambda: array('q'))
    gust: Floats | None = None
    refused: int = 0
    first_refused: str = ''
    _first_number: float = float('inf')

    def add(self, number: int, time: float, velocity: tuple[float, float, float]) -> None:
        """Add a row."""
        self.number.append(number)
        self.time.append(time)
        self.velocity.extend(velocity)

    def refuse(self, number: int, reason: str) -> None:
        """Count an unusable row; the first one in the file is stored."""
        self.refused += 1
        if number < self._first_number:
            self._first_number = number
            self.first_refused = f'{self.row_name} {number}: {reason}'

    def record(
        self,
        *,
        epoch: float | None = None,
        notes: tuple[str, ...] = (),
        yaw: float = 0.0,
        direction_convention: str = 'to',
    ) -> WindRecord:
        """
        Check times and speeds and return the record, converted by a `WindConvention`.

        Empty notes are left out.
        ``epoch`` is the origin of the times, in seconds after 1970-01-01, None if unknown. Raises
        a `FormatError` if no good row is left.
        """
        time = np.array(self.time)
        velocity = np.array(self.velocity).reshape(-1, 3)
        velocity = WindConvention(direction_convention, yaw_offset=yaw).velocity(velocity)
        speed = np.linalg.norm(velocity, axis=1)
        good = np.isfinite(time) & (speed <= FASTEST_WIND)
        for index in np.flatnonzero(~good):
            why = f'{speed[index]:.3g} m/s at {time[index]:g} s'
            why = 'no value' if np.isnan(speed[index]) else why
            self.refuse(self.number[index], why if np.isfinite(time[index]) else 'no time in it')
        rows = np.flatnonzero(good)
        late = ~increasing(time[rows])
        if 2 * np.count_nonzero(late) > len(late):
            raise FormatError(
                f'time stands or goes back in {np.count_nonzero(late)} of {len(late)} rows',
                where=self.source,
                cure='put the rows in order, and call the column of the clock time',
            )
        for index in rows[late]:
            self.refuse(self.number[index], 'its time is out of order')
        rows = rows[~late]
        if len(rows) == 0:
            first = f'; first {self.first_refused}' if self.refused else ''
            raise FormatError(
                f'no good row of wind, {self.refused} refused{first}',
                where=self.source,
                cure='check that it is a file of wind',
            )
        begin = float(time[rows[0]])
        time = time[rows] - begin
        gust = None if self.gust is None else self.gust[rows]
        told = (*notes, _gaps(time), _slower_gusts(gust, speed[rows]))
        return WindRecord(
            time, np.ascontiguousarray(velocity[rows]), self.source, self.refused,
            self.first_refused, None if epoch is None else epoch + begin,
            tuple(filter(None, told)), gust,
        )  # fmt: skip


def _slower_gusts(gust: Floats | None, speed: Floats) -> str:
    """Return a sentence about gusts (n,) that are mostly slower than the wind, in [m/s]."""
    if gust is None:
        return ''
    slower = np.count_nonzero(gust < speed)
    if 2 * slower <= np.count_nonzero(np.isfinite(gust)):
        return ''
    return f'the gust is slower than the wind in {slower} rows: are the columns swapped?'


def _gaps(time: Floats) -> str:
    """Return a sentence about the gaps in times (n,) [s], if there are any."""
    apart = np.diff(time)
    if len(apart) < _LEAST_OF_GAPS:
        return ''
    period = float(np.median(apart))
    gaps = apart[apart > max(_GAP_PERIODS * period, _SHORTEST_GAP)]
    if not len(gaps):
        return ''
    longest = int(apart.argmax())
    meanwhile = 'a straight line' if period >= LEAST_INTERVAL else 'a calm'
    return (
        f'no samples in {gaps.sum():.4g} of {time[-1]:.4g} s, the longest gap {gaps.max():.4g} s '
        f'from {time[longest]:.6g} s on: {meanwhile} is taken there'
    )


def increasing(time: Floats) -> NDArray[np.bool_]:
    """Mark a longest increasing sequence of times (n,), so that a wrong stamp is one sample."""
    if bool((np.diff(time) > 0.0).all()):
        return np.ones(len(time), dtype=np.bool_)
    keep = np.zeros(len(time), dtype=np.bool_)
    ends, last = [-np.inf], [-1]  # the least end of a sequence of each length, and its place
    before = list[int]()
    for index, value in enumerate(time.tolist()):
        length = bisect_left(ends, value)
        before.append(last[length - 1])
        ends[length : length + 1], last[length : length + 1] = [value], [index]
    index = last[-1]
    while index >= 0:
        keep[index] = True
        index = before[index]
    return keep
