# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A table over days of what motion sensors tell about a tree: a row for every ten minutes."""

from __future__ import annotations

from collections.abc import Sequence
import csv
from datetime import datetime, timezone
import io
import os

import numpy as np

from tree_sway.errors import FormatError, ParameterError
from tree_sway.files.atomic_file import refuse_unwritable, refusing
from tree_sway.files.paths import path_of
from tree_sway.files.text_file import read_bytes
from tree_sway.twin import ObservedTree, sensor_reports

PERIOD = 600.0
"""Time of a row in [s]."""

_MEANS = ('wind [m/s]', 'explained [-]', 'band from [m]', 'band to [m]')
_LEARNED = {
    'first frequency [Hz]': 'frequency',
    'stiffness [-]': 'stiffness',
    'damping [-]': 'damping',
    'drag [-]': 'drag',
    'learned from [h]': 'hours',
}
"""Columns of what was learned, and the attributes of a `LearnedTree`."""
_IN_USE, _RESIDUAL, _REFUSED, _CHANGE = _OF_SENSOR = (
    'in use [-]',
    'residual [-]',
    'refused',
    'frequencies over those before [-]',
)


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


def _columns(names: Sequence[str]) -> list[str]:
    of_sensors = [f'{name}: {each}' for name in names for each in _OF_SENSOR]
    return ['time', *_MEANS, *_LEARNED, *of_sensors]


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
        self._path = path_of(path)
        self._names = list(names)
        self._began: float | None = None
        self._noted = list[dict[str, float]]()

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
        present = (twin.observer.mean_wind, twin.explained, *band)
        row = dict(zip(_MEANS, present, strict=True))
        for each in reports:
            row[f'{each.name}: {_IN_USE}'] = float(each.in_use)
            row[f'{each.name}: {_RESIDUAL}'] = each.residual
        self._noted.append(row)
        if now - self._began < PERIOD:
            return False
        means = {name: float(np.mean([each[name] for each in self._noted])) for name in row}
        self._began = now
        self._noted = []
        self._write(twin, means)
        return True

    def _write(self, twin: ObservedTree, means: dict[str, float]) -> None:
        values: dict[str, float | None] = {**means}
        values |= {column: getattr(twin.learned, each, None) for column, each in _LEARNED.items()}
        for each in sensor_reports(twin):
            values[f'{each.name}: {_REFUSED}'] = each.refused
            values[f'{each.name}: {_CHANGE}'] = getattr(each.change, 'ratio', None)
        date = datetime.now(timezone.utc).strftime('%Y-%m-%dT%H:%M:%SZ')
        columns = _columns(self._names)
        known = [values[column] for column in columns[1:]]
        line = _line_of([date, *('' if each is None else f'{each:.6g}' for each in known)])
        with refusing(self._path, 'make room'), self._path.open('a+b') as file:
            begin = '' if file.tell() else _line_of(columns)
            if file.tell():
                file.seek(-1, os.SEEK_END)
                # A full disk or a loss of power leaves the last row without its end.
                begin = '' if file.read(1) == b'\n' else '\n'
            file.write((begin + line).encode())
