# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Wind and motion of a tip over time; strength, and the cases of a study, over wind speed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.strength.strength_use import StrengthUse
from tree_sway.errors import ParameterError
from tree_sway.pictures.plotting import new_figure, save_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes

STUDY_COLUMNS = ('wind_mean [m/s]', 'tip_largest [m]', 'base_moment_largest [N m]')
"""Columns of a study that are drawn, the others over the first."""

_WIND = '#1f6fb4'
_EAST = '#2f6b2f'
_NORTH = '#c0682b'


def plot_wind_and_tip(
    time: ArrayLike, wind: ArrayLike, tip: ArrayLike, path: str | Path, *, title: str = ''
) -> Path:
    """
    Plot the wind's speed, the tip's displacement, and its path seen from above.

    Parameters
    ----------
    time
        In [s], (n,).
    wind
        Where it blows to in [m/s], (n, 3): east, north, up.
    tip
        Displacement of the tip from rest in [m], (n, 3).
    path, title
        File to write, whose suffix names the format, and the title of the plot.

    Raises
    ------
    ParameterError
        If the three do not go together.

    """
    t = np.asarray(time, dtype=np.float64)
    blowing = np.asarray(wind, dtype=np.float64)
    moved = np.asarray(tip, dtype=np.float64)
    if t.ndim != 1 or len(t) < 2 or blowing.shape != (len(t), 3) or moved.shape != (len(t), 3):
        raise ParameterError(
            f'time {t.shape}, wind {blowing.shape} and tip {moved.shape} do not go together',
            cure='give (n,), (n, 3) and (n, 3) with n of 2 or more',
        )
    figure = new_figure(10.0, 4.6)
    layout = figure.add_gridspec(
        2, 2, width_ratios=(2.3, 1.0), left=0.075, right=0.97, bottom=0.12, top=0.9, wspace=0.26
    )
    speed = figure.add_subplot(layout[0, 0])
    sway = figure.add_subplot(layout[1, 0], sharex=speed)
    above = figure.add_subplot(layout[:, 1])
    unit, scale = _readable(moved)
    _plot_speed(speed, t, blowing)
    sway.plot(t, scale * moved[:, 0], color=_EAST, lw=1.2, label='east')
    sway.plot(t, scale * moved[:, 1], color=_NORTH, lw=1.2, label='north')
    sway.set(xlabel='time [s]', ylabel=f'tip from rest [{unit}]', xlim=(t[0], t[-1]))
    _legend_above(sway)
    _plot_from_above(above, scale * moved, unit)
    for axes in (speed, sway, above):
        axes.grid(alpha=0.25)
        axes.spines[['top', 'right']].set_visible(False)
    figure.suptitle(title)
    return save_figure(figure, path)


def plot_strength(speeds: ArrayLike, used: Mapping[str, list[StrengthUse]], path: str) -> Path:
    """
    Plot the share of strength that trees use over the mean wind speed, wood beside roots.

    Parameters
    ----------
    speeds
        Mean wind speeds in [m/s], (n,).
    used
        By the name of each tree what it uses at each speed, with the bands of the sources.
    path
        File to write, whose suffix names the format.

    """
    figure = new_figure(10.0, 4.6)
    for axes, what in zip(figure.subplots(1, 2, sharey=True), ('wood', 'roots'), strict=True):
        for name, curve in used.items():
            share, least, most = np.array([getattr(each, what) for each in curve]).T
            (line,) = axes.plot(speeds, 100.0 * share, label=name)
            axes.fill_between(
                speeds, 100.0 * least, 100.0 * most, color=line.get_color(), alpha=0.15, lw=0
            )
        axes.axhline(100.0, color='black', lw=0.8, ls='--')
        axes.set(title=what, xlabel='mean wind [m/s]', ylim=(0.0, 200.0))
        axes.grid(alpha=0.25)
        axes.spines[['top', 'right']].set_visible(False)
    figure.axes[0].set_ylabel('share of strength in gusts [%]')
    figure.axes[0].legend(frameon=False)
    figure.suptitle('left out: rot, wounds, wet or shallow soil, sheltering by neighbours')
    return save_figure(figure, path)


def plot_study(rows: Sequence[Mapping[str, str]], path: str) -> Path:
    """
    Plot largest motion of the tip and base moment of a study's cases over the mean wind.

    Parameters
    ----------
    rows
        Cases with `STUDY_COLUMNS`, and ``tree_...`` columns that name the tree of each.
    path
        File to write, whose suffix names the format.

    Raises
    ------
    ValueError, TypeError
        A figure that is no number, or is missing.

    """
    trees: dict[str, list[tuple[float, ...]]] = {}
    for row in rows:
        name = ', '.join(row[key] for key in row if key.startswith('tree_') and row[key])
        trees.setdefault(name, []).append(tuple(float(row[key]) for key in STUDY_COLUMNS))
    figure = new_figure(10.0, 4.6)
    for k, axes in enumerate(figure.subplots(1, 2), 1):
        for name, cases in trees.items():
            wind, *figures = np.array(sorted(cases)).T
            axes.plot(wind, figures[k - 1], '.-', label=name)
        axes.set(xlabel=STUDY_COLUMNS[0], ylabel=STUDY_COLUMNS[k], ylim=(0.0, None))
        axes.grid(alpha=0.25)
        axes.spines[['top', 'right']].set_visible(False)
    figure.axes[0].legend(frameon=False, title='tree')
    return save_figure(figure, path)


def _readable(moved: Floats) -> tuple[str, float]:
    """Choose the unit in which the displacement reads well, and its factor from metres."""
    largest = float(np.abs(moved).max())
    return ('m', 1.0) if largest >= 1.0 else ('cm', 100.0) if largest >= 0.01 else ('mm', 1000.0)


def _plot_speed(axes: Axes, t: Floats, blowing: Floats) -> None:
    speed = np.linalg.norm(blowing, axis=1)
    axes.fill_between(t, speed, color=_WIND, alpha=0.15, lw=0)
    axes.plot(t, speed, color=_WIND, lw=1.2)
    axes.axhline(speed.mean(), color=_WIND, lw=0.8, ls='--')
    axes.annotate(
        f'mean {speed.mean():.1f} m/s',
        (1.0, 1.03),
        xycoords='axes fraction',
        ha='right',
        color=_WIND,
    )
    axes.set(ylabel='wind [m/s]', ylim=(0.0, max(1.1 * float(speed.max()), 0.1)))
    axes.tick_params(labelbottom=False)


def _legend_above(axes: Axes) -> None:
    axes.legend(
        loc='lower right', bbox_to_anchor=(1.02, 0.96), ncols=2, frameon=False, handlelength=1.2
    )


def _plot_from_above(axes: Axes, moved: Floats, unit: str) -> None:
    """Plot the tip's path."""
    axes.plot(*moved[:, :2].T, color=_EAST, lw=0.8)
    axes.plot(0.0, 0.0, '+', color='black', ms=8)
    reach = 1.15 * max(float(np.abs(moved[:, :2]).max()), 1e-3)
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect='equal')
    axes.set(xlabel=f'east [{unit}]', ylabel=f'north [{unit}]', title='tip from above')
