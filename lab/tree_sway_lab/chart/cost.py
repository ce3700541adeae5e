# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What a frame costs, by how finely branches are cut and by how many there are.

Solving should not care about segments (that is the point of key segments), placing them must; both
should grow with the number of branches and no faster.

"""

from __future__ import annotations

from collections.abc import Sequence
import csv
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tree_sway.commands import bar
from tree_sway.core.tree import Tree
from tree_sway.files import whole_file
from tree_sway.pictures import new_figure, save_figure
from tree_sway_lab.bench.frame_time import frame_times
from tree_sway_lab.example_trees import forked_tree, RATIOS
from tree_sway_lab.tip_error import Swaying
from tree_sway_lab.validation.trial import judged_simulator
from tree_sway_lab.validation.truth import Fineness, true_model
from tree_sway_lab.validation.winds import FRAME

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MODELS = ('branch', '20', '60', 'full')
EVERY_SEGMENT = 'every segment'

_STYLE = {
    'branch': ('#1f6fb4', 'o'),
    '20': ('#7f7f7f', 'v'),
    '60': ('#2f6b2f', 's'),
    'full': ('#7a4fa3', 'D'),
    EVERY_SEGMENT: ('#c0682b', '^'),
}


@dataclass(frozen=True)
class Cost:
    """One point: model, size of the tree, CPU time of a step and of placing in [ns]."""

    model: str
    n_branches: int
    segments_a_branch: int
    step: float
    place: float


def chart_cost(
    out_dir: str | Path,
    *,
    cuts: Sequence[int] = (6, 12, 24, 48),
    generations: Sequence[int] = (2, 3, 4, 5, 6),
    frames: int = 300,
    models: Sequence[str] = MODELS,
) -> list[Cost]:
    """
    Measure and draw ``cost.csv`` and ``cost.png``.

    Parameters
    ----------
    out_dir
        Folder to write into; made if it is not there.
    cuts
        Segments per branch, of a tree of 40 branches.
    generations
        Generations of branches, each three times as many as before, six segments per branch.
    frames
        How many are timed.
    models
        Models of ours, as of `simulator_called`.

    """
    points = [
        point
        for cut in bar(cuts, 'segments per branch')
        for point in _costs(forked_tree(*RATIOS[1], segments=cut), cut, frames, models)
    ]
    for generation in bar(generations, 'generations of branches'):
        # The fourth generation's tree with six segments per branch has been measured above.
        if not (generation == 4 and 6 in cuts):
            points += _costs(forked_tree(*RATIOS[1], generations=generation), 6, frames, models)
    folder = Path(out_dir)
    folder.mkdir(parents=True, exist_ok=True)
    with whole_file(folder / 'cost.csv') as partial, partial.open('w', newline='') as file:
        writer = csv.DictWriter(file, list(Cost.__annotations__))
        writer.writeheader()
        writer.writerows(asdict(point) for point in points)
    _draw(points, folder / 'cost.csv')
    return points


def _costs(tree: Tree, cut: int, frames: int, models: Sequence[str]) -> list[Cost]:
    timed: dict[str, Swaying] = {name: judged_simulator(name, tree) for name in models}
    timed[EVERY_SEGMENT] = true_model(tree, Fineness(1, 1))
    times = frame_times(timed, tree, np.array([[5.0, 2.0, 0.0]]), FRAME, frames=frames)
    return [Cost(name, tree.n_branches, cut, *spent) for name, spent in times.items()]


def _draw(points: list[Cost], path: Path) -> None:
    figure = new_figure(10.0, 4.4)
    by_cut, by_branches = figure.subplots(
        1,
        2,
        sharey=True,
        gridspec_kw={'left': 0.07, 'right': 0.98, 'bottom': 0.13, 'top': 0.89, 'wspace': 0.08},
    )
    forty = [p for p in points if p.n_branches == 40]
    six = sorted((p for p in points if p.segments_a_branch == 6), key=lambda p: p.n_branches)
    _panel(by_cut, forty, 'segments_a_branch', 'segments per branch (40 branches)')
    _panel(by_branches, six, 'n_branches', 'branches (6 segments each)')
    by_cut.set_ylabel('CPU time per frame [us]')
    by_branches.legend(frameon=False, fontsize=8)
    by_cut.yaxis.set_major_formatter('{x:g}')
    figure.suptitle('What a frame costs: solving (full lines) and placing (dotted)')
    save_figure(figure, path.with_suffix('.png'), figures=path)


def _panel(axes: Axes, points: list[Cost], field: str, label: str) -> None:
    for model, (colour, marker) in _STYLE.items():
        here = [p for p in points if p.model == model]
        size = [getattr(p, field) for p in here]
        solve, place = [p.step / 1e3 for p in here], [p.place / 1e3 for p in here]
        axes.plot(size, solve, marker=marker, color=colour, lw=1.5, ms=5, label=model)
        axes.plot(size, place, ':', color=colour, lw=1.2)
    ticks = sorted({getattr(p, field) for p in points})
    axes.set(xscale='log', yscale='log', xlabel=label)
    axes.set_xticks(ticks, [str(t) for t in ticks])
    axes.minorticks_off()
    axes.grid(alpha=0.25)
    axes.spines[['top', 'right']].set_visible(False)
