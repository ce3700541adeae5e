# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
``tree-sway lab film``: how far a camera brings the model to the tree that it films.

The true tree is that of `gusty_truth`, drawn by the seed, in a field of gusts; its film has
clouds, a shadow, fluttering leaves, a bird, noise and a fifth of the points lost for seconds at a
time. The camera is set up by five clicks on the stem and four on limbs, each off by some pixels, a
bearing off by some degrees and a distance off by some percent. Of each tree there is a row for

- ``still``: the tree at rest,
- ``model`` and ``expected``: the model in the mast's wind, and in the wind expected at the crown,
- ``camera``: the camera alone,
- ``with wind``: with the mast's wind too, whose distance and bearing are told,
- ``IMU``: one motion sensor on the stem, at 0.6 of its length, with that wind,
- ``with IMU``: that sensor, the camera and that wind.

Of each are told the error of all tips in space about their means over their motion, that of the
means over the lean, that of the tip of the stem, the roughness, the time of a picture's step
without and that of following its points, in milliseconds, and how far the tree moves in the
picture, root mean square in pixels. They are scored from ``--settled`` on; a motion sensor takes
half a minute and more to be found.

``--points`` draws no pictures: points are projected, and disturbed as a tracker's would be.
``-o`` writes the film, the wind of the mast and the clicks as files, for ``tree-sway simulate``.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterable
from importlib import import_module
from pathlib import Path
import sys
import time
from typing import Any, NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from tree_sway.commands import Ending
from tree_sway.core.arrays import Floats
from tree_sway.core.run import SwaySimulator
from tree_sway.core.scene import make_simulator
from tree_sway.core.species import Species
from tree_sway.core.tree import tips_of_poses, Tree
from tree_sway.extras import refuse_missing
from tree_sway.files.export import write_tree
from tree_sway.live import CameraView
from tree_sway.twin.camera import Camera, FilmedTree
from tree_sway_lab.twin.film_pictures import pictures, write_film
from tree_sway_lab.twin.film_points import followed_points
from tree_sway_lab.twin.film_truth import (
    camera_before,
    filmed_truth,
    FilmedTruth,
    FRAMES,
    set_up,
    SetUp,
)
from tree_sway_lab.twin.gusty_truth import kinds_of, mast_of, Outside
from tree_sway_lab.twin.simulated_sensor import SimulatedSensor
from tree_sway_lab.twin.true_tree import DT, sensor_places, tree_called

_HEAD = 'tree', 'motion', 'error', 'lean', 'stem', 'rough', 'ms', 'ms to follow', 'px'
_LOST = 0.2


class _Score(NamedTuple):
    error: float
    lean: float
    stem: float
    rough: float
    cost: float


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add, default = parser.add_argument, Outside()
    what = 'kind, or species, height and seed, as "oak 9 4"; six kinds of --seed without one'
    add('tree', nargs='*', help=what)
    add('--points', action='store_true', help='projected points in place of pictures')
    add('--seconds', type=float, default=40.0, help='length of the film [s] (%(default)s)')
    add('--speed', type=float, default=default.speed, help='mean wind [m/s] (%(default)s)')
    add('--seed', type=int, default=default.seed, help='of tree, gusts and camera (%(default)s)')
    add('--settled', type=float, help='time [s] from which it is scored (a quarter of the film)')
    add('-o', '--output', type=Path, help='folder for the film, its wind and its clicks')


def run(arguments: argparse.Namespace) -> int:
    """Score the camera on every tree."""
    with Ending():
        print(','.join(_HEAD))
        for name in arguments.tree or kinds_of(arguments.seed):
            _try(name, arguments)
    return 0


def _try(name: str, arguments: argparse.Namespace) -> None:
    tree, species = tree_called(name)
    seed = arguments.seed
    outside = Outside(seconds=arguments.seconds, speed=arguments.speed, seed=seed).drawn(tree)
    place = sensor_places(tree, 1)[0]
    true = filmed_truth(tree, species, outside, [place])
    rng = np.random.default_rng(seed + 2)
    camera = camera_before(tree, rng)
    found = set_up(tree, camera, rng)
    if arguments.output is not None:
        _write(arguments.output, tree, species, true, camera, found.clicks)
    seen, cost = followed(tree, true, camera, found, rng, arguments.points)
    rest = tips_of_poses(tree, make_simulator(tree, species).place())
    nodes = np.array([camera.project(each[:, :3].astype(float)) for each in true.poses[::3]])
    pixels = float(np.sqrt(np.square(nodes.std(axis=0)).sum(axis=1).mean()))
    settled = arguments.settled if arguments.settled is not None else 0.25 * arguments.seconds
    distance, bearing = mast_of(outside)
    far: dict[str, Any] = {'anemometer_distance': distance, 'anemometer_bearing': bearing}
    measured = SimulatedSensor(mount=Rotation.random(rng=rng)).measured(true.at[place], DT, rng)

    def show(motion: str, tips: Floats, spent: float = 0.0, following: float = 0.0) -> None:
        score = _scored(tips, true.tips, rest, round(settled / DT), spent)
        _print(name, motion, score, following, pixels)

    show('still', np.broadcast_to(rest, true.tips.shape))
    show('model', *_swayed(make_simulator(tree, species), true.wind, []))
    expected = make_simulator(tree, species, gusts='expected', **far)
    show('expected', *_swayed(expected, true.wind, []))
    for motion, has_wind, has_sensor, film in (
        ('camera', False, False, seen),
        ('with wind', True, False, seen),
        ('IMU', True, True, []),
        ('with IMU', True, True, seen),
    ):
        at = {place: place} if has_sensor else {}
        filmed = FilmedTree(tree, species, camera=found.camera, at=at, **(far if has_wind else {}))
        if has_sensor:
            rows = {'acceleration': measured.acceleration, 'rate': measured.rate}
            filmed.replay(place, measured.time, **rows)
        wind = true.wind if has_wind else np.zeros_like(true.wind)
        show(motion, *_swayed(filmed, wind, film), cost if film else 0.0)
        for each in filmed.problems:
            print(f'{name}: {each}', file=sys.stderr)


