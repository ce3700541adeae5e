# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Wind and motion of a tip over time; strength, and the cases of a study, over wind speed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.errors import ParameterError
from tree_sway.pictures.plotting import new_figure
from tree_sway.simulation import StrengthUse

if TYPE_CHECKING:
    from matplotlib.figure import Figure

STUDY_COLUMNS = ('wind_mean [m/s]', 'tip_largest [m]', 'base_moment_largest [N m]')
"""Columns of a study that are drawn, over the first one."""


def wind_and_tip(time: ArrayLike, wind: ArrayLike, tip: ArrayLike, title: str = '') -> Figure:
    """
    Plot the wind's speed and the tip's displacement over time.

    Parameters
    ----------
    time
        Time in [s], (n,).
    wind
        Velocity of the wind in [m/s], (n, 3): east, north, up.
    tip
        Displacement of the tip from rest in [m], (n, 3).
    title
        Title of the plot.

    Raises
    ------
    ParameterError
        If the shapes of the three do not match.

    """
    t, blowing, moved = (np.asarray(each, dtype=np.float64) for each in (time, wind, tip))
    shapes = blowing.shape, moved.shape
    if t.ndim != 1 or len(t) < 2 or shapes != ((len(t), 3), (len(t), 3)):
        raise ParameterError(
            f'time {t.shape}, wind {blowing.shape} and tip {moved.shape} do not match',
            cure='give (n,), (n, 3) and (n, 3) with n of 2 or more',
        )
    figure = new_figure(10.0, 4.6)
    speed, sway = figure.subplots(2, 1, sharex=True)
    speeds = np.linalg.norm(blowing, axis=1)
    speed.plot(t, speeds, label=f'speed, {speeds.mean():.3g} m/s on average')
    speed.set(ylabel='wind [m/s]', ylim=(0.0, None))
    sway.plot(t, moved[:, 0], label='east')
    sway.plot(t, moved[:, 1], label='north')
    sway.set(xlabel='time [s]', ylabel='tip from rest [m]', xlim=(t[0], t[-1]))
    return labelled(figure, title)


def strength_over_wind(speeds: ArrayLike, used: Mapping[str, list[StrengthUse]]) -> Figure:
    """
    Plot the share of strength that trees use over the mean wind speed, wood beside roots.

    Parameters
    ----------
    speeds
        Mean wind speeds in [m/s], (n,).
    used
        Used shares at each speed, with the bands of the sources, by the name of each tree, where
        it stands and the height of its mean wind.

    """
    figure = new_figure(10.0, 4.6)
    for axes, what in zip(figure.subplots(1, 2, sharey=True), ('wood', 'roots'), strict=True):
        for name, curve in used.items():
            percent = 100.0 * np.array([getattr(each, what) for each in curve])
            share, least, most = percent.T
            unknown = bool(np.isnan(share).all())
            (line,) = axes.plot(speeds, share, label=f'{name}: unknown' if unknown else name)
            axes.fill_between(
                speeds, least, most, color=line.get_color(), alpha=0.15, lw=0,
                label=None if unknown else 'of 80 % of such trees',
            )  # fmt: skip
        axes.axhline(100.0, color='black', lw=0.8, ls='--')
        fastest = float(np.max(np.asarray(speeds)))
        axes.set(title=what, xlabel='mean wind [m/s]', xlim=(0.0, fastest), ylim=(0.0, 200.0))
    figure.axes[0].set_ylabel('share of strength, largest gust of 10 min [%]')
    return labelled(figure, 'not included: rot, wounds, wet or shallow soil')


def study_over_wind(rows: Sequence[Mapping[str, str]]) -> Figure:
    """
    Plot largest motion of the tip and base moment of a study's cases over the mean wind.

    Parameters
    ----------
    rows
        Cases with `STUDY_COLUMNS`, and ``tree_...`` columns of the tree of each.

    Raises
    ------
    ValueError, TypeError
        A value that is missing or not a number.

    """
    trees: dict[str, list[tuple[float, ...]]] = {}
    for row in rows:
        case = tuple(float(row[key]) for key in STUDY_COLUMNS)
        trees.setdefault(_tree_of(row), []).append(case)
    figure = new_figure(10.0, 4.6)
    for k, axes in enumerate(figure.subplots(1, 2), 1):
        for name, cases in trees.items():
            columns = np.array(sorted(cases)).T
            axes.plot(columns[0], columns[k], '.-', label=name)
        axes.set(xlabel=STUDY_COLUMNS[0], ylabel=STUDY_COLUMNS[k], ylim=(0.0, None))
    return labelled(figure)


def _tree_of(row: Mapping[str, str]) -> str:
    """Name the tree of a case, such as ``species oak, height 4.0 m, seed 0``."""
    parts = []
    for key, value in row.items():
        if key.startswith('tree_') and value:
            name, _, unit = key.removeprefix('tree_').partition(' ')
            parts.append(f'{name} {value} {unit.strip("[]-")}'.strip())
    return ', '.join(parts)


def labelled(figure: Figure, title: str = '') -> Figure:
    """Give a figure a grid, a legend and a title, and return it."""
    for axes in figure.axes:
        axes.grid(alpha=0.25)
        axes.legend(frameon=False, fontsize='small')
    figure.suptitle(title)
    figure.set_layout_engine('constrained')
    return figure
