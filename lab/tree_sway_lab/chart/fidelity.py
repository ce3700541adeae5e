# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Speed against accuracy: the dial from 0 to ``full``, the paper's model, MuJoCo and Newton.

A straight tree, a crooked one and one of hanging twigs sway in turbulence of 9 m/s, with weight
and twist. The truth solves every segment (`true_tips`). One panel shows errors, the other
roughness: a model can be near the truth and shake.

"""

from __future__ import annotations

from collections.abc import Sequence
import csv
from dataclasses import asdict, dataclass
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from tree_sway.commands import bar
from tree_sway.core.arrays import Floats
from tree_sway.core.tree import Tree
from tree_sway.files import whole_file
from tree_sway.pictures import new_figure, save_figure
from tree_sway_lab import compare
from tree_sway_lab.bench.frame_time import frame_times
from tree_sway_lab.compare.engines import EngineRun, MODULES, run_engines
from tree_sway_lab.kinds.kinds import kind_called
from tree_sway_lab.tip_error import record_tips, roughness, tip_error
from tree_sway_lab.validation.trial import judged_simulator, SECONDS
from tree_sway_lab.validation.truth import (
    cache_folder,
    DAMPING_RATIO,
    digest_of_arrays,
    FINE,
    Fineness,
    GRAVITY,
    true_tips,
    WOOD,
)
from tree_sway_lab.validation.winds import FRAME, wind_called

KINDS = ('straight 1', 'crooked 8', 'willow')
DIAL = ('0', '3', '6', '12', '20', '40', '60', 'full')
MODELS = (*DIAL, 'branch')
ENGINES = ('MuJoCo', 'Newton')
WIND = '9'

_NAMES = {'straight 1': 'straight', 'crooked 8': 'crooked', 'willow': 'hanging twigs'}
_COLOURS = ('#1f6fb4', '#c0682b', '#2f6b2f')
_MARKERS = {'branch': 'D', 'MuJoCo': 's', 'Newton': '^'}


@dataclass(frozen=True)
class Model:
    """One point: tree, model, error and roughness in [-], time per frame in [ns], wind."""

    tree: str
    model: str
    error: float
    roughness: float
    nanoseconds: float
    wind: str = f'{SECONDS:g} s of turbulence of {WIND} m/s'


def chart_fidelity(
    out_dir: str | Path,
    *,
    kinds: Sequence[str] = KINDS,
    models: Sequence[str] = MODELS,
    engines: Sequence[str] = ENGINES,
    fineness: Fineness = FINE,
) -> list[Model]:
    """
    Measure and draw ``fidelity.csv`` and ``fidelity.png``.

    Parameters
    ----------
    out_dir
        Folder to write into; made if it is not there.
    kinds
        Trees, as of `kind_called`.
    models, engines
        Models of ours, and engines; those that are not installed are left out. Newton runs for
        the first two seconds.
    fineness
        Fineness of the truth.

    """
    points = [
        point
        for kind in bar(list(kinds), 'trees')
        for point in points_of(kind, models, engines, fineness)
    ]
    folder = Path(out_dir)
    folder.mkdir(parents=True, exist_ok=True)
    with whole_file(folder / 'fidelity.csv') as partial, partial.open('w', newline='') as file:
        writer = csv.DictWriter(file, list(asdict(points[0])))
        writer.writeheader()
        writer.writerows(asdict(point) for point in points)
    _draw(points, folder / 'fidelity.csv')
    return points


def points_of(
    kind: str, models: Sequence[str], engines: Sequence[str] = (), fineness: Fineness = FINE
) -> list[Model]:
    """Every model and engine on one tree."""
    tree, wind = kind_called(kind), wind_called(WIND, SECONDS)
    truth = true_tips(tree, wind, fineness)
    ours = {name: judged_simulator(name, tree) for name in models}
    runs = {name: record_tips(model, tree, wind, FRAME) for name, model in ours.items()}
    spent = {name: sum(each) for name, each in frame_times(ours, tree, wind, FRAME).items()}
    if engines:
        others = _engine_runs(kind, tree, wind, engines)
        runs |= {name: run.tips for name, run in others.items()}
        spent |= {name: 1e9 * run.cost for name, run in others.items()}
    return [
        Model(
            kind, name, tip_error(tree, tips, truth[: len(tips)]),
            roughness(tips, truth[: len(tips)]), spent[name],
        )
        for name, tips in runs.items()
    ]  # fmt: skip


def _engine_runs(
    kind: str, tree: Tree, wind: Floats, engines: Sequence[str]
) -> dict[str, EngineRun]:
    """Run engines, or read what they did before: it does not change with our models."""
    versions = ' '.join(f'{name} {version(MODULES[name])}' for name in engines if _is_here(name))
    code = ''.join(path.read_text() for path in sorted(Path(compare.__file__).parent.glob('*.py')))
    key = digest_of_arrays(f'{kind} {versions} {code}', tree.end, wind)
    path = cache_folder() / f'engines-{key}.npz'
    if path.is_file():
        with np.load(path) as runs:
            there = [name for name in engines if name in runs]
            return {name: EngineRun(runs[name], float(runs[f'{name} cost'])) for name in there}
    found = run_engines(
        tree, WOOD, DAMPING_RATIO, wind, gravity=GRAVITY, match_beam=False, names=engines
    )
    arrays: dict[str, Any] = {name: run.tips for name, run in found.items()}
    arrays |= {f'{name} cost': run.cost for name, run in found.items()}
    path.parent.mkdir(parents=True, exist_ok=True)
    with whole_file(path) as partial:
        np.savez(partial, **arrays)
    return found


def _is_here(engine: str) -> bool:
    return find_spec(MODULES[engine]) is not None


def _draw(points: Sequence[Model], path: Path) -> None:
    figure = new_figure(9.0, 7.2)
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
    for number, tree in enumerate(dict.fromkeys(point.tree for point in points)):
        here = {point.model: point for point in points if point.tree == tree}
        style = {'color': _COLOURS[number % 3], 'alpha': 0.9}
        dial = [here[name] for name in DIAL if name in here]
        for axes, what in ((above, 'error'), (below, 'roughness')):
            costs = [point.nanoseconds / 1e3 for point in dial]
            values = [getattr(point, what) for point in dial]
            axes.plot(costs, values, 'o-', ms=5, lw=1.0, label=_NAMES.get(tree, tree), **style)
            for name in _MARKERS.keys() & here.keys():
                x, y = here[name].nanoseconds / 1e3, getattr(here[name], what)
                axes.plot(x, y, _MARKERS[name], ms=8, **style)
    for axes in (above, below):
        axes.set_xscale('log')
        axes.grid(alpha=0.25)
        axes.spines[['top', 'right']].set_visible(False)
        _name_points(axes, points, 'error' if axes is above else 'roughness')
    above.set_yscale('log')
    above.yaxis.set_major_formatter('{x:g}')
    below.axhspan(0.8, 1.2, color='#2f6b2f', alpha=0.12, lw=0)
    below.set_ylim(0.0, 1.1 * max(point.roughness for point in points))
    below.set_xlabel('CPU time per frame [us]', fontsize=11)
    above.set_ylabel('tip error over tip motion [-]', fontsize=11)
    below.set_ylabel('roughness: acceleration\nof tips over the true [-]', fontsize=11)
    below.xaxis.set_major_formatter('{x:g}')
    above.legend(frameon=False, loc='center right')
    figure.suptitle(
        'One model with a dial from 0 to full, beside engines of rigid bodies\n'
        f'{points[0].wind}; truth: {FINE}',
        fontsize=11,
    )
    save_figure(figure, path.with_suffix('.png'), figures=path)


_NAMED = ('0', '3', '6', '20', 'full', 'branch', *ENGINES)


def _name_points(axes: Any, points: Sequence[Model], what: str) -> None:
    """Write the names of some models beside their point on the tree in the middle."""
    for name in _NAMED if what == 'error' else ('0', 'branch', *ENGINES):
        here = sorted((p for p in points if p.model == name), key=lambda p: getattr(p, what))
        if not here:
            continue
        point = here[len(here) // 2]
        left = name in ('3', '6', '20')
        axes.annotate(
            name, (point.nanoseconds / 1e3, getattr(point, what)),
            xytext=(-9, -4) if left else (9, -4), textcoords='offset points',
            ha='right' if left else 'left', fontsize=9, zorder=5,
        )  # fmt: skip
