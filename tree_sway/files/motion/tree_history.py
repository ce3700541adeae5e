# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A table over days of what motion sensors tell about a tree: a row for every ten minutes."""

from __future__ import annotations

from collections.abc import Sequence
import csv
from datetime import datetime, timezone
import io
import os
from pathlib import Path

import numpy as np

from tree_sway.errors import FormatError, ParameterError
from tree_sway.files.atomic_file import refuse_unwritable
from tree_sway.files.paths import path_of
from tree_sway.files.text_file import read_bytes
from tree_sway.twin import ObservedTree, sensor_reports

PERIOD = 600.0
"""Time of a row in [s]."""

_OF_TREE = (
    'time', 'wind [m/s]', 'explained [-]', 'band from [m]', 'band to [m]',
    'first frequency [Hz]', 'stiffness [-]', 'damping [-]', 'drag [-]', 'learned from [h]',
)  # fmt: skip
_OF_SENSOR = ('in use [-]', 'residual [-]', 'refused', 'frequencies over those before [-]')


def refuse_no_history(path: str, names: Sequence[str]) -> None:
    """
    Refuse a table that cannot be gone on with, before work for it.

    Raises
    ------
    FormatError
        A file that cannot be written, or that has other columns.
    ParameterError
        No sensor whose name is given.

    """
    if not names:
        raise ParameterError(
            'no motion sensor to tell of', where=path, cure='give a sensor and its place'
        )
    refuse_unwritable(path)
    found = path_of(path)
    if not found.is_file():
        return
    line = _line_of(_columns(names)).encode()
    head = read_bytes(found, at_most=len(line))
    if head and head.rstrip() != line.rstrip():
        raise FormatError(
            'has other columns',
            where=path,
            cure='name another file; sensors of one table keep their names and places',
        )


def _line_of(cells: Sequence[str]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator='\n').writerow(cells)
    return text.getvalue()


def _is_cut_off(path: Path) -> bool:
    """Whether the last row of a table has no end, as a full disk or a loss of power leaves it."""
    if not path.is_file() or path.stat().st_size == 0:
        return False
    with path.open('rb') as file:
        file.seek(-1, os.SEEK_END)
        return file.read(1) != b'\n'


def _columns(names: Sequence[str]) -> list[str]:
    return [*_OF_TREE, *(f'{name}: {each}' for name in names for each in _OF_SENSOR)]


class TreeHistory:
    """
    Means of what is known about an observed tree, row after row.

    Rows are added to a file that is already there.

    Parameters
    ----------
    path
        The file.
    names
        Names of the sensors.

    Raises
    ------
    FormatError, ParameterError
        As `refuse_no_history`.

    """

    def __init__(self, path: str, names: Sequence[str]) -> None:
        refuse_no_history(path, names)
        self._path: Path = path_of(path)
        self._names = list(names)
        self._began: float | None = None
        self._noted: list[list[float]] = []

    def note(self, twin: ObservedTree, now: float) -> bool:
        """
        Note the present state of a tree; write a row when it is due.

        Parameters
        ----------
        twin
            The tree.
        now
            Time in [s] of any clock that does not go back.

        Returns
        -------
        bool
            Whether a row was written.

        """
        reports = sensor_reports(twin)
        if [each.name for each in reports] != self._names:
            return False
        if self._began is None:
            self._began = now
        band = twin.sway_band().tolist() if twin.members is not None else [np.nan, np.nan]
        row = [twin.observer.mean_wind, twin.explained, *band]
        for each in reports:
            row += [float(each.in_use), each.residual]
        self._noted.append(row)
        if now - self._began < PERIOD:
            return False
        means = np.mean(self._noted, axis=0).tolist()
        self._began = now
        self._noted = []
        self._write(twin, means)
        return True

    def _write(self, twin: ObservedTree, means: list[float]) -> None:
        learned = twin.learned
        values: list[float | None] = [*means[:4], *5 * [None]]
        if learned is not None:
            values[4:] = [
                learned.frequency, learned.stiffness, learned.damping, learned.drag, learned.hours,
            ]  # fmt: skip
        for k, each in enumerate(sensor_reports(twin)):
            ratio = None if each.change is None else each.change.ratio
            values += [*means[4 + 2 * k : 6 + 2 * k], each.refused, ratio]
        date = datetime.now(timezone.utc).isoformat(timespec='seconds').replace('+00:00', 'Z')
        cells = ['' if value is None else f'{value:.6g}' for value in values]
        try:
            is_cut_off = _is_cut_off(self._path)
            with self._path.open('a', encoding='utf-8', newline='') as file:
                if is_cut_off:
                    file.write('\n')
                if file.tell() == 0:
                    file.write(_line_of(_columns(self._names)))
                file.write(_line_of([date, *cells]))
        except OSError as error:
            raise FormatError(
                f'cannot be written: {error.strerror or error}',
                where=str(self._path),
                cure='make room',
            ) from error
