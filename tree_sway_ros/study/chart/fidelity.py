# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The ladder of models against the truth: error of each model, and what it costs a frame.

The truth solves every segment, each in two pieces, at four times the frame rate; trees are the
three of 40 branches in `example_trees`, in turbulent wind of the spectrum that engineers use, or
in a record.

"""

from __future__ import annotations

from collections.abc import Iterable
import csv
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.reference.articulated import ArticulatedTree
from tree_sway_ros.core.reference.measure import frame_means
from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.core.tree.species import Species
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.core.wind.simulated.turbulence import simulate_turbulence
from tree_sway_ros.files.whole_file import whole_file
from tree_sway_ros.study.bench.frame_time import frame_times
from tree_sway_ros.study.example_trees import EXAMPLE_DENSITY, EXAMPLE_MODULUS, forked_tree, RATIOS
from tree_sway_ros.study.tip_error import record_tips, Swaying, tip_error
from tree_sway_ros.tools.progress import bar
from tree_sway_ros.view.plotting import new_figure, save_figure

FRAME = 1.0 / 60.0
DAMPING_RATIO = 0.05
SIMULATED_WIND = "simulated wind of 7 m/s (Kaimal's spectrum)"
EXAMPLE_WOOD = Species('example', 'example', EXAMPLE_MODULUS, EXAMPLE_DENSITY)

LADDER: dict[str, dict[str, Any]] = {
    'branch': {'model': 'branch'},
    'subtree': {'model': 'subtree'},
    'modes 3': {'model': 'modes', 'n_modes': 3},
    'modes 6': {'model': 'modes', 'n_modes': 6},
    'modes 12': {'model': 'modes', 'n_modes': 12},
    'coupled': {'model': 'coupled'},
}
"""Models of the chart, and how a simulator is told."""

_COLOURS = ('#1f6fb4', '#c0682b', '#2f6b2f')
_MARKERS = ('o', 's', '^')
_LABELS = {
    **dict.fromkeys(('branch', 'subtree'), (-1, (10, -3), 'left')),
    'coupled': (-1, (0, 9), 'center'),
    'segments': (0, (0, -16), 'center'),
}
"""Which point a name stands at, from the least error, and where; to the left of the least else."""


@dataclass(frozen=True)
class Model:
    """One point: tree, model, tip error over tip motion in [-], time per frame in [ns], wind."""

    tree: str
    model: str
    error: float
    nanoseconds: float
    wind: str = ''


def chart_fidelity(
    out_dir: str | Path,
    *,
    wind: tuple[Floats, Floats] | None = None,
    source: str = 'a record',
    duration: float = 20.0,
    trees: Iterable[Tree] | None = None,
    gravity: float = 9.81,
    seed: int = 1,
) -> list[Model]:
    """
    Measure and draw ``fidelity.csv`` and ``fidelity.png``.

    Parameters
    ----------
    out_dir
        Folder to write into; made if it is not there.
    wind
        Times in [s], (m,), and velocities in [m/s], (m, 3), of a record; simulated at 20 Hz and 7
        m/s if None.
    source
        What the record is, for the caption.
    duration
        How much of it, in [s].
    trees
        The three of 40 branches if None.
    gravity
        In [m/s^2].
    seed
        Of the simulated wind.

    """
    times, velocity = wind if wind is not None else simulated_wind(duration, seed)
    part = times <= times[0] + duration
    means = frame_means(times[part], velocity[part], FRAME)
    forest = list(trees) if trees is not None else [forked_tree(*ratio) for ratio in RATIOS]
    name = f'{duration:g} s of {source if wind is not None else SIMULATED_WIND}'
    points = [
        replace(point, wind=name)
        for tree in bar(forest, 'trees')
        for point in climb(tree, means, gravity)
    ]
    folder = Path(out_dir)
    folder.mkdir(parents=True, exist_ok=True)
    with whole_file(folder / 'fidelity.csv') as partial, partial.open('w', newline='') as file:
        writer = csv.DictWriter(file, list(asdict(points[0])))
        writer.writeheader()
        writer.writerows(asdict(point) for point in points)
    _draw(points, folder / 'fidelity.csv')
    return points


def simulated_wind(duration: float, seed: int) -> tuple[Floats, Floats]:
    """Kaimal turbulence about 7 m/s at 20 Hz: times in [s] and velocities in [m/s]."""
    rate = 20.0
    velocity = simulate_turbulence(
        7.0, rate=rate, duration=duration + 1.0, rng=np.random.default_rng(seed)
    )
    return np.arange(len(velocity)) / rate, velocity


def climb(tree: Tree, wind: Floats, gravity: float) -> list[Model]:
    """Every model of the ladder on one tree in one wind, mean of each frame in [m/s], (t, 3)."""
    truth = record_tips(articulated(tree, gravity, pieces=2), tree, wind, FRAME, substeps=4)
    models: dict[str, Swaying] = {
        name: SwaySimulator(
            tree,
            EXAMPLE_WOOD,
            damping_ratio=DAMPING_RATIO,
            gravity=gravity,
            twig_tolerance=-1.0,
            **how,
        )
        for name, how in LADDER.items()
    }
    models['segments'] = articulated(tree, gravity, pieces=1)
    tips = {name: record_tips(model, tree, wind, FRAME) for name, model in models.items()}
    cost = frame_times(models, tree, wind, FRAME)
    return [
        Model(
            tree.name, name, tip_error(tree, tips[name], truth), cost[name].step + cost[name].place
        )
        for name in models
    ]


def articulated(tree: Tree, gravity: float, *, pieces: int) -> ArticulatedTree:
    """Make the truth's model of a tree of example wood."""
    wood = EXAMPLE_WOOD
    return ArticulatedTree(
        tree,
        wood.modulus,
        wood.density,
        DAMPING_RATIO,
        wood.bare_drag_coefficient,
        gravity=gravity,
        subdivisions=pieces,
        twist_ratio=2.0 * wood.shear_ratio,
    )


