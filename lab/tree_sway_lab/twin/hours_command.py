# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
``tree-sway lab hours``: whether a tree with one sensor drifts or says what is not so, in hours.

The true tree is that of ``lab twin``: rigid segments in a field of gusts beside a mast, its wood,
damping and drag drawn by the seed. It is in leaf. In the time of ``--hours`` the wind turns and
turns back, falls to a calm twice and rises again, rain makes the leaves heavier by ``--rain`` and
they dry, and the battery of the sensor fades twice: fewer samples, none, and all again
(`weather`).

Each row is a twelfth of the record, as it passes; nothing of it is kept.
``expected`` and ``error`` are those of all tips over their motion, each about the means of two
minutes, without the sensor and with it; ``expected lean`` and ``lean`` the error of the mean lean
over that lean; ``in use`` the share of the time that the sensor is followed. Behind are the
factors on stiffness, damping and drag that were learned, with their errors; the second line has
the true ones. Below each row is what was said of the sensor in its time, and for how many seconds.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
import re
from typing import Any, NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from tree_sway.commands import Ending
from tree_sway.core.arrays import Floats
from tree_sway.core.scene import make_simulator
from tree_sway.core.species import Species
from tree_sway.core.tree import tips_of_poses, Tree
from tree_sway.twin import advised_places, ObservedTree, place_on, sensor_reports
from tree_sway_lab.twin.gusty_truth import mast_of, Outside, outside_tree, SUBSTEPS
from tree_sway_lab.twin.simulated_sensor import SensedMotion, SimulatedSensor
from tree_sway_lab.twin.true_tree import DT, pose_at, tree_called
from tree_sway_lab.twin.weather import Weather

_ROWS = 12
_MEAN = 120.0
"""Time in [s] about whose means motions are compared."""

_CHUNK = 10.0
"""Time in [s] that is swayed and measured at once."""

_SCORED = 3
"""Steps of which one is compared."""

_WAY = 0.02
"""Time in [s] in which a sample comes."""

_WETTER = 0.01
"""Change of the water over the mass of the leaves at which the true tree is made again."""

_HEAD = (
    'hours', 'wind', 'turned', 'water', 'Hz', 'expected', 'error', 'expected lean', 'lean',
    'in use', 'stiffness', '+-', 'damping', '+-', 'drag', '+-',
)  # fmt: skip


class Chunk(NamedTuple):
    """Wind of the mast (n, 3), tips (n, b, 3) and poses of the sensor's place, (n, 7)."""

    wind: Floats
    tips: Floats
    poses: Floats


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add, default = parser.add_argument, Weather(1.0)
    add('tree', nargs='*', help='kind, or species, height and seed; limbs4 of --seed without one')
    add('--hours', type=float, default=6.0, help='length of the record [h] (%(default)s)')
    add('--speed', type=float, default=default.speed, help='usual mean wind [m/s] (%(default)s)')
    add('--rain', type=float, default=default.rain, help='water over leaves [-] (%(default)s)')
    add('--seed', type=int, default=101, help='of tree, gusts and sensor (%(default)s)')


def run(arguments: argparse.Namespace) -> int:
    """Follow each tree for hours."""
    weather = Weather(3600.0 * arguments.hours, arguments.speed, rain=arguments.rain)
    with Ending():
        for name in arguments.tree or [f'limbs4 {arguments.seed}']:
            _follow(name, weather, arguments.seed)
    return 0