def followed(
    tree: Tree,
    true: FilmedTruth,
    camera: Camera,
    found: SetUp,
    rng: np.random.Generator,
    only_points: bool,
) -> tuple[list[tuple[float, int, Floats]], float]:
    """Follow points of a film: what `FilmedTree.film` takes, and the time of a picture in [ms]."""
    if only_points:
        points = followed_points(tree, true.poses, camera, rng)
        return [(k / FRAMES, 0, each) for k, each in enumerate(points)], 0.0
    refuse_missing(['cv2'], 'lab film')
    cv2 = import_module('cv2')
    cv2.setNumThreads(1)
    film: Iterable[Any] = pictures(cv2, tree, true.poses, camera, rng)
    view = CameraView(tree, found.clicks, lambda text: None)
    spent, seen = list[float](), list[tuple[float, int, Floats]]()
    lost = np.zeros(0, dtype=bool)
    for k, picture in enumerate(film):
        begun = time.thread_time()
        sighting = view.follow(k / FRAMES, picture)
        spent.append(time.thread_time() - begun)
        points = sighting.points.copy()
        if k % (3 * FRAMES) == 0:
            lost = rng.random(len(points)) < _LOST
        if k and len(lost) == len(points):
            points[lost] = np.nan
        seen.append((sighting.time, sighting.reference, points))
    return seen, 1e3 * float(np.median(spent))


def _swayed(
    sim: SwaySimulator,
    winds: Floats,
    seen: list[tuple[float, int, Floats]],
) -> tuple[Floats, float]:
    """Step a tree in winds, with its pictures: tips (n, b, 3), and time of a step in [ms]."""
    tips = np.empty((len(winds), sim.tree.n_branches, 3))
    block = np.empty((sim.tree.n_segments, 7))
    waiting, spent = iter(seen), list[float]()
    picture = next(waiting, None)
    for k, wind in enumerate(winds):
        is_new = False
        while picture is not None and picture[0] <= (k + 1) * DT + 1e-9:
            assert isinstance(sim, FilmedTree)
            sim.film(*picture)
            picture, is_new = next(waiting, None), True
        begun = time.thread_time()
        sim.step(wind, DT)
        if is_new or not seen:
            spent.append(time.thread_time() - begun)
        tips[k] = tips_of_poses(sim.tree, sim.place(block))
    return tips, 1e3 * float(np.median(spent))


def _scored(tips: Floats, true: Floats, rest: Floats, first: int, cost: float) -> _Score:
    found, wanted = tips[first:] - rest, true[first:] - rest
    wrong = found - wanted
    moved, motion = wrong - wrong.mean(axis=0), wanted - wanted.mean(axis=0)
    second = [np.diff(each, 2, axis=0) for each in (found, wanted)]
    return _Score(
        _over(moved, motion),
        _over(wrong.mean(axis=0), wanted.mean(axis=0)),
        _over(moved[:, 0], motion[:, 0]),
        _over(*second),
        cost,
    )


def _over(one: Floats, other: Floats) -> float:
    return float(np.sqrt(np.square(one).sum() / np.square(other).sum()))


def _print(name: str, motion: str, score: _Score, following: float, pixels: float) -> None:
    figures = [f'{each:.3f}' for each in score[:4]]
    times = [f'{score.cost:.2f}', f'{following:.2f}', f'{pixels:.1f}']
    print(','.join([name, motion, *figures, *times]), flush=True)


def _write(
    folder: Path, tree: Tree, species: Species, true: FilmedTruth, camera: Camera, clicks: str
) -> None:
    """Write a tree, its film, the wind, the clicks and the true motion of the stem's tip."""
    refuse_missing(['cv2'], 'lab film -o')
    cv2 = import_module('cv2')
    folder.mkdir(parents=True, exist_ok=True)
    rng = np.random.default_rng(0)
    write_film(cv2, str(folder / 'film.mp4'), tree, true.poses, camera, rng)
    rows = [f'{DT * k:.6f},{u:.4f},{v:.4f},{w:.4f}' for k, (u, v, w) in enumerate(true.wind)]
    (folder / 'wind.csv').write_text('\n'.join(['time,u,v,w', *rows, '']), encoding='utf-8')
    moved = true.tips[:, 0] - tree.end[tree.branch_first[1] - 1]
    rows = [f'{DT * (k + 1):.6f},{x:.5f},{y:.5f},{z:.5f}' for k, (x, y, z) in enumerate(moved)]
    (folder / 'true.csv').write_text('\n'.join(['time,x,y,z', *rows, '']), encoding='utf-8')
    write_tree(folder / 'tree.yaml', tree, species)
    (folder / 'clicks.txt').write_text(clicks, encoding='utf-8')
