# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A table whose rows are on the disk as they come, so that one that breaks off can be read."""

from __future__ import annotations

from collections.abc import Sequence
import csv
from pathlib import Path
import time
from typing import TextIO

from tree_sway.commands.said import say
from tree_sway.core.wind import shorter_than
from tree_sway.errors import FormatError


class RowFile:
    """
    A CSV file that is opened with its first row: without one there is none, and an older stays.

    A failure to write, as of a full disk, is kept and not raised, since rows are written by the
    thread of a source; further rows are then not written.

    Parameters
    ----------
    path
        The file.

    """

    def __init__(self, path: Path) -> None:
        self.count = 0
        """Number of rows on the disk."""
        self.failure = ''
        """Why a row could not be written; empty without a failure."""
        self._path = path
        self._first: float | None = None
        self._last = 0.0
        self._file: TextIO | None = None

    def write(self, header: Sequence[str], row: Sequence[object]) -> None:
        """Write a row, and before the first one the header."""
        if self.failure:
            return
        try:
            if self._file is None:
                self._file = self._path.open('w', encoding='utf-8', newline='')
                csv.writer(self._file, lineterminator='\n').writerow(header)
            csv.writer(self._file, lineterminator='\n').writerow(row)
            self._file.flush()
        except OSError as error:
            self.failure = error.strerror or str(error)
            return
        self._last = time.monotonic()
        if self._first is None:
            self._first = self._last
        self.count += 1

    def hold(self) -> None:
        """Take now as the time of the first row, which is written later."""
        self._first = time.monotonic()

    def say_short(self, seconds: float) -> None:
        """Print a note where rows came for a shorter time [s]; each stands for its period."""
        since = self._last if self._first is None else self._first
        length = (self._last - since) * self.count / max(self.count - 1, 1)
        if short := shorter_than(length, seconds, self._path.name):
            say(short)

    def close(self) -> None:
        """Close the file; a `FormatError` if a row could not be written."""
        try:
            if self._file is not None:
                self._file.close()
        except OSError as error:  # what could not be flushed before
            self.failure = self.failure or error.strerror or str(error)
        if self.failure:
            what = f'cannot be written after {self.count} rows: {self.failure}'
            cure = 'make room; the rows before can be read'
            raise FormatError(what, where=str(self._path), cure=cure)
