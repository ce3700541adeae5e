# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a benchmark measured: as a table, as JSON, as a chart, against an earlier file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
import json
from pathlib import Path
from typing import Any

from tree_sway.errors import FormatError
from tree_sway.files import read_text
from tree_sway.pictures import new_figure, save_figure


@dataclass(frozen=True)
class Measured:
    """
    One figure.

    Parameters
    ----------
    name
        Quantity that was measured.
    value
        The figure; less is better, unless stated otherwise.
    unit
        Its unit, ``-`` for none.

    """

    name: str
    value: float
    unit: str


def read_baseline(path: str | Path) -> dict[str, float]:
    """
    Read the values of a file that `as_json` made.

    Raises
    ------
    FormatError
        A file without figures.

    """
    try:
        rows = json.loads(read_text(Path(path)))['measured']
        return {str(row['name']): float(row['value']) for row in rows}
    except (ValueError, KeyError, TypeError) as error:
        raise FormatError(
            'no figures of a benchmark', where=str(path), cure='give a file of bench --json'
        ) from error


def as_json(rows: Sequence[Measured], **also: Any) -> str:
    """Return figures and what else is given as JSON."""
    return json.dumps({**also, 'measured': [asdict(row) for row in rows]}, indent=2) + '\n'


def table(rows: Sequence[Measured], baseline: dict[str, float] | None = None) -> str:
    """Lay figures out in lines, with their ratio to a baseline if there is one."""
    width = max(len(row.name) for row in rows)
    lines = []
    for row in rows:
        line = f'  {row.name:{width}}  {row.value:10.4g} {row.unit}'
        before = (baseline or {}).get(row.name)
        if before:
            line += f'   {row.value / before:.2f} of the baseline'
        lines.append(line)
    return '\n'.join(lines)


def draw(rows: Sequence[Measured], path: str | Path, title: str) -> None:
    """
    Draw the figures of the unit that most of them have as bars, on a logarithmic axis.

    Raises
    ------
    MissingDependencyError
        If matplotlib is not installed.

    """
    units = [row.unit for row in rows]
    unit = max(dict.fromkeys(units), key=units.count)
    shown = [row for row in rows if row.unit == unit and row.value > 0.0]
    figure = new_figure(8.0, 0.8 + 0.35 * len(shown))
    axes = figure.subplots()
    axes.barh([row.name for row in shown][::-1], [row.value for row in shown][::-1])
    axes.set_xscale('log')
    axes.set_xlabel(f'[{unit}]')
    axes.set_title(title)
    save_figure(figure, path)
