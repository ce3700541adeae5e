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
from functools import cached_property, partial
import math
from typing import Any, TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tree_sway.core.arrays import Floats, Ints, Records
from tree_sway.core.checks import array_to_fill, array_to_read, refuse_time_step, three_numbers
from tree_sway.core.kernel import WHY_PLAIN
from tree_sway.core.model.model_cache import ModelCache, PREPARED
from tree_sway.core.model.records import instance_layout, time_step_layout, zeros_in_lines
from tree_sway.core.model.settings import Settings
from tree_sway.core.model.state_basis import StateBasis
from tree_sway.core.model.sway_model import SwayModel
from tree_sway.core.model.tree_state import (
    digest_of,
    fill_memory,
    refuse_other_state,
    TreeState,
    values_of,
)
from tree_sway.core.run.bank import Bank
from tree_sway.core.run.clamp_watch import ClampWatch, fewer
from tree_sway.core.run.placing_by_keys import placing_by_keys
from tree_sway.core.run.simulator import (
    Counts,
    LOAD_CLAMPED,
    Motion,
    OK,
    RESTARTED,
    rows_of_tree,
    SwaySimulator,
    TreeGroup,
    WIND_REFUSED,
    with_oscillators,
)
from tree_sway.core.run.stand import place_stand, PLACEMENT
from tree_sway.core.run.table_model import (
    bent_too_far,
    come_to_rest,
    drop,
    fill_time_step,
    propagators_of,
    STATE_FIELDS,
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
from tree_sway.errors import inside, ParameterError

if WHY_PLAIN:
    from tree_sway.core.run.numpy_stand import step_stand
else:
    from tree_sway.core.run.stand import step_stand
if TYPE_CHECKING:
    from tree_sway.core.run.pushes import Spring, Touch

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
        self._scene, self.settings, trees = scene, settings, scene.trees
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
        self._alone: dict[int, SwaySimulator] = {}
        """Simulators of the trees that share no table, by their numbers."""
        for t in np.flatnonzero(is_own).tolist():
            one = trees[t]
            with inside(one.name):
                where = one.settings_where_it_stands(settings)
                self._alone[t] = make_simulator(
                    one.placed(), one.species, where, tolerance=tolerance, cache=cache
                )
            progress(len(self._models) + len(self._alone))
        sizes = np.array([each.tree.n_segments for each in scene.kinds])
        self._ends = np.concatenate([[0], np.cumsum(sizes[kind])])
        self.gusts = GustHistory(
            self._placed['at'], scene.anemometer, convection_ratio=scene.convection_ratio
        )
        self._counts = Counts()
        self._pushed: dict[int, SwaySimulator] = {}
        """Simulators of the trees on which pushes have an effect, by their numbers."""
        self.wind, self._dt = np.zeros(3), math.nan
        """Wind at the anemometer in the last step in [m/s], (3,)."""

    def __repr__(self) -> str:
        """Return the scene, the number of trees, the models and the steps on one line."""
        return (
            f'SceneSimulator of {self._scene.name}, {len(self.names)} trees, model {self.model}: '
            f'{self._counts.steps} steps'
        )

    @property
    def model(self) -> str:
        """Models in use."""
        shared = np.unique(self._numbers[self._is_shared]).astype(str).tolist()
        return ', '.join([*shared, *dict.fromkeys(sim.model for sim in self._alone.values())])

    @property
    def counts(self) -> Counts:
        """Return counts of the wind, and of clamped or restarted trees."""
        own, counts = [sim.counts for sim in self._alone.values()], self._counts
        return replace(
            counts,
            clamped=counts.clamped + sum(each.clamped for each in own),
            reduced=counts.reduced + sum(each.reduced for each in own),
            restarted=counts.restarted + sum(each.restarted for each in own),
        )

    @property
    def name(self) -> str:
        """Name of the scene."""
        return self._scene.name

    @property
    def tree(self) -> Tree:
        """All trees in one record, to be described or drawn."""
        return self._scene.tree

    @property
    def simulators(self) -> tuple[SwaySimulator, ...]:
        """Simulators of the trees that share no table."""
        return tuple(self._alone.values())

    @property
    def models(self) -> tuple[SwayModel, ...]:
        """Prepared models of the shared tables, then of the trees with their own."""
        return tuple(each.models[0] for each in (*self._models, *self._alone.values()))

    @property
    def banks(self) -> tuple[Bank, ...]:
        """Records and oscillators, as `models`."""
        return tuple(each.banks[0] for each in (*self._models, *self._alone.values()))

    @property
    def mass(self) -> float:
        """Mass of wood and leaves of all trees in [kg]."""
        shared = (float(each['scale']) ** 3 * self._models[each['kind']].mass
                  for each in self._placed[self._is_shared])  # fmt: skip
        return sum(shared) + sum(each.mass for each in self._alone.values())

    @property
    def places(self) -> Floats:
        """
        Place of each tree, (t, 5): x y z of its root node [m], its turn [rad], its scale.

        The records of a tree that shares no table are at its place: it has no turn and scale.
        """
        places = np.array([(each.x, each.y, each.z, each.yaw, each.scale)
                           for each in self._scene.trees])  # fmt: skip
        for number, one in self._alone.items():
            places[number] = one.places[0]
        return places

    def frequencies(self, count: int = 10) -> Floats:
        """Lowest natural frequencies of all trees, as `SwaySimulator.frequencies`."""
        found = [each.frequencies(count) for each in self._alone.values()]
        for kind, _, those in self._kinds():
            own = self._models[kind].frequencies(count)
            found.append((own / self._placed['scale'][those, None]).ravel())
        return np.sort(np.concatenate(found))[: int(count)]

    def digest(self) -> str:
        """Digest of trees, places, settings and tuning."""
        trees = [each.digest() for each in (*self._models, *self._alone.values())]
        return digest_of(trees, self.settings, self.places, self._placed['kind'], self._asked)

    def memory(self) -> tuple[NDArray[Any], ...]:
        """Return views of the state, the wind of the last step first."""
        own = [array for each in self._alone.values() for array in each.memory()]
        return *self._shared_memory(), *own

    def _shared_memory(self) -> tuple[NDArray[Any], ...]:
        """Return views of the wind, and of the trees on shared tables."""
        trees = [self._instances[name] for name in STATE_FIELDS]
        return self.wind, *self.gusts.memory(), *trees, self._numbers

    def state(self) -> TreeState:
        """Return a copy of the state of all trees, and of the wind of the last minute."""
        asked = ' '.join(map(str, self._asked.tolist()))
        return TreeState(self.name, self.digest(), asked, values_of(self.memory()))

    def set_state(self, state: TreeState) -> None:
        """Continue from a state, as `SwaySimulator.set_state`."""
        refuse_other_state(state, self.state())
        shared = self._shared_memory()
        fill_memory(shared, state.values)
        first = sum(array.size for array in shared)
        for each in self._alone.values():
            last = first + sum(array.size for array in each.memory())
            part = state.values[first:last]
            each.set_state(TreeState(each.name, each.digest(), each.model, part))
            first = last
        self._show()
        self._dt = math.nan

    def segments_of(self, name: str) -> slice:
        """Return the rows of a tree in the pose block; a `ParameterError` for another name."""
        return rows_of_tree(name, self.names, self._ends.tolist(), self.name)

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
        has_glided = self.glide(dt)
        if dt != self._dt or has_glided:
            self._set_step(dt)
        winds = self.gusts.push(self.wind, dt)
        clamped = restarted = 0
        if self._models:
            clamped, restarted = step_stand(
                self._tables, self._time_steps, self._placed, self._instances, self._laws, winds
            )
        for number, simulator in self._alone.items():
            status |= simulator.step(winds[number].tolist(), dt)
        if self._pushed:
            status |= self.touched(dt)
        self._counts.steps += 1
        if clamped:
            self._watch_clamped(dt)
        self._counts.clamped += clamped
        self._counts.restarted += restarted
        return status | (LOAD_CLAMPED if clamped else OK) | (RESTARTED if restarted else OK)

    def glide(self, dt: float) -> bool:
        """Continue transitions of `tune` of the shared tables, as `SwaySimulator.glide`."""
        return any([model.glide(dt) for model in self._models])

    def touched(self, dt: float) -> int:
        """Add the effect of pushes on trees with shared tables; returns bits as `step`."""
        clamped = 0
        for number, one in list(self._pushed.items()):
            if number not in self._alone:
                own = self._placed['time_step'][number]
                _oscillators(one).time_step = self._time_steps[own : own + 1]
                clamped += one.touched(dt) > 0
            if not one.pushed:
                del self._pushed[number]
        self._counts.clamped += clamped
        return LOAD_CLAMPED if clamped else OK

    def _watch_clamped(self, dt: float) -> None:
        """Show fewer coordinates of trees whose steps stay clamped, and which no push bends."""
        most = self._tables['most_pressure'][self._placed['kind']]
        for number in np.flatnonzero(bent_too_far(self._instances, most)).tolist():
            watch = self._watches.setdefault(number, ClampWatch())
            if number in self._pushed or not watch.is_stuck(self._counts.steps, dt):
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
            active = {t for t, touch in self.pushed.items() if touch.pushes}
            if len(active | {number}) > MOST_PUSHES:
                raise ParameterError(f'more than {MOST_PUSHES} trees at once', where='push')
            one = self._one(number)
            own = force if number in self._alone else self._in_kind(number, force)
            one.push(row - int(self._ends[number]), own, seconds, along=along)
            self._pushed[number] = one
        except ParameterError:
            self._counts.refused_pushes += 1
            raise

    @property
    def pushed(self) -> dict[int, Touch]:
        """Pushes on trees by their numbers, until their effect is gone."""
        return {t: touch for t, one in self._pushed.items() for touch in one.pushed.values()}

    @property
    def push_load(self) -> Floats:
        """
        Load of the last step's pushes on each tree, (t, 6).

        Force [N] and moment about its root node [N m].
        """
        found = np.zeros((len(self.names), 2, 3))
        for number, touch in self.pushed.items():
            found[number] = self._on_tree(number, touch.load.reshape(2, 3))
        return found.reshape(-1, 6)

    @property
    def base_moment(self) -> Floats:
        """Moment of the last step's wind on each tree about its root node, [N m], (t, 3)."""
        found = np.zeros((len(self.names), 3))
        for number in range(len(found)):
            load = np.stack([np.zeros(3), self._one(number).base_moment])
            found[number] = self._on_tree(number, load)[1]
        return found

    def _on_tree(self, number: int, load: Floats) -> Floats:
        """Return a force and a moment on one of a tree's kind as they are on the tree, (2, 3)."""
        if number in self._alone:
            return load
        scale = float(self._placed['scale'][number])
        turned = load @ _turned(self._scene.trees[number].yaw)
        return np.asarray(turned * np.array([[scale**2], [scale**3]]))

    def _one(self, number: int) -> SwaySimulator:
        """Return a simulator of a tree, or of its kind with the state of the tree."""
        found = self._alone.get(number) or self._pushed.get(number)
        if found is not None:
            return found
        model = self._models[self._placed['kind'][number]]
        bank = copy(_oscillators(model))
        bank.__dict__.pop('_expand', None)
        bank.instance = self._instances[number : number + 1]
        return with_oscillators(model, bank)

    def _in_kind(self, number: int, force: ArrayLike | Spring) -> ArrayLike | Spring:
        """
        Return a force or a spring on a tree as it is on one of its kind.

        A tree scaled by k moves k times as far by the same angles, against k^3 times the
        stiffness: a force is scaled by 1 / k^2, the stiffness of a spring by 1 / k.
        """
        from tree_sway.core.run.pushes import Spring

        one, k = self._scene.trees[number], float(self._placed['scale'][number])
        back = _turned(one.yaw)
        if not isinstance(force, Spring):
            return back @ array_to_read('push', force, (3,)) / k**2
        away = array_to_read('push', force.to, (3,)) - self._placed['at'][number]
        return Spring(back @ away / k + one.tree.start[0], force.stiffness / k)

    def check_tuning(self, **changes: float) -> Tuning:
        """Check changes for all trees, as `SwaySimulator.check_tuning`."""
        trees = (*self._models, *self._alone.values())
        return [each.check_tuning(**changes) for each in trees][-1]

    def tune(self, **changes: float) -> None:
        """Change every tree while it sways, as `SwaySimulator.tune`; all or none."""
        self.check_tuning(**changes)
        for each in (*self._models, *self._alone.values()):
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
        for kind, _, those in self._kinds():
            self._place_kind(kind, np.stack([those, self._ends[those]], axis=1), poses)
        for number, simulator in self._alone.items():
            simulator.place(poses[self._ends[number] : self._ends[number + 1]])
        return poses

    def rotations(self) -> Floats:
        """Key rotations of all trees in [rad], one tree after another, (N,)."""
        return np.concatenate([self._one(t).rotations() for t in range(len(self.names))])

    def place_rotations(self, rotations: Floats, out: Floats | None = None) -> Floats:
        """Place every segment by key rotations (N,), as `SwaySimulator.place_rotations`."""
        kinds = np.where(self._is_shared, self._placed['kind'], -1).tolist()
        trees = [self._alone[t] if k < 0 else self._models[k] for t, k in enumerate(kinds)]
        sizes = [each.models[0].n_keys for each in trees]
        read = array_to_read('rotations', rotations, (sum(sizes),))
        shape, first = (int(self._ends[-1]), 7), 0
        poses = np.zeros(shape) if out is None else array_to_fill('out', out, shape)
        for number, (tree, size) in enumerate(zip(trees, sizes, strict=True)):
            keys, rows = read[first : first + size], poses[slice(*self._ends[number : number + 2])]
            if number in self._alone:
                tree.place_rotations(keys, rows)
            else:
                self._place_by_keys(number, keys, rows)
            first += size
        return poses

    def _place_by_keys(self, number: int, keys: Floats, out: Floats) -> None:
        """Place a tree on a shared table by its key rotations."""
        at = self._placed[number]
        turned = float(at['cosine']), float(at['sine']), float(at['scale'])
        self._by_keys[at['kind']].place(keys, at['at'], out, *turned)

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
        self._laws = np.array([model.models[0].drag_law for model in self._models])
        self._scratch = []
        """Scratch memory for placing each kind."""
        for model, bank in zip(self._models, banks, strict=True):
            blocks = zeros_in_lines(len(model.banks[0].blocks), model.banks[0].blocks.dtype)
            blocks[:] = model.banks[0].blocks
            block, bases = (
                np.zeros((model.tree.n_segments, 7)),
                np.zeros_like(model.banks[0].bases),
            )
            self._scratch.append((blocks, bases, bank.room_for_rotations(), block))
        self._by_keys = [
            placing_by_keys(model.banks[0].branches, model.banks[0].segments, blocks)
            for model, (blocks, *_) in zip(self._models, self._scratch, strict=True)
        ]

    def _show(self) -> None:
        """Hide the coordinates of the table that a tree does not have."""
        for _, bank, those in self._kinds():
            left_out = np.maximum(bank.shapes.shape[1] - self._numbers[those], 0)
            self._instances['left_out'][those] = left_out

    def _kinds(self) -> list[tuple[int, WindBasisBank, Ints]]:
        """Return the number of each shared table, the table, and the numbers of its trees."""
        kinds = np.where(self._is_shared, self._placed['kind'], -1)
        return [(k, bank, np.flatnonzero(kinds == k)) for k, bank in enumerate(self._banks)]

    @property
    def groups(self) -> list[TreeGroup]:
        """Trees that share a table, table by table, then each of the others."""
        shared = [
            TreeGroup(self._models[kind], those, partial(self._in_basis, bank, those))
            for kind, bank, those in self._kinds()
        ]
        alone = self._alone.items()
        return shared + [each.groups[0]._replace(numbers=np.array([t])) for t, each in alone]

    def _in_basis(self, bank: WindBasisBank, numbers: Ints, basis: StateBasis) -> Motion:
        """Return a function that finds the motion of trees of one kind in a basis, (t, m)."""
        per_shape = bank.all_shapes @ basis.projection.T
        return lambda: np.asarray(self._coordinates(numbers) @ per_shape)

    def _coordinates(self, numbers: Ints) -> Floats:
        """Coordinates of trees of one kind, (t, m)."""
        n_modes = self._banks[self._placed['kind'][numbers[0]]].shapes.shape[1]
        is_shown = np.arange(n_modes) < self._numbers[numbers, None]
        return np.asarray(np.where(is_shown, self._instances['eta'][numbers, :n_modes], 0.0))

    def _place_kind(self, kind: int, rows: Ints, out: Floats) -> None:
        """Place trees of one table: their numbers and first rows in a pose block, (w, 2)."""
        records, bank = self._models[kind].banks[0], self._banks[kind]
        blocks, bases, x, block = self._scratch[kind]
        if not WHY_PLAIN:
            place_stand(
                self._placed, self._instances, rows, bank.laid_shapes, records.segments, blocks,
                bases, x, block, out,
            )  # fmt: skip
        for number, first in rows.tolist() if WHY_PLAIN or self._pushed else ():
            if number in self._pushed:
                keys = self._pushed[number].rotations()
            elif WHY_PLAIN:
                keys = bank.rotations_of(self._instances[number : number + 1])
            else:
                continue
            self._place_by_keys(number, keys, out[first : first + len(block)])

    @cached_property
    def _highest(self) -> tuple[int, Tree]:
        """Number of the tree whose tip is the highest, and the tree where it is."""
        tops = self._placed['at'][:, 2] + self._placed['scale'] * self._heights()
        number = int(np.argmax(tops))
        return number, self._scene.trees[number].placed()

    @property
    def tip_displacement(self) -> Floats:
        """Displacement of the highest tip of all from rest in [m], (3,)."""
        number, tree = self._highest
        if number in self._alone:
            return self._alone[number].tip_displacement
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
        for simulator in self._alone.values():
            simulator.reset()
        self.gusts.reset()
        self._pushed.clear()
        self.wind[:] = 0.0

    def _speeds(self) -> Floats:
        """Wind of each tree over that of its kind, (t,)."""
        profile, scale = (
            self.settings.profile,
            np.array([each.scale for each in self._scene.trees]),
        )
        crown = profile.ground + _CROWN * self._heights() * np.array([np.ones(len(scale)), scale])
        own, scaled = profile.over_anemometer(crown)
        return np.where(own > 0.0, scaled / np.where(own > 0.0, own, 1.0), 1.0)

    def _heights(self) -> Floats:
        """Heights of the trees' kinds in [m], (t,)."""
        return np.array([each.tree.height for each in self._scene.kinds])[self._scene.kind_numbers]

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


def _turned(yaw: float) -> Floats:
    """Rotation from the world to a tree that is turned about the vertical [rad], (3, 3)."""
    c, s = math.cos(yaw), math.sin(yaw)
    return np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])


def _oscillators(model: SwaySimulator) -> WindBasisBank:
    oscillators = model.banks[0].oscillators
    assert isinstance(oscillators, WindBasisBank)
    return oscillators
