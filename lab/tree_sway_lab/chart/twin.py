# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The same seconds of four trees: the true one, and models that know its mast's wind alone or more.

The true tree is made up, as in ``tree-sway lab twin``: each of its segments stands in gusts of its
own, the mast is 12 m away, and wood, branches, damping and drag are drawn. The model gets the
mast's wind, and beside it the signal of a motion sensor on the stem, or a film of the tree.
"""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from tree_sway.commands import bar
from tree_sway.core.arrays import Floats
from tree_sway.core.run import SwaySimulator
from tree_sway.core.scene import make_simulator
from tree_sway.core.species import Species
from tree_sway.core.tree import Tree
from tree_sway.extras import refuse_missing
from tree_sway.pictures import draw_trees, limits_around, new_figure, write_pictures
from tree_sway.twin import ObservedTree, place_on
from tree_sway.twin.camera import FilmedTree
from tree_sway_lab.twin.film_command import followed
from tree_sway_lab.twin.film_truth import camera_before, FilmedTruth, FRAMES, set_up
from tree_sway_lab.twin.gusty_truth import mast_of, Outside, swayed_outside
from tree_sway_lab.twin.simulated_sensor import SimulatedSensor
from tree_sway_lab.twin.true_tree import DT, pose_at, sensor_places, tree_called

TREE = 'birch 11'
OUTSIDE = Outside(speed=9.0, seconds=80.0, seed=1207)
SHOWN = 480
"""Steps that are shown, the last ones."""
EVERY = 6
"""Steps from one picture to the next."""
TITLES = ('the true tree', "the mast's wind alone", 'with a sensor', 'with a camera')

_COLORS = ('#404040', '#c2571a', '#1f6fb4', '#2a8c4a')
_SIZE = (8.0, 4.9)
"""Size of the picture in [inch]."""
_DOTS_PER_INCH = 100.0


class Motions(NamedTuple):
    """What is shown of the trees, in the order of `TITLES`."""

    tree: Tree
    wind: Floats
    """Wind at the anemometer in [m/s], (n, 3)."""
    poses: tuple[Floats, ...]
    """Poses of all segments, (n, segments, 7)."""

    def tips(self) -> list[Floats]:
        """Displacement of the highest segment from rest, east, north, up in [m], (n, 3)."""
        top = int(np.argmax(self.tree.end[:, 2]))
        rest = self.tree.rest_poses[top, :3]
        return [poses[:, top, :3] - rest for poses in self.poses]

    def errors(self) -> list[float]:
        """Error of each model's tip over the motion of the true one, about their means [-]."""
        true, *models = (tip - tip.mean(axis=0) for tip in self.tips())
        return [float(np.linalg.norm(model - true) / np.linalg.norm(true)) for model in models]


def chart_twin(out_dir: str | Path) -> Path:
    """Draw ``twin.webp`` into a folder, which is made if it is not there."""
    folder = Path(out_dir)
    folder.mkdir(parents=True, exist_ok=True)
    return write_pictures(_pictures(four_motions()), folder / 'twin.webp', 1.0 / (EVERY * DT))


def four_motions() -> Motions:
    """
    Sway the four trees.

    The sensor is an accelerometer with a gyroscope at 0.6 of the stem, whose axes are not told.
    The camera is set up as in ``tree-sway lab film``.
    """
    refuse_missing(['cv2'], 'lab chart twin')
    cv2 = import_module('cv2')
    cv2.setNumThreads(1)
    tree, species = tree_called(TREE)
    outside = OUTSIDE.drawn(tree)
    rng = np.random.default_rng(OUTSIDE.seed)
    winds, poses, at_sensor = _true(tree, species, outside)
    distance, bearing = mast_of(outside)
    apart: dict[str, Any] = {
        'in_leaf': False,
        'anemometer_distance': distance,
        'anemometer_bearing': bearing,
    }
    alone = make_simulator(tree, species, gusts='expected', **apart)
    name = sensor_places(tree, 1)[0]
    twin = ObservedTree(tree, species, at={name: name}, **apart)
    motion = SimulatedSensor(mount=Rotation.random(rng=rng)).measured(at_sensor, DT, rng)
    twin.replay(name, motion.time, acceleration=motion.acceleration, rate=motion.rate)
    camera = camera_before(tree, rng)
    found = set_up(tree, camera, rng)
    every = round(1.0 / (FRAMES * DT))
    film = [tree.rest_poses.astype(np.float32), *poses[every - 1 :: every]]
    truth = FilmedTruth(winds, np.empty((0, 0, 3)), np.array(film))
    filmed = FilmedTree(tree, species, camera=found.camera, **apart)
    seen, _ = followed(tree, truth, camera, found, rng, only_points=False)
    for picture in seen:
        filmed.film(*picture)
    models = [_shown(each, winds) for each in (alone, twin, filmed)]
    return Motions(tree, winds[-SHOWN:], (poses[-SHOWN:], *models))


def _true(tree: Tree, species: Species, outside: Outside) -> tuple[Floats, Floats, Floats]:
    """Mast's wind (n, 3), poses (n, segments, 7) and those of the sensor (n, 7) of the truth."""
    place = place_on(tree, sensor_places(tree, 1)[0])
    steps = round(outside.seconds / DT)
    winds, at_sensor = np.empty((steps, 3)), np.empty((steps, 7))
    poses: Any = np.empty((steps, tree.n_segments, 7), dtype=np.float32)
    swayed = swayed_outside(tree, species, outside, in_leaf=False)
    for step in bar(range(steps), 'the true tree'):
        winds[step], poses[step] = next(swayed)
        at_sensor[step] = pose_at(tree, poses[step].astype(float), place)
    return winds, poses, at_sensor


def _shown(sim: SwaySimulator, winds: Floats) -> Floats:
    """Poses of the last steps."""
    poses = np.empty((SHOWN, sim.tree.n_segments, 7))
    for step, wind in enumerate(winds, SHOWN - len(winds)):
        sim.step(wind, DT)
        if step >= 0:
            sim.place(poses[step])
    return poses


def _pictures(motions: Motions) -> Iterator[Any]:
    """Draw the trees side by side, above the way of their tips along the wind so far."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from PIL import Image

    figure = new_figure(*_SIZE)
    figure.set_dpi(_DOTS_PER_INCH)
    canvas = FigureCanvasAgg(figure)
    crowns = figure.subplots(1, 4, gridspec_kw={'left': 0, 'right': 1, 'bottom': 0.3, 'top': 0.92})
    trace = figure.add_axes((0.09, 0.1, 0.88, 0.2))
    limits = limits_around(np.vstack([motions.tree.start, motions.tree.end]))
    time = DT * np.arange(SHOWN)
    ways = [tip[:, 0] for tip in motions.tips()]
    low, high = min(way.min() for way in ways), max(way.max() for way in ways)
    errors = ['', *(f'error {error:.2f}' for error in motions.errors())]
    for step in bar(range(0, SHOWN, EVERY), 'pictures'):
        for axes, poses, title, error in zip(crowns, motions.poses, TITLES, errors, strict=True):
            wind = motions.wind[step] if axes is crowns[0] else np.zeros(3)
            draw_trees(axes, [motions.tree], poses[step], limits, wind=wind)
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
