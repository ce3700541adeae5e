"""The work-precision chart: every method's error against its cost, as PNG and CSV."""

from __future__ import annotations

import csv
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from tree_sway_ros.errors import MissingDependencyError
from tree_sway_ros.files.whole_file import whole_file
from tree_sway_ros.study.battery.work_precision import Point, measure

SHOWN_RATE = 60
PAPER, MINIMAL, EXACT, DEFAULT = "#c8742c", "#3b6ea5", "#2f8f5b", "#c2293a"
SYSTEMS, WINDS = ("1 segment", "6 segments"), ("smooth", "gusty", "turning")


def chart_methods(out_dir: str | Path, points: list[Point] | None = None) -> list[Path]:
    """
    Measure every method, draw error against operations and against time, write the figures as CSV.

    Parameters
    ----------
    out_dir
        Folder for ``methods.png`` (operations), ``methods_time.png`` (time) and ``methods.csv``.
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
    try:
        import matplotlib
    except ImportError as error:
        raise MissingDependencyError(
            "matplotlib is not installed", where="chart", cure="pip install matplotlib"
        ) from error
    matplotlib.use("Agg")
    folder = Path(out_dir)
    folder.mkdir(parents=True, exist_ok=True)
    points = measure() if points is None else points
    table = folder / "methods.csv"
    with whole_file(table) as partial, partial.open("w", newline="") as sheet:
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
    files = [table]
    for cost, name, label in (
        ("flops", "methods.png", "operations a step  [flop]"),
        ("wall_ratio", "methods_time.png", "time a step over semi-implicit Euler's  [-]"),
    ):
        file = folder / name
        _draw(points, cost, label, file)
        files.append(file)
    return files


def colour(point: Point) -> str:
    """Colour of a method's family."""
    if point.method == "exact_foh":
        return DEFAULT
    if point.method.startswith(("exact", "exponential")):
        return EXACT
    return PAPER if point.form == "multiplier" else MINIMAL


def _draw(points: list[Point], cost: str, label: str, file: Path) -> None:
    """Six panels of numbered marks, with the names beneath."""
    import matplotlib.pyplot as plt
    from matplotlib.lines import Line2D

    shown = [p for p in points if p.rate == SHOWN_RATE]
    names = list(dict.fromkeys(p.method for p in shown))
    figure, axes = plt.subplots(2, 3, figsize=(13, 11.2), sharey=True)
    figure.subplots_adjust(left=0.075, right=0.985, top=0.93, bottom=0.27, wspace=0.05, hspace=0.2)
    for row, system in enumerate(SYSTEMS):
        for column, wind in enumerate(WINDS):
            panel = [p for p in shown if p.system == system and p.wind == wind]
            ax = axes[row, column]
            _panel(ax, panel, cost, names)
            ax.set_title(f"{system}, {wind} wind", fontsize=14)
            if row == 1:
                ax.set_xlabel(label, fontsize=13)
        axes[row, 0].set_ylabel("rms error of the angle  [rad]", fontsize=13)
    figure.suptitle("Error against cost of one step at 60 steps a second, 2 Hz branch", fontsize=16)
    marks = {p.method: colour(p) for p in shown}
    handles = [
        Line2D(
            [],
            [],
            marker="o",
            ls="",
            color=marks[name],
            markersize=9,
            label=f"{k + 1}  {name.replace('multiplier_', 'multiplier ').replace('_', ' ')}",
        )
        for k, name in enumerate(names)
    ]
    figure.legend(
        handles=handles,
        loc="lower center",
        ncol=4,
        fontsize=12,
        frameon=False,
        handletextpad=0.2,
        columnspacing=1.4,
        bbox_to_anchor=(0.5, 0.045),
    )
    figure.text(
        0.5,
        0.02,
        "orange: the paper's multiplier form    blue: angles only    green: exact for "
        "the linear part    red: the default    x: blew up",
        ha="center",
        fontsize=13,
    )
    with whole_file(file) as partial:
        figure.savefig(partial, dpi=100)
    plt.close(figure)


def _panel(ax: Any, panel: list[Point], cost: str, names: list[str]) -> None:
    """
    One wind and system: marks, numbers that keep out of each other's way, the blown-up on top.

    """
    top = 0.5
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.set_ylim(1e-8, 2.0)
    costs = np.array([float(getattr(p, cost)) for p in panel])
    ax.set_xlim(costs.min() / 1.8, costs.max() * 2.2)
    ax.axhspan(0.22, 2.0, color="0.93", lw=0)
    ax.text(
        0.985,
        0.965,
        "blew up",
        transform=ax.transAxes,
        ha="right",
        va="center",
        fontsize=11,
        color="0.35",
    )
    ax.grid(True, which="major", color="0.88", lw=0.8)
    ax.set_axisbelow(True)
    ax.tick_params(labelsize=12)
    placed = [
        tuple(map(float, ax.transData.transform((x, top if np.isnan(p.error) else p.error))))
        for p, x in zip(panel, costs, strict=True)
    ]
    for p, x in sorted(zip(panel, costs, strict=True), key=lambda pair: pair[1]):
        gone = np.isnan(p.error)
        y = top if gone else p.error
        default = p.method == "exact_foh"
        ax.plot(
            x,
            y,
            marker="x" if gone else ("*" if default else "o"),
            color=colour(p),
            markersize=17 if default else 8,
            zorder=3,
            mew=2 if gone else 0.5,
        )
        _number(ax, x, y, str(names.index(p.method) + 1), colour(p), placed)


def _number(
    ax: Any, x: float, y: float, text: str, ink: str, placed: list[tuple[float, ...]]
) -> None:
    """Write a number beside its mark, at the first place of a ring that no other number has."""
    spot = np.array(ax.transData.transform((x, y)))
    best = None
    for radius in (13, 22, 31, 40, 50):
        for angle in np.radians([45, 90, 0, 135, 270, 315, 180, 225]):
            at = spot + radius * np.array([np.cos(angle), np.sin(angle)])
            if all(abs(at[0] - u) > 17 or abs(at[1] - v) > 13 for u, v in placed):
                best = at
                break
        if best is not None:
            break
    at = spot + np.array([13.0, 13.0]) if best is None else best
    placed.append((float(at[0]), float(at[1])))
    far = float(np.hypot(*(at - spot))) > 25
    ax.annotate(
        text,
        (x, y),
        xytext=tuple(at - spot),
        textcoords="offset pixels",
        ha="center",
        va="center",
        fontsize=12,
        color=ink,
        fontweight="bold",
        zorder=4,
        arrowprops={"arrowstyle": "-", "color": ink, "lw": 0.6} if far else None,
    )