def swayed_in_weather(
    tree: Tree, species: Species, at: str, outside: Outside, weather: Weather
) -> Iterator[Chunk]:
    """Sway a tree in leaf, a chunk at a time; the springs of its wood are those of dry leaves."""
    true = outside_tree(tree, species, outside, in_leaf=True)
    dry, water = true.bodies.rest_torque, 0.0
    field, near = outside.field(tree)
    place, block = place_on(tree, at), np.empty((tree.n_segments, 7))
    rng = np.random.default_rng(outside.seed + 1)
    winds, tips, poses = list[Floats](), list[Floats](), list[Floats]()
    for k, wind in enumerate(weather.gusts(field.places, 1.0 / DT, rng)):
        if abs(weather.water_at(k * DT) - water) > _WETTER:
            water = weather.water_at(k * DT)
            wet = outside_tree(tree, species, outside, in_leaf=True, water=water)
            wet.bodies = wet.bodies._replace(rest_torque=dry)
            wet.state.turn[:], wet.state.rate[:] = true.state
            true = wet
        for _ in range(SUBSTEPS):
            true.step(wind[near], DT / SUBSTEPS)
        winds.append(wind[0].copy())
        tips.append(tips_of_poses(tree, true.place(block)))
        poses.append(pose_at(tree, block, place))
        if len(winds) == round(_CHUNK / DT):
            yield Chunk(np.array(winds), np.array(tips), np.array(poses))
            winds, tips, poses = [], [], []


class LiveSensor:
    """A sensor whose samples come chunk by chunk, at a rate of each."""

    def __init__(self, seed: int) -> None:
        self._rng = np.random.default_rng(seed)
        self._mount = Rotation.random(rng=self._rng)
        self._before = np.zeros((0, 7))
        self._steps = 0

    def measured(self, poses: Floats, rate: float) -> SensedMotion:
        """Return what it has measured by the end of a chunk of poses, (n, 7), and not before."""
        known = np.vstack([self._before, poses])
        began = (self._steps - len(self._before)) * DT
        # Two steps at either end lack a neighbour for their acceleration.
        first, last = 2.0 * DT - 1e-9, (len(known) - 1) * DT - 1e-9
        self._before, self._steps = known[-3:], self._steps + len(poses)
        if not rate:
            return SensedMotion(np.zeros(0), np.zeros((0, 3)), np.zeros((0, 3)))
        sensor = SimulatedSensor(mount=self._mount, rate=rate)
        found = sensor.measured(known, DT, self._rng)
        is_whole = (found.time >= first) & (found.time < last)
        time, acceleration, turning = (each[is_whole] for each in found)
        return SensedMotion(time + began, acceleration, turning)


class Misfit:
    """Errors of tips about the means of stretches, and of these means, over the true ones."""

    def __init__(self, rest: Floats) -> None:
        self._rest = rest
        self._sums = np.zeros(4)

    def add(self, tips: Floats, true: Floats) -> None:
        """Add a stretch of tips, both (n, b, 3)."""
        wrong, moved = tips - true, true - self._rest
        means = wrong.mean(axis=0), moved.mean(axis=0)
        apart = wrong - means[0], moved - means[1]
        parts = *(len(true) * np.square(each).sum() for each in means), *map(_squares, apart)
        self._sums += parts

    def take(self) -> tuple[float, float]:
        """Return the error and that of the lean since it was asked last."""
        lean, leaned, wrong, moved = self._sums.tolist()
        self._sums[:] = 0.0
        return (wrong / moved) ** 0.5, (lean / leaned) ** 0.5


def _squares(values: Floats) -> float:
    return float(np.square(values).sum())


class Sayings:
    """What was said, and for how long, whatever the numbers in it."""

    def __init__(self) -> None:
        self._said: dict[str, tuple[int, str]] = {}

    def note(self, texts: list[str]) -> None:
        """Note what is said in a second."""
        for text in texts:
            key = re.sub(r'[-+]?\d+(\.\d+)?', '#', text)
            seconds, first = self._said.get(key, (0, text))
            self._said[key] = seconds + 1, first

    def take(self) -> list[str]:
        """Return a row for each since they were asked for last."""
        rows = [f'said,{seconds} s,{text}' for seconds, text in self._said.values()]
        self._said.clear()
        return rows


