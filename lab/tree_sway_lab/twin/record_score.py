# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
``tree-sway lab twin RECORD``: how well a recorded tree's motion follows from wind and sensors.

Each sensor of the record is held out in turn, and what it measured is compared with what the model
has at its place: the angular rate, or the acceleration where there is none, east and north. Rows:
``U^2``, the square of the wind, low-passed at the first frequency, and its change, with the gains
that are best for this record; ``model``, the wind alone; ``live``, wind and all other sensors,
where there are any. Columns are those of ``lab score``, which scores the displacement of a tip if
there is one.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from tree_sway.core.arrays import Floats
from tree_sway.core.run import SwaySimulator
from tree_sway.core.scene import make_simulator
from tree_sway.core.setup import LEAVES
from tree_sway.core.tree import ends_of_poses
from tree_sway.errors import ParameterError
from tree_sway.files.motion import MotionRecord, read_motion, TreeRecord
from tree_sway.files.trees import open_tree
from tree_sway.files.wind import read_wind
from tree_sway.simulation import interpolated_means
from tree_sway.twin import align, Alignment, GRAVITY, ObservedTree, place_on, SensorPlace
from tree_sway_lab.twin.simulated_sensor import SimulatedSensor
from tree_sway_lab.twin.sway_comparison import compare_sway, low_passed, SwayComparison

RATE = 60.0
SKIPPED = 40.0
"""Time [s] at the start that is not scored: mountings are found in it."""
LEAST = 30.0
"""Least time [s] that is scored."""


class HeldOut(NamedTuple):
    """A sensor that was held out: its place, what was compared, and the score of each row."""

    at: str
    quantity: str
    rows: dict[str, SwayComparison]
    problem: str


class Measured(NamedTuple):
    """A sensor: its name, place, record, and its times after the start of the wind [s]."""

    name: str
    at: str
    record: MotionRecord
    time: Floats


def score_record(record: TreeRecord) -> Iterator[HeldOut]:
    """
    Score each sensor of a record, held out.

    Raises
    ------
    ParameterError
        A record without sensors, or one that is too short.
    TreeSwayError
        Errors of its files.

    """
    tree = open_tree(record.path(record.tree))
    in_leaf = LEAVES[record.leaves]
    wind = read_wind(record.path(record.wind))
    time, velocity = interpolated_means(wind.time, wind.velocity)
    grid = np.arange(1.0 / RATE, float(time[-1] - time[0]), 1.0 / RATE)
    blown = _at(grid, time - time[0], velocity)
    if not record.motion:
        cure = 'record with --motion, or score its sway by lab score'
        raise ParameterError('a record without motion sensors', where=record.path(''), cure=cure)
    if not len(grid) or grid[-1] < SKIPPED + LEAST:
        what = f'a wind of {grid[-1] if len(grid) else 0.0:.0f} s'
        cure = f'record {SKIPPED + LEAST:.0f} s and more'
        raise ParameterError(what, where=record.path(record.wind), cure=cure)
    sensors = []
    for number, sensor in enumerate(record.motion):
        motion = read_motion(record.path(sensor.file))
        after = motion.times_after(wind.epoch)
        sensors.append(Measured(f'{number}', sensor.at, motion, after))
    frequency = float(make_simulator(tree, model=0, in_leaf=in_leaf).frequencies(1)[0])
    alone = _motions(make_simulator(tree, in_leaf=in_leaf), blown, sensors)
    squared = low_passed(blown, frequency, RATE)
    for held in sensors:
        others = [each for each in sensors if each.name != held.name]
        rows = {'model': alone[held.name]}
        if others:
            twin = ObservedTree(
                tree, in_leaf=in_leaf, rate=RATE, at={each.name: each.at for each in others}
            )
            for each in others:
                twin.replay(
                    each.name, each.time, acceleration=each.record.acceleration,
                    rate=each.record.rate, orientation=each.record.orientation,
                )  # fmt: skip
            rows['sensors'] = _motions(twin, blown, [held])[held.name]
        yield _score(held, grid, rows, squared, frequency)


