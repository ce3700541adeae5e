# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The work-precision chart: error against work of every method, as PNG and CSV."""

from __future__ import annotations

import csv
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from tree_sway.files import whole_file
from tree_sway.pictures import new_figure, save_figure
from tree_sway_lab.battery.work_precision import measure, Point, REFERENCE_RATE

SYSTEMS, WINDS = ('1 segment', '6 segments'), ('smooth', 'gusty', 'turning')
NAMED = {
    'exact_foh': ('#c2293a', 'exact, linear load:\nthe default', 2, (-8, -32), 'center'),
    'exact_zoh': ('#2f8f5b', 'exact, constant load', 2, (0, -18), 'right'),
    'semi_implicit_euler': ('#3b6ea5', 'semi-implicit Euler', 0, (0, 9), 'left'),
    'rk4': ('#7a4fa3', 'Runge-Kutta 4', 2, (-4, -17), 'left'),
    'tr_bdf2': ('#1b9aaa', 'TR-BDF2', 2, (9, -6), 'left'),
    'baumgarte': ('#c8742c', 'multipliers,\nBaumgarte on RK4', 2, (-4, -32), 'left'),
    'radau_ggl': ('#8a6d3b', 'multipliers,\nRadau IIA', 2, (4, -32), 'right'),
}
"""Methods with a name at their line: colour, name, at which point, how far off it, alignment."""

_MAIN = ('1 segment', 'gusty')
_GREY = '#c9c9c9'
_TOP, _LOWEST = 2.0, 1e-9


def chart_methods(out_dir: str | Path, points: list[Point] | None = None) -> list[Path]:
    """
    Measure every method, draw error against work, write the figures as CSV.

    Parameters
    ----------
    out_dir
        Folder for ``methods.png`` and ``methods.csv``.
    points
        Measurements to draw instead of new ones.

    Returns
    -------
    list[Path]
        The files written.

    Raises
    ------
    MissingDependencyError
        If matplotlib is not installed.

    """
    folder = Path(out_dir)
    folder.mkdir(parents=True, exist_ok=True)
    points = measure() if points is None else points
    table = folder / 'methods.csv'
    with whole_file(table) as partial, partial.open('w', newline='', encoding='utf-8') as sheet:
        writer = csv.DictWriter(sheet, list(asdict(points[0])))
        writer.writeheader()
        writer.writerows(
            {
                **asdict(p),
                'error': 'gone' if np.isnan(p.error) else f'{p.error:.3e}',
                'wall_ratio': f'{p.wall_ratio:.2f}',
            }
            for p in points
        )
    return [table, _draw(points, table)]


def _draw(points: list[Point], table: Path) -> Path:
    """One panel with names and five small ones: a line per method over its rates."""
    figure = new_figure(13.0, 7.6)
    grid = figure.add_gridspec(
        3, 4, left=0.06, right=0.99, top=0.88, bottom=0.08, wspace=0.2, hspace=0.3,
        width_ratios=(1.5, 1.5, 1.35, 1.35),
    )  # fmt: skip
    for column, system in enumerate(SYSTEMS):
        for row, wind in enumerate(WINDS):
            is_main = (system, wind) == _MAIN
            ax = figure.add_subplot(grid[:, :2] if is_main else grid[row, 2 + column])
            here = [p for p in points if p.system == system and p.wind == wind]
            ax.set_title(f'{system}, {wind} wind', fontsize=13 if is_main else 10)
            ax.set(xscale='log', yscale='log', ylim=(1e-6 if is_main else _LOWEST, 4 * _TOP))
            ax.axhspan(0.5 * _TOP, 4 * _TOP, color='0.95', lw=0)
            for method in sorted({p.method for p in here}, key=lambda name: name in NAMED):
                _line(ax, [p for p in here if p.method == method], with_name=is_main)
            ax.grid(color='0.9', lw=0.7)
            ax.set_axisbelow(True)
            ax.spines[['top', 'right']].set_visible(False)
            ax.tick_params(labelsize=10 if is_main else 8)
            if is_main:
                style: dict[str, Any] = {'transform': ax.transAxes, 'color': '0.4'}
                others = len({p.method for p in points} - set(NAMED))
                ax.text(0.02, 0.985, 'blew up', va='top', **style)
                ax.text(0.98, 0.84, f'{others} others: grey', ha='right', va='top', **style)
                ax.set_xlabel('operations per second of wind [flop/s]', fontsize=11)
                ax.set_ylabel("rms error of the branch's angle [rad]", fontsize=11)
    rates = ', '.join(map(str, sorted({p.rate for p in points})))
    truth = ' and '.join(f'{rate} (n = {n})' for n, rate in REFERENCE_RATE.items())
    key = figure.add_subplot(grid[WINDS.index(_MAIN[1]), 2 + SYSTEMS.index(_MAIN[0])])
    key.axis('off')
    key.text(
        0.0, 0.5, f'Each line is one method at\n{rates} steps per second,\nfrom left to right.\n'
        f'\nThe truth is Radau IIA at\n{truth}\nsteps per second, n segments.',
        va='center', fontsize=9.5, transform=key.transAxes,
    )  # fmt: skip
    figure.suptitle(
        'What accuracy costs: methods of integration on a branch of 2 Hz in wind; down and left '
        'is better',
        fontsize=13,
    )
    return save_figure(figure, table.with_suffix('.png'), figures=table)


def _line(ax: Any, points: list[Point], *, with_name: bool) -> None:
    """One method, from its fewest to its most steps per second."""
    points = sorted(points, key=lambda p: p.rate)
    named = NAMED.get(points[0].method)
    colour = named[0] if named else _GREY
    work = np.array([p.flops * p.rate for p in points], dtype=float)
    error = np.array([p.error for p in points])
    gone = np.isnan(error)
    size, order = (6.0 if with_name else 4.0, 3) if named else (3.0, 2)
    shown = np.maximum(error, 1.5 * _LOWEST)
    ax.plot(work, shown, 'o-', color=colour, ms=size, lw=1.8 if named else 0.8, zorder=order)
    ax.plot(work[gone], np.full(gone.sum(), _TOP), 'x', color=colour, ms=size, zorder=order)
    if named and with_name:
        _, name, at, offset, side = named
        place = work[at], shown[at]
        ax.annotate(
            name, place, xytext=offset, textcoords='offset points', ha=side, color=colour, zorder=4
        )