def _follow(name: str, weather: Weather, seed: int) -> None:
    tree, species = tree_called(name)
    outside = Outside(speed=weather.speed, seconds=weather.seconds, seed=seed).drawn(tree)
    distance, bearing = mast_of(outside)
    far: dict[str, Any] = {'anemometer_distance': distance, 'anemometer_bearing': bearing}
    alone = make_simulator(tree, species, in_leaf=True, gusts='expected', **far)
    at = advised_places(make_simulator(tree, species, in_leaf=True), 1, weather.speed)[0].at
    twin = ObservedTree(tree, species, in_leaf=True, at={at: at}, **far)
    print(f'tree,{name},{tree.n_segments} segments,sensor at {at}')
    limb = tree.branch_of_segment[place_on(tree, at).segment]
    wood = outside.wood * float(np.broadcast_to(outside.branches, tree.n_branches)[limb])
    factors = wood, outside.damping, outside.drag
    print(
        'true stiffness of this limb and damping and drag,'
        + ','.join(f'{each:.2f}' for each in factors)
    )
    print(','.join(_HEAD), flush=True)
    rest = tips_of_poses(tree, alone.place())
    sensor, said = LiveSensor(seed), Sayings()
    misfits = Misfit(rest), Misfit(rest)
    block = np.empty((tree.n_segments, 7))
    waiting, used, step = list[tuple[float, Floats, Floats]](), 0, 0
    stretch = list[tuple[Floats, Floats]]()
    per_row = max(round(weather.seconds / _CHUNK / _ROWS), 1)
    every = min(round(_MEAN / _CHUNK), per_row)
    for count, true in enumerate(swayed_in_weather(tree, species, at, outside, weather), start=1):
        rate = weather.rate_at(step * DT)
        waiting.extend(zip(*sensor.measured(true.poses, rate), strict=True))
        scored = slice(_SCORED - 1, None, _SCORED)
        tips = np.empty((2, len(true.wind) // _SCORED, tree.n_branches, 3))
        for k, wind in enumerate(true.wind):
            step += 1
            while waiting and waiting[0][0] + _WAY <= step * DT:
                time, acceleration, turning = waiting.pop(0)
                twin.offer(at, time, acceleration=acceleration, rate=turning)
            alone.step(wind, DT)
            twin.step(wind, DT)
            if step % _SCORED == 0:
                tips[0, k // _SCORED] = tips_of_poses(tree, alone.place(block))
                tips[1, k // _SCORED] = tips_of_poses(tree, twin.place(block))
            used += twin.observer.tracks[0].in_use
            if step % round(1.0 / DT) == 0:
                said.note(_said_of(twin))
        stretch.append((tips, true.tips[scored]))
        if len(stretch) == every:
            found, wanted = (np.concatenate(each, axis=-3) for each in zip(*stretch, strict=True))
            for misfit, each in zip(misfits, found, strict=True):
                misfit.add(each, wanted)
            stretch.clear()
        if count % per_row == 0:
            _print(step * DT, weather, twin, misfits, used / (per_row * len(true.wind)))
            for row in said.take():
                print(row, flush=True)
            used = 0


def _said_of(twin: ObservedTree) -> list[str]:
    """Return what is said of the sensor, and whether the tree sways differently."""
    notes = [note for report in sensor_reports(twin) for note in report.notes]
    changes = [str(each) for each in twin.sway_changes if each.is_change]
    return [*twin.problems, *notes, *changes]


def _print(
    time: float, weather: Weather, twin: ObservedTree, misfits: tuple[Misfit, Misfit], used: float
) -> None:
    middle = time - 0.5 * weather.seconds / _ROWS
    (without, lean_without), (error, lean) = (each.take() for each in misfits)
    fit = twin.observer.fit
    factors = [np.nan] * 6
    if fit is not None:
        factors = [
            fit.stiffness, fit.stiffness_error, fit.damping, fit.damping_error, fit.drag,
            fit.drag_error,
        ]  # fmt: skip
    figures = [without, error, lean_without, lean, used, *factors]
    row = [
        f'{time / 3600.0:.2f}',
        f'{weather.speed_at(middle):.1f}',
        f'{np.degrees(weather.turn_at(middle)):.0f}',
        f'{weather.water_at(middle):.2f}',
        f'{weather.rate_at(middle):.0f}',
        *(f'{each:.2f}' for each in figures),
    ]
    print(','.join(row), flush=True)
