# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The work-precision chart: error against work of every method, as PNG and CSV."""

from __future__ import annotations

import csv
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from tree_sway_ros.files.whole_file import whole_file
from tree_sway_ros.study.battery.work_precision import Point, measure
from tree_sway_ros.view.plotting import new_figure, save_figure

SYSTEMS, WINDS = ("1 segment", "6 segments"), ("smooth", "gusty", "turning")
NAMED = {
    "exact_foh": ("#c2293a", "exact, linear load: the default"),
    "exact_zoh": ("#2f8f5b", "exact, held load"),
    "semi_implicit_euler": ("#3b6ea5", "semi-implicit Euler"),
    "rk4": ("#7a4fa3", "Runge-Kutta 4"),
    "tr_bdf2": ("#1b9aaa", "TR-BDF2"),
    "baumgarte": ("#c8742c", "multipliers, Baumgarte on RK4"),
    "radau_ggl": ("#8a6d3b", "multipliers, Radau IIA: the reference"),
}
"""Methods with a line of their own: colour and name; the others are grey."""

_GREY = "#c9c9c9"
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
    table = folder / "methods.csv"
    with whole_file(table) as partial, partial.open("w", newline="", encoding="utf-8") as sheet:
        writer = csv.DictWriter(sheet, list(asdict(points[0])))
        writer.writeheader()
        writer.writerows(
            {
                **asdict(p),
                "error": "gone" if np.isnan(p.error) else f"{p.error:.3e}",
                "wall_ratio": f"{p.wall_ratio:.2f}",
            }
            for p in points
        )
    return [table, _draw(points, table)]


def _draw(points: list[Point], table: Path) -> Path:
    """Six panels: a line per method over its rates, named or grey; what blew up stands on top."""
    figure = new_figure(12.0, 8.6)
    grid = {"left": 0.075, "right": 0.985, "top": 0.9, "bottom": 0.17, "wspace": 0.06}
    axes = figure.subplots(2, 3, sharey=True, gridspec_kw={**grid, "hspace": 0.22})
    rates = sorted({p.rate for p in points})
    for row, system in enumerate(SYSTEMS):
        for column, wind in enumerate(WINDS):
            ax = axes[row, column]
            here = [p for p in points if p.system == system and p.wind == wind]
            ax.set_title(f"{system}, {wind} wind", fontsize=12)
            ax.set(xscale="log", yscale="log", ylim=(_LOWEST, 4 * _TOP))
            ax.axhspan(0.5 * _TOP, 4 * _TOP, color="0.95", lw=0)
            for method in sorted({p.method for p in here}, key=lambda name: name in NAMED):
                _line(ax, [p for p in here if p.method == method])
            ax.grid(color="0.9", lw=0.7)
            ax.set_axisbelow(True)
            ax.spines[["top", "right"]].set_visible(False)
        axes[row, 0].set_ylabel("rms error of the angle [rad]", fontsize=11)
    axes[0, 0].text(0.02, 0.97, "blew up", transform=axes[0, 0].transAxes, va="top", color="0.4")
    for ax in axes[1]:
        ax.set_xlabel("operations per second of wind [flop/s]", fontsize=11)
    others = len({p.method for p in points} - set(NAMED))
    told = [*NAMED.values(), (_GREY, f"{others} others")]
    lines = [axes[0, 0].plot([], [], "o-", color=ink, label=name)[0] for ink, name in told]
    figure.legend(handles=lines, loc="lower center", ncol=4, frameon=False, fontsize=11)
    figure.suptitle(
        f"Error against work at {', '.join(map(str, rates))} steps per second, branch of 2 Hz; "
        "down and left is better",
        fontsize=13,
    )
    return save_figure(figure, table.with_suffix(".png"), figures=table)


def _line(ax: Any, points: list[Point]) -> None:
    """One method, from its fewest to its most steps per second."""
    points = sorted(points, key=lambda p: p.rate)
    colour, _ = NAMED.get(points[0].method, (_GREY, ""))
    named = points[0].method in NAMED
    work = np.array([p.flops * p.rate for p in points], dtype=float)
    error = np.array([p.error for p in points])
    gone = np.isnan(error)
    size, order = (6.0, 3) if named else (3.5, 2)
    shown = np.maximum(error, 1.5 * _LOWEST)
    ax.plot(work, shown, "o-", color=colour, ms=size, lw=1.8 if named else 0.8, zorder=order)
    ax.plot(work[gone], np.full(gone.sum(), _TOP), "x", color=colour, ms=size, zorder=order)
