# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The same seconds of three trees: the true one, the model in the wind alone, and with one sensor.

The true tree is made up, as in ``tree-sway lab twin``: its wood is softer by a fifth, its damping
higher by half, and gusts reach it limb by limb.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tree_sway.commands import bar
from tree_sway.core.arrays import Floats
from tree_sway.core.leaves import leaf_clusters
from tree_sway.core.scene import make_simulator
from tree_sway.core.tree import Tree
from tree_sway.pictures import draw_trees, limits_around, new_figure, write_pictures
from tree_sway.twin import LATE_STEPS, ObservedTree, place_on
from tree_sway_lab.twin.simulated_sensor import SimulatedSensor
from tree_sway_lab.twin.true_tree import (
    Circumstances,
    DT,
    pose_at,
    sensor_places,
    tree_called,
    true_simulator,
    winds,
)

TREE = 'spruce 12'
AROUND = Circumstances(speed=9.0, seconds=80.0, seed=31)
SHOWN = 480
"""Steps that are shown, the last ones."""
EVERY = 6
"""Steps from one picture to the next."""
TITLES = ('the true tree', 'model, wind alone', 'model, wind and one sensor')

_COLORS = ('#404040', '#c2571a', '#1f6fb4')
_SIZE = (7.0, 4.9)
"""Size of the picture in [inch]."""
_DOTS_PER_INCH = 100.0
_CLUSTERS = 2500
"""Sprays of needles that are drawn on a tree."""


class Motions(NamedTuple):
    """What is shown of the three trees, in the order of `TITLES`."""

    tree: Tree
    wind: Floats
    """Wind at the anemometer in [m/s], (n, 3)."""
    poses: tuple[Floats, Floats, Floats]
    """Poses of all segments, (n, segments, 7)."""

    def tips(self) -> list[Floats]:
        """Displacement of the highest segment from rest, east, north, up in [m], (n, 3)."""
        top = int(np.argmax(self.tree.end[:, 2]))
        rest = self.tree.rest_poses[top, :3]
        return [poses[:, top, :3] - rest for poses in self.poses]

    def errors(self) -> tuple[float, float]:
        """Error of the tip over the motion of the true one, both about their means [-]."""
        true, *models = (tip - tip.mean(axis=0) for tip in self.tips())
        alone, sensor = (
            float(np.linalg.norm(model - true) / np.linalg.norm(true)) for model in models
        )
        return alone, sensor


def chart_twin(out_dir: str | Path) -> Path:
    """Draw ``twin.webp`` into a folder, which is made if it is not there."""
    folder = Path(out_dir)
    folder.mkdir(parents=True, exist_ok=True)
    return write_pictures(_pictures(three_motions()), folder / 'twin.webp', 1.0 / (EVERY * DT))


def three_motions() -> Motions:
    """
    Sway the three trees.

    The sensor is an accelerometer with a gyroscope at 0.6 of the stem, whose axes are those of its
    segment; that is not told. The tree that follows it is shown as a page plays it out: smoothed,
    and moved back by as many steps as that state is late.
    """
    tree, species = tree_called(TREE)
    name = sensor_places(tree, 1)[0]
    felt, measured = winds(AROUND)
    first = len(felt) - SHOWN
    true = true_simulator(tree, species, AROUND, in_leaf=True)
    true_poses = np.empty((SHOWN, tree.n_segments, 7))
    at_sensor = np.empty((len(felt), 7))
    for step in bar(range(len(felt)), 'the true tree'):
        true.step(felt[step], DT)
        block = true.place()
        at_sensor[step] = pose_at(tree, block, place_on(tree, name))
        if step >= first:
            true_poses[step - first] = block

    alone = make_simulator(tree, species, in_leaf=True)
    twin = ObservedTree(tree, species, in_leaf=True, at={name: name}, is_smoothed=True)
    motion = SimulatedSensor().measured(at_sensor, DT, np.random.default_rng(AROUND.seed))
    twin.replay(name, motion.time, acceleration=motion.acceleration, rate=motion.rate)
    alone_poses = np.empty_like(true_poses)
    twin_poses = np.empty_like(true_poses)
    steps = [*measured, *np.tile(measured[-1], (LATE_STEPS + twin.observer.late, 1))]
    for step, wind in enumerate(bar(steps, 'the models')):
        alone.step(wind, DT)
        twin.step(wind, DT)
        shown = step - first
        if 0 <= shown < SHOWN:
            alone.place(alone_poses[shown])
        smoothed = shown - LATE_STEPS - twin.observer.late
        if 0 <= smoothed < SHOWN:
            twin.place_rotations(twin.smoothed, twin_poses[smoothed])
    return Motions(tree, measured[first:], (true_poses, alone_poses, twin_poses))


def _pictures(motions: Motions) -> Iterator[Any]:
    """Draw the trees side by side, above the way of their tips along the wind so far."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from PIL import Image

    figure = new_figure(*_SIZE)
    figure.set_dpi(_DOTS_PER_INCH)
    canvas = FigureCanvasAgg(figure)
    crowns = figure.subplots(1, 3, gridspec_kw={'left': 0, 'right': 1, 'bottom': 0.3, 'top': 0.92})
    trace = figure.add_axes((0.09, 0.1, 0.88, 0.2))
    limits = limits_around(np.vstack([motions.tree.start, motions.tree.end]))
    time = DT * np.arange(SHOWN)
    ways = [tip[:, 0] for tip in motions.tips()]
    low, high = min(way.min() for way in ways), max(way.max() for way in ways)
    errors = ['', *(f'error {error:.2f}' for error in motions.errors())]
    needles = leaf_clusters(motions.tree, np.random.default_rng(0), count=_CLUSTERS)
    for step in bar(range(0, SHOWN, EVERY), 'pictures'):
        for axes, poses, title, error in zip(crowns, motions.poses, TITLES, errors, strict=True):
            wind = motions.wind[step] if axes is crowns[0] else np.zeros(3)
            draw_trees(axes, [motions.tree], poses[step], limits, wind=wind, leaves=needles)
            axes.set_title(f'{title}\n{error}', fontsize=9)
        trace.clear()
        for way, color, title in zip(ways, _COLORS, TITLES, strict=True):
            trace.plot(time[: step + 1], way[: step + 1], color=color, lw=1.4, label=title)
        trace.set(
            xlim=(0.0, time[-1]),
            ylim=(low, high + 0.25 * (high - low)),
            xlabel='time [s]',
            ylabel='tip east [m]',
        )
        trace.legend(loc='upper right', fontsize=7, frameon=False, ncols=3)
        trace.grid(alpha=0.25)
        canvas.draw()
        yield Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3].copy())