def _motions(sim: SwaySimulator, blown: Floats, sensors: Sequence[Measured]) -> dict[str, Floats]:
    """
    Sway a tree; return what sensors that are not turned would measure, (n, 9) for each.

    Acceleration with gravity taken off as `as_felt`, acceleration of the place alone, and rate.
    """
    places = {each.name: place_on(sim.tree, each.at) for each in sensors}
    poses = {name: np.empty((len(blown), 7)) for name in places}
    block = np.empty((sim.tree.n_segments, 7))
    rest = {name: _pose(sim, sim.place(block).copy(), place) for name, place in places.items()}
    for k, each in enumerate(blown):
        sim.step(each, 1.0 / RATE)
        sim.place(block)
        for name, place in places.items():
            poses[name][k] = _pose(sim, block, place)
    found, rng = {}, np.random.default_rng(0)
    for name, path in poses.items():
        mount = Rotation.from_quat(rest[name][3:]).inv()
        still = SimulatedSensor(mount, rate=RATE, noise=0.0, rate_noise=0.0)
        felt = still.measured(path, 1.0 / RATE, rng)
        moved = np.zeros((len(path), 3))
        moved[1:-1] = np.diff(path[:, :3], 2, axis=0) * RATE**2
        force = felt.acceleration - np.array([0.0, 0.0, GRAVITY])
        found[name] = np.hstack([force, moved, felt.rate])
    return found


def _pose(sim: SwaySimulator, block: Floats, place: SensorPlace) -> Floats:
    """Pose of a place, (7,)."""
    pose = block[place.segment : place.segment + 1].copy()
    away = place.along * float(sim.tree.length[place.segment])
    pose[0, :3] = ends_of_poses(pose, [away])[1][0]
    return np.asarray(pose[0])


def _score(
    held: Measured, grid: Floats, rows: dict[str, Floats], squared: Floats, frequency: float
) -> HeldOut:
    """Compare the motion of a sensor with that of each row."""
    record = held.record
    sensed = np.full((len(grid), 9), np.nan)
    for first, values in ((0, record.acceleration), (3, record.rate)):
        if values is not None:
            known = np.isfinite(values).all(axis=1)
            sensed[:, first : first + 3] = _at(grid, held.time[known], values[known])
    if np.isnan(sensed[:, :6]).all():
        return HeldOut(held.at, 'orientation', {}, 'an orientation alone is not scored')
    inside = (grid >= max(float(held.time[0]), SKIPPED)) & (grid <= float(held.time[-1]))
    if inside.sum() < LEAST * RATE:
        return HeldOut(held.at, '', {}, f'less than {LEAST:.0f} s of motion in the wind')
    found = _mounting(sensed[inside], rows['model'][inside])
    quantity, columns = ('rate', slice(3, 5)) if record.rate is not None else (
        'acceleration', slice(0, 2)
    )  # fmt: skip
    if found.problem:
        return HeldOut(held.at, quantity, {}, found.problem)
    measured = found.motion(sensed[inside])[:, columns]
    if quantity == 'rate':
        of_model = slice(6, 8)
    else:
        of_model = slice(0, 2) if found.has_gravity else slice(3, 5)
    # A rate follows the change of the load, a tilt the load itself.
    changing = np.gradient(squared, axis=0)[inside]
    inputs = np.column_stack([np.ones(len(changing)), squared[inside], changing])
    fitted = inputs @ np.linalg.lstsq(inputs, measured, rcond=None)[0]
    scores = {'U^2': compare_sway(fitted, measured, RATE, frequency)}
    for name, motion in rows.items():
        computed = motion[inside][:, of_model]
        scores[name] = compare_sway(computed, measured, RATE, frequency)
    return HeldOut(held.at, quantity, scores, '')


def _mounting(sensed: Floats, model: Floats) -> Alignment:
    """Find the mounting of a sensor from the motion of the model in the wind alone."""
    unknown = np.zeros((len(model), 3))
    upright = np.hstack([model[:, :3], model[:, 6:], unknown])
    free = np.hstack([model[:, 3:6], model[:, 6:], unknown])
    return align(sensed, upright, free)


def _at(times: Floats, known: Floats, values: Floats) -> Floats:
    """Interpolate columns at times, (n, k)."""
    return np.stack([np.interp(times, known, column) for column in values.T], axis=1)