def _draw(points: list[Model], path: Path) -> None:
    figure = new_figure(8.4, 5.2)
    axes = figure.add_axes((0.09, 0.11, 0.88, 0.77))
    names = list(dict.fromkeys(point.tree for point in points))
    for number, name in enumerate(names):
        here = [point for point in points if point.tree == name]
        x, y = [p.nanoseconds / 1e3 for p in here], [p.error for p in here]
        colour, marker = _COLOURS[number % 3], _MARKERS[number % 3]
        axes.plot(x, y, marker=marker, color=colour, ms=7, lw=0.6, alpha=0.9, label=_told(name))
    for model in dict.fromkeys(point.model for point in points):
        here = sorted((p for p in points if p.model == model), key=lambda p: p.error)
        which, way, side = _LABELS.get(model, (0, (-9, -4), 'right'))
        place = here[which].nanoseconds / 1e3, here[which].error
        text = axes.annotate(
            model, place, xytext=way, textcoords='offset points', ha=side, fontsize=10, zorder=5
        )
        text.set_bbox({'facecolor': 'white', 'edgecolor': 'none', 'pad': 0.5, 'alpha': 0.8})
    errors, costs = [p.error for p in points], [p.nanoseconds / 1e3 for p in points]
    axes.set(xscale='log', yscale='log')
    axes.set(xlim=(min(costs) / 1.5, 1.6 * max(costs)), ylim=(min(errors) / 2, 1.5))
    axes.set_xlabel('CPU time per frame, solving and placing [us]', fontsize=11)
    axes.set_ylabel('tip error over tip motion [-]', fontsize=11)
    ticks = [m * 10**e for e in range(5) for m in (1, 2, 5)]
    low, high = axes.get_xlim()
    axes.set_xticks([t for t in ticks if low <= t <= high])
    axes.minorticks_off()
    axes.xaxis.set_major_formatter('{x:g}')
    axes.yaxis.set_major_formatter('{x:g}')
    axes.grid(alpha=0.25)
    axes.spines[['top', 'right']].set_visible(False)
    legend = axes.legend(title='trees of 40 branches; children have', frameon=False)
    legend.set_loc('upper right')
    figure.suptitle(
        f'Error of each model against its cost, in {points[0].wind}\n'
        'the truth: every segment solved in two pieces, four substeps per frame',
        fontsize=11,
    )
    save_figure(figure, path.with_suffix('.png'), figures=path)


def _told(tree: str) -> str:
    """Return what the name of a forked tree says."""
    kind, *ratios = tree.split()
    if kind != 'forked' or len(ratios) != 2:
        return tree
    return f'{ratios[0]} of the length, {ratios[1]} of the diameter'
