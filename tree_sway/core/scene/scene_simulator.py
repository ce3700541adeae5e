# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The simulator of a scene of several trees in one wind.

Trees on a number of coordinates share the table and the rest geometry of their kind: each is a
state, a pose, a scale and the delay with which gusts reach it. All of them are solved in one call.
Trees on other models are solved one after another, each by a simulator at the place of the tree,
so that the wind need not be rotated into its frame.
"""

from __future__ import annotations

from collections.abc import Callable
from copy import copy
from dataclasses import replace
from functools import cached_property
import math
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats, Ints, Records
from tree_sway.core.checks import array_to_fill, array_to_read, refuse_time_step, three_numbers
from tree_sway.core.kernel import WHY_PLAIN
from tree_sway.core.model.model_cache import ModelCache, PREPARED
from tree_sway.core.model.records import instance_layout, time_step_layout, zeros_in_lines
from tree_sway.core.model.settings import Settings
from tree_sway.core.run.clamp_watch import ClampWatch, fewer
from tree_sway.core.run.placing_by_keys import placing_by_keys
from tree_sway.core.run.simulator import (
    Counts,
    LOAD_CLAMPED,
    OK,
    RESTARTED,
    SwaySimulator,
    WIND_REFUSED,
)
from tree_sway.core.run.stand import place_stand, PLACEMENT
from tree_sway.core.run.table_model import (
    bent_too_far,
    come_to_rest,
    drop,
    fill_time_step,
    propagators_of,
    WindBasisBank,
)
from tree_sway.core.run.tuning import Tuning
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.scene.placed_trees import PlacedTrees
from tree_sway.core.scene.placement_records import own_steps, placement_records
from tree_sway.core.setup.prepare import prepare
from tree_sway.core.tree.segment_frame import ends_of_poses
from tree_sway.core.tree.tree import Tree
from tree_sway.core.wind.gust_travel import GustHistory
from tree_sway.core.wind.limits import is_wind
from tree_sway.errors import inside, nearest, ParameterError

if WHY_PLAIN:
    from tree_sway.core.run.numpy_stand import step_stand
else:
    from tree_sway.core.run.stand import step_stand
if TYPE_CHECKING:
    from tree_sway.core.run.pushes import Spring

_NO_TABLES: Records = np.zeros(0, dtype=PLACEMENT)
_CROWN = 0.7


class SceneSimulator:
    """
    Trees that sway in one wind; used like a `SwaySimulator`. `Scene.simulator` makes it.

    Parameters
    ----------
    scene
        Trees and the place of the anemometer.
    settings
        Settings of the trees, except values that a tree has itself.
    tolerance, cache, progress
        Arguments of `Scene.simulator`.

    Raises
    ------
    TreeSwayError
        Error of a tree, with its name.

    """

    def __init__(
        self,
        scene: PlacedTrees,
        settings: Settings,
        *,
        tolerance: float = 0.005,
        cache: ModelCache | None = PREPARED,
        progress: Callable[[int], object] = lambda done: None,
    ) -> None:
        """Make a table for every kind that needs one, and a simulator for every other tree."""
        self.scene, self.settings, trees = scene, settings, scene.trees
        self.names = tuple(each.name for each in trees)
        models = [settings.model if each.model is None else each.model for each in trees]
        kind = scene.kind_numbers
        counts = np.array([each if isinstance(each, int) else -1 for each in models])
        # Winds of limbs are those of one tree.
        is_own = (counts < 0) | (settings.crown_coherence < 1.0)
        used = np.unique(kind[~is_own]).tolist()
        self._models: list[SwaySimulator] = []
        for k in used:
            those = np.flatnonzero((kind == k) & ~is_own)
            most = int(counts[those].max()) or 1
            with inside(self.names[those[0]]):
                tree, species, _ = scene.kinds[k]
                chosen = replace(scene.kinds[k].settings(settings), model=most)
                self._models.append(SwaySimulator(prepare(tree, species, chosen, cache=cache)))
            progress(len(self._models))
        self._banks: list[WindBasisBank] = [_oscillators(model) for model in self._models]
        places = [(each.x, each.y, each.z, each.yaw, each.scale) for each in trees]
        tables = np.where(is_own, -1, np.searchsorted(used, kind))
        self._placed = placement_records(tables, np.array(places), self._speeds())
        self.speeds: Floats = self._placed['speed']
        """Wind of each tree over that of its kind, (t,)."""
        self._placed['is_still'] = is_own | (counts == 0)
        self._make_tables()
        self._asked, self._is_shared = counts, ~is_own
        self._numbers = self._asked.copy()
        """Numbers of coordinates that the trees show, (t,); -1 on their own models."""
        self._watches: dict[int, ClampWatch] = {}
        self._show()
        self.own: dict[int, SwaySimulator] = {}
        """Simulators of the trees that share no table, by their numbers."""
        for t in np.flatnonzero(is_own).tolist():
            one = trees[t]
            with inside(one.name):
                where = one.settings_where_it_stands(settings)
                self.own[t] = make_simulator(
                    one.placed(), one.species, where, tolerance=tolerance, cache=cache
                )
            progress(len(self._models) + len(self.own))
        self.simulators = tuple(self.own.values())
        sizes = np.array([each.tree.n_segments for each in scene.kinds])
        self._ends = np.concatenate([[0], np.cumsum(sizes[kind])])
        self.gusts = GustHistory(
            self._placed['at'], scene.anemometer, convection_ratio=scene.convection_ratio
        )
        self._counts = Counts()
        self.pushed: dict[int, SwaySimulator] = {}
        """Trees on which pushes have an effect, by their numbers."""
        self.wind, self._dt = np.zeros(3), math.nan
        """Wind at the anemometer in the last step in [m/s], (3,)."""

    def __repr__(self) -> str:
        """Return the scene, the number of trees, the models and the steps on one line."""
        return (
            f'SceneSimulator of {self.scene.name}, {len(self.names)} trees, model {self.model}: '
            f'{self._counts.steps} steps'
        )

    @property
    def model(self) -> str:
        """Models in use."""
        shared = np.unique(self._numbers[self._is_shared]).astype(str).tolist()
        return ', '.join([*shared, *dict.fromkeys(sim.model for sim in self.own.values())])

    @property
    def counts(self) -> Counts:
        """Return counts of the wind, and of clamped or restarted trees."""
        own, counts = [sim.counts for sim in self.own.values()], self._counts
        return replace(
            counts,
            clamped=counts.clamped + sum(each.clamped for each in own),
            reduced=counts.reduced + sum(each.reduced for each in own),
            restarted=counts.restarted + sum(each.restarted for each in own),
        )

    @property
    def tree(self) -> Tree:
        """All trees in one record, to be described or drawn."""
        return self.scene.tree

    def segments_of(self, name: str) -> slice:
        """Return the rows of a tree in the pose block; a `ParameterError` for another name."""
        if name not in self.names:
            cure = f'{nearest(name, self.names)} use one of: {", ".join(self.names[:20])}'
            raise ParameterError(f"no tree is called '{name}'", where=self.scene.name, cure=cure)
        number = self.names.index(name)
        return slice(int(self._ends[number]), int(self._ends[number + 1]))

    def step(self, wind_mean: ArrayLike, dt: float) -> int:
        """
        Advance one step.

        Parameters
        ----------
        wind_mean
            Mean of the wind over the step at the anemometer, the way the air goes, in [m/s], (3,).
        dt
            Length of the step in [s].

        Returns
        -------
        int
            Result of `SwaySimulator.step`, of all trees together.

        Raises
        ------
        ParameterError
            A step that is not above 0 or not finite.

        """
        refuse_time_step(dt)
        status = OK
        # The history must not contain winds that the trees refuse.
        wind = three_numbers('wind', wind_mean)
        if is_wind(*wind, self.settings.max_wind):
            self.wind[:] = wind
        else:
            status = WIND_REFUSED
            self._counts.refused += 1
        has_glided = [model.glide(dt) for model in self._models]
        if dt != self._dt or any(has_glided):
            self._set_step(dt)
        winds = self.gusts.push(self.wind, dt)
        clamped = restarted = 0
        if self._models:
            clamped, restarted = step_stand(
                self._tables, self._time_steps, self._placed, self._instances, self._laws, winds
            )
        for number, simulator in self.own.items():
            status |= simulator.step(winds[number].tolist(), dt)
        for number, one in list(self.pushed.items()):
            if number not in self.own:
                own = self._placed['time_step'][number]
                _oscillators(one).time_step = self._time_steps[own : own + 1]
                clamped += one.touched(dt) > 0
            if one.touch is None:
                del self.pushed[number]
        self._counts.steps += 1
        if clamped:
            self._watch_clamped(dt)
        self._counts.clamped += clamped
        self._counts.restarted += restarted
        return status | (LOAD_CLAMPED if clamped else OK) | (RESTARTED if restarted else OK)

    def _watch_clamped(self, dt: float) -> None:
        """Show fewer coordinates of trees whose steps stay clamped, and which no push bends."""
        most = self._tables['most_pressure'][self._placed['kind']]
        for number in np.flatnonzero(bent_too_far(self._instances, most)).tolist():
            watch = self._watches.setdefault(number, ClampWatch())
            if number in self.pushed or not watch.is_stuck(self._counts.steps, dt):
                continue
            bank = self._banks[self._placed['kind'][number]]
            before = min(int(self._numbers[number]), bank.shapes.shape[1])
            count = fewer(before)
            if count < before:
                self._numbers[number] = count
                self._counts.reduced += 1
                come_to_rest(self._instances[number : number + 1])
                self._show()
                self._dt = math.nan  # it has a step of its own from now on

    def push(
        self, segment: int, force: ArrayLike | Spring, seconds: float, *, along: float = 0.5
    ) -> None:
        """Push or pull at a segment by its row in the pose block, as `SwaySimulator.push`."""
        from tree_sway.core.run.pushes import MOST_PUSHES, row_of

        try:
            row = row_of(segment, int(self._ends[-1]))
            number = int(self._ends.searchsorted(row, 'right')) - 1
            active = {t for t, one in self.pushed.items() if one.touch and one.touch.pushes}
            if len(active | {number}) > MOST_PUSHES:
                raise ParameterError(f'more than {MOST_PUSHES} trees at once', where='push')
            one = self.own.get(number) or self.pushed.get(number) or self._one_of_kind(number)
            own = force if number in self.own else self._in_kind(number, force)
            one.push(row - int(self._ends[number]), own, seconds, along=along)
            self.pushed[number] = one
        except ParameterError:
            self._counts.refused_pushes += 1
            raise

    def _one_of_kind(self, number: int) -> SwaySimulator:
        """Return a simulator of a tree's kind with the state of the tree, for pushes."""
        model = self._models[self._placed['kind'][number]]
        one, bank = copy(model), copy(_oscillators(model))
        bank.__dict__.pop('_expand', None)
        bank.instance = self._instances[number : number + 1]
        one.bank = replace(model.bank, oscillators=bank)
        return one

    def _in_kind(self, number: int, force: ArrayLike | Spring) -> ArrayLike | Spring:
        """
        Return a force or a spring on a tree as it is on one of its kind.

        A tree scaled by k moves k times as far by the same angles, against k^3 times the
        stiffness: a force is scaled by 1 / k^2, the stiffness of a spring by 1 / k.
        """
        from tree_sway.core.run.pushes import Spring

        one, k = self.scene.trees[number], float(self._placed['scale'][number])
        c, s = math.cos(one.yaw), math.sin(one.yaw)
        back = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        if not isinstance(force, Spring):
            return back @ array_to_read('push', force, (3,)) / k**2
        away = array_to_read('push', force.to, (3,)) - self._placed['at'][number]
        return Spring(back @ away / k + one.tree.start[0], force.stiffness / k)

    def check_tuning(self, **changes: float) -> Tuning:
        """Check changes for all trees, as `SwaySimulator.check_tuning`."""
        trees = (*self._models, *self.own.values())
        return [each.check_tuning(**changes) for each in trees][-1]

    def tune(self, **changes: float) -> None:
        """Change every tree while it sways, as `SwaySimulator.tune`; all or none."""
        self.check_tuning(**changes)
        for each in (*self._models, *self.own.values()):
            each.tune(**changes)

    def place(self, out: Floats | None = None) -> Floats:
        """
        Place every segment of every tree.

        Parameters
        ----------
        out
            Where to write, (n, 7) float64, to be fast; a new array if None.

        Returns
        -------
        Floats
            Pose block of all trees, one after another; see `SwaySimulator.place`.

        Raises
        ------
        ParameterError
            An array of a wrong shape or type.

        """
        shape = (int(self._ends[-1]), 7)
        poses = np.zeros(shape) if out is None else array_to_fill('out', out, shape)
        for kind, (_, _, those) in enumerate(self.shared):
            self._place_kind(kind, np.stack([those, self._ends[those]], axis=1), poses)
        for number, simulator in self.own.items():
            simulator.place(poses[self._ends[number] : self._ends[number + 1]])
        return poses

    def _make_tables(self) -> None:
        """Lay the tables of the kinds side by side, and make the state of every tree on them."""
        banks = self._banks
        n_modes = max((bank.shapes.shape[1] for bank in banks), default=1)
        for bank in banks:
            bank.lay_out(n_modes)
        layout = instance_layout(n_modes)
        self._instances = np.zeros(len(self.names) if banks else 0, dtype=layout)
        self._time_steps = np.zeros(0, dtype=time_step_layout(n_modes))
        self._tables = zeros_in_lines(len(banks), banks[0].record.dtype) if banks else _NO_TABLES
        for number, bank in enumerate(banks):
            self._tables[number] = bank.record[0]
        self._laws = np.array([model.drag_law for model in self._models])
        self._scratch = []
        """Scratch memory for placing each kind."""
        for model, bank in zip(self._models, banks, strict=True):
            blocks = zeros_in_lines(len(model.bank.blocks), model.bank.blocks.dtype)
            blocks[:] = model.bank.blocks
            block, bases = np.zeros((model.tree.n_segments, 7)), np.zeros_like(model.bank.bases)
            self._scratch.append((blocks, bases, bank.room_for_rotations(), block))
        self._by_keys = [
            placing_by_keys(model.bank.branches, model.bank.segments, blocks)
            for model, (blocks, *_) in zip(self._models, self._scratch, strict=True)
        ]

    def _show(self) -> None:
        """Hide the coordinates of the table that a tree does not have."""
        for _, bank, those in self.shared:
            left_out = np.maximum(bank.shapes.shape[1] - self._numbers[those], 0)
            self._instances['left_out'][those] = left_out

    @property
    def shared(self) -> list[tuple[SwaySimulator, WindBasisBank, Ints]]:
        """Models in their own frames, with their tables and trees."""
        kinds = np.where(self._is_shared, self._placed['kind'], -1)
        pairs = enumerate(zip(self._models, self._banks, strict=True))
        return [(model, bank, np.flatnonzero(kinds == k)) for k, (model, bank) in pairs]

    def shares(self, numbers: Ints) -> Floats:
        """Coordinates of trees of one kind, (t, m)."""
        n_modes = self._banks[self._placed['kind'][numbers[0]]].shapes.shape[1]
        is_shown = np.arange(n_modes) < self._numbers[numbers, None]
        return np.asarray(np.where(is_shown, self._instances['eta'][numbers, :n_modes], 0.0))

    def _place_kind(self, kind: int, rows: Ints, out: Floats) -> None:
        """Place trees of one table: their numbers and first rows in a pose block, (w, 2)."""
        records, bank = self._models[kind].bank, self._banks[kind]
        blocks, bases, x, block = self._scratch[kind]
        if not WHY_PLAIN:
            place_stand(
                self._placed, self._instances, rows, bank.laid_shapes, records.segments, blocks,
                bases, x, block, out,
            )  # fmt: skip
        for number, first in rows.tolist() if WHY_PLAIN or self.pushed else ():
            if number in self.pushed:
                keys = self.pushed[number].rotations()
            elif WHY_PLAIN:
                keys = bank.rotations_of(self._instances[number : number + 1])
            else:
                continue
            at, own = self._placed[number], out[first : first + len(block)]
            turned = float(at['cosine']), float(at['sine']), float(at['scale'])
            self._by_keys[kind].place(keys, at['at'], own, *turned)

    @cached_property
    def _highest(self) -> tuple[int, Tree]:
        """Number of the tree whose tip is the highest, and the tree where it is."""
        tops = self._placed['at'][:, 2] + self._placed['scale'] * self._heights()
        number = int(np.argmax(tops))
        return number, self.scene.trees[number].placed()

    @property
    def tip_displacement(self) -> Floats:
        """Displacement of the highest tip of all from rest in [m], (3,)."""
        number, tree = self._highest
        if number in self.own:
            return self.own[number].tip_displacement
        top, poses = int(np.argmax(tree.end[:, 2])), np.empty((tree.n_segments, 7))
        self._place_kind(int(self._placed['kind'][number]), np.array([[number, 0]]), poses)
        return np.asarray(ends_of_poses(poses, tree.length)[1][top] - tree.end[top])

    def reset(self) -> None:
        """Bring every tree to rest and forget the wind; the counts stay."""
        self._instances[:] = np.zeros((), dtype=self._instances.dtype)
        self._numbers[:] = self._asked
        self._watches.clear()
        self._dt = math.nan
        self._show()
        for simulator in self.own.values():
            simulator.reset()
        self.gusts.reset()
        self.pushed.clear()
        self.wind[:] = 0.0

    def _speeds(self) -> Floats:
        """Wind of each tree over that of its kind, (t,)."""
        profile, scale = self.settings.profile, np.array([each.scale for each in self.scene.trees])
        crown = profile.ground + _CROWN * self._heights() * np.array([np.ones(len(scale)), scale])
        own, scaled = profile.over_anemometer(crown)
        return np.where(own > 0.0, scaled / np.where(own > 0.0, own, 1.0), 1.0)

    def _heights(self) -> Floats:
        """Heights of the trees' kinds in [m], (t,)."""
        return np.array([each.tree.height for each in self.scene.kinds])[self.scene.kind_numbers]

    def _set_step(self, dt: float) -> None:
        """Fill the coefficients of every kind and scale, rounded to a hundredth."""
        rows = np.flatnonzero(self._is_shared)
        found, number = own_steps(self._placed['kind'][rows], self._placed['scale'][rows], dt)
        reduced = np.flatnonzero(self._numbers < self._asked)
        self._time_steps = np.zeros(len(found) + len(reduced), dtype=self._time_steps.dtype)
        for time_step, (kind, own_dt) in zip(self._time_steps[: len(found)], found, strict=True):
            modal = self._banks[kind].modal
            modal.set_time_step(own_dt)
            fill_time_step(time_step, propagators_of(modal), own_dt)
        self._placed['time_step'][rows] = number
        for own, tree in enumerate(reduced.tolist(), start=len(found)):
            self._time_steps[own] = self._time_steps[self._placed['time_step'][tree]]
            drop(self._time_steps[own], int(self._numbers[tree]))
            self._placed['time_step'][tree] = own
        self._dt = dt


Simulator: TypeAlias = SwaySimulator | SceneSimulator
"""Simulator of a tree on any model, or of the trees of a scene, with the same interface."""


def _oscillators(model: SwaySimulator) -> WindBasisBank:
    oscillators = model.bank.oscillators
    assert isinstance(oscillators, WindBasisBank)
    return oscillators
