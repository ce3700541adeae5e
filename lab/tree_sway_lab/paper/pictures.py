# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Pictures like the paper's figures 1 to 4, drawn from the experiment."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.pictures import draw_trees, limits_around, new_figure, save_figure
from tree_sway_lab.paper.experiment import Experiment, RATE
from tree_sway_lab.paper.followers import followed

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_WIND, _BARK, _PALE, _PLANE = '#1f6fb4', '#5b4632', '#b9b2a8', '#dfe9f2'


def draw_method(path: str | Path) -> Path:
    """Draw figures 1 and 2: the rotation plane of a segment, and the four steps of a branch."""
    figure = new_figure(11.0, 4.0)
    _rotation_plane(figure.add_axes((0.01, 0.02, 0.3, 0.86)))
    titles = '1 wind load', '2 key segment solved', '3 followers placed', '4 joined from the root'
    for step, title in enumerate(titles):
        axes = figure.add_axes((0.33 + 0.165 * step, 0.02, 0.16, 0.86))
        _branch_step(axes, step)
        axes.set_title(title, fontsize=10)
    return save_figure(figure, path)


def draw_plants(experiments: list[Experiment], path: str | Path) -> Path:
    """Draw figure 3: the plants at rest."""
    figure = new_figure(4.0 * len(experiments), 5.0)
    for place, experiment in enumerate(experiments):
        tree = experiment.tree
        axes = figure.add_axes((place / len(experiments), 0.0, 1.0 / len(experiments), 0.92))
        limits = limits_around(np.vstack([tree.start, tree.end]))
        draw_trees(axes, [tree], tree.rest_poses, limits)
        axes.set_title(f'{tree.name}: {tree.n_branches} branches, {tree.n_segments} segments')
    return save_figure(figure, path)


def draw_sway(experiment: Experiment, path: str | Path, frames: int = 6) -> Path:
    """Draw figure 4: a plant in the wind from the right, at even times, over its shape at rest."""
    tree, angle = experiment.tree, experiment.solutions['reduced'].angle
    chosen = np.linspace(0, len(angle) - 1, frames).astype(int)
    placed = [followed(tree, experiment.keys, angle[k]) for k in chosen]
    points = np.vstack([tree.start, tree.end, *(node for pair in placed for node in pair)])
    limits = limits_around(points)
    columns = (frames + 1) // 2
    figure = new_figure(3.2 * columns, 7.2)
    for place, (k, (start, end)) in enumerate(zip(chosen, placed, strict=True)):
        row, column = divmod(place, columns)
        axes = figure.add_axes((column / columns, 0.5 * (1 - row), 1.0 / columns, 0.46))
        poses = replace(tree, start=start, end=end).rest_poses
        wind = (-experiment.speed[k], 0.0, 0.0)
        draw_trees(axes, [tree], poses, limits, wind=wind, has_ghost=True)
        axes.set_title(f'{k / RATE:.1f} s', fontsize=10)
    return save_figure(figure, path)


def draw_tips(experiment: Experiment, path: str | Path) -> Path:
    """Draw the highest tip over time: the paper's model in three forms, and this package."""
    figure = new_figure(9.0, 5.0)
    wind, tip = figure.subplots(2, 1, sharex=True, height_ratios=(1, 2))
    seconds = np.arange(len(experiment.speed)) / RATE
    wind.plot(seconds, experiment.speed, color=_WIND)
    wind.set_ylabel('wind [m/s]')
    styles = {
        'multipliers': ('#888888', 3.0),
        'reduced': ('#c0392b', 1.4),
        'propagator': ('k', 0.7),
    }
    for name, (color, width) in styles.items():
        path_of_tip = tip_path(experiment, experiment.solutions[name].angle)
        tip.plot(seconds, -path_of_tip[:, 0], color=color, lw=width, label=f'paper, {name}')
    tip.plot(seconds, -experiment.ours[:, 0], color='#27803f', label='this package')
    tip.set(xlabel='time [s]', ylabel='highest tip, downwind [m]')
    tip.legend(loc='upper left', fontsize=8)
    figure.suptitle(f'{experiment.tree.name} in a wind from the right')
    return save_figure(figure, path)


def tip_path(experiment: Experiment, angle: Floats, every: int = 1) -> Floats:
    """Displacement of the highest tip in [m] under the key angles (frames, b), (frames, 3)."""
    tree = experiment.tree
    highest = int(np.argmax(tree.end[:, 2]))
    branch = int(tree.branch_of_segment[highest])
    carrying = [branch]
    while (branch := int(tree.branch_parent[branch])) >= 0:
        carrying.insert(0, branch)
    keys = experiment.keys
    ends = [followed(tree, keys, row, carrying)[1][highest] for row in angle[::every]]
    return np.asarray(ends) - tree.end[highest]


def _rotation_plane(axes: Axes) -> None:
    """Figure 1: a segment, its root-side node, and the plane in which it turns."""
    from matplotlib.patches import Polygon

    axes.set(xlim=(-1.2, 1.5), ylim=(-0.4, 1.9), aspect='equal', title='rotation plane')
    axes.axis('off')
    axes.add_patch(Polygon([(-1.0, -0.2), (1.2, 0.1), (1.2, 1.8), (-1.0, 1.5)], color=_PLANE))
    axes.plot([0.0, 0.0], [0.0, 1.3], color=_PALE, lw=7, solid_capstyle='round')
    axes.plot([0.0, -0.55], [0.0, 1.12], color=_BARK, lw=7, solid_capstyle='round')
    axes.plot([0.0], [0.0], 'o', color='black', ms=7)
    axes.annotate('', (-0.1, 0.75), (1.2, 0.93), arrowprops={'arrowstyle': '-|>', 'color': _WIND})
    axes.text(0.65, 0.97, 'P', color=_WIND)
    axes.text(0.07, 1.25, 'X')
    axes.text(-0.95, 0.0, 'Y')
    axes.text(-0.32, 1.25, r'$\theta$')
    axes.text(0.08, -0.12, 'root-side node', fontsize=8)


def _branch_step(axes: Axes, step: int) -> None:
    """One of the four pictures of figure 2."""
    axes.set(xlim=(-1.6, 0.9), ylim=(-0.1, 2.2), aspect='equal')
    axes.axis('off')
    upright = np.stack([np.zeros(7), np.linspace(0.0, 2.0, 7)], axis=1)
    turn = 0.9 * (np.arange(6) + 0.5) / 6.0
    rows = np.stack([-np.sin(turn), np.cos(turn)], axis=1) / 3.0
    bent = np.vstack([[0.0, 0.0], np.cumsum(rows, axis=0)])
    axes.plot(*upright.T, color=_PALE if step else _BARK, lw=5, solid_capstyle='round')
    if step == 0:
        for height in np.linspace(0.2, 1.9, 7):
            axes.annotate(
                '', (0.1, height), (0.8, height), arrowprops={'arrowstyle': '-|>', 'color': _WIND}
            )
    elif step == 1:
        axes.plot(*bent[5:].T, color='#c0392b', lw=6, solid_capstyle='round')
    elif step == 2:
        for row, colour in zip(range(6), [_BARK] * 5 + ['#c0392b'], strict=True):
            axes.plot(
                bent[row : row + 2, 0], bent[row : row + 2, 1] + 0.02 * row, color=colour, lw=4
            )
    else:
        axes.plot(*bent.T, color=_BARK, lw=5, solid_capstyle='round')
        axes.plot([0.0], [0.0], 'o', color='black', ms=7)
