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
from dataclasses import replace
from functools import cached_property
from typing import Any, TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import array_to_fill, array_to_read, refuse_time_step, three_numbers
from tree_sway.core.model import ModelCache, PREPARED, SwayModel
from tree_sway.core.native import NotCopied
from tree_sway.core.run import (
    Bank,
    Counts,
    Outcome,
    rows_of_tree,
    SwaySimulator,
    TreeGroup,
    Tuning,
)
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.scene.placed_trees import PlacedTrees
from tree_sway.core.scene.placement_records import kind_heights
from tree_sway.core.scene.shared_tables import SharedTables
from tree_sway.core.scene.sharing import sharing_of
from tree_sway.core.settings import Settings
from tree_sway.core.tree import ends_of_poses, Tree
from tree_sway.core.tree_state import (
    digest_of,
    fill_memory,
    refuse_other_state,
    TreeState,
    values_of,
)
from tree_sway.core.wind import is_wind
from tree_sway.core.wind.gusts import GustHistory
from tree_sway.errors import inside, ParameterError

if TYPE_CHECKING:
    from tree_sway.core.run import Spring, Touch


class SceneSimulator(NotCopied):
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
        self._scene = scene
        self.settings = settings
        self.names = tuple(each.name for each in scene.trees)
        self._sharing = sharing_of(scene, settings)
        self._shared = SharedTables(scene, self._sharing, settings, cache=cache, progress=progress)
        self._alone: dict[int, SwaySimulator] = {}
        """Simulators of the trees that share no table, by their numbers."""
        for number in self._sharing.alone.tolist():
            tree = scene.trees[number]
            with inside(tree.name):
                self._alone[number] = make_simulator(
                    tree.placed(),
                    tree.species,
                    scene.settings_of(number, settings),
                    tolerance=tolerance,
                    cache=cache,
                )
            progress(len(self._shared.kinds) + len(self._alone))
        sizes = np.array([each.tree.n_segments for each in scene.kinds])
        self._ends = np.concatenate([[0], np.cumsum(sizes[scene.kind_numbers])])
        """First row of each tree in the pose block, and the end of the last, (t + 1,)."""
        self.gusts = GustHistory(
            self._shared.placements.places[:, :3],
            scene.anemometer,
            convection_ratio=scene.convection_ratio,
        )
        self._counts = Counts()
        self.wind = np.zeros(3)
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
        alone = dict.fromkeys(each.model for each in self._alone.values())
        return ', '.join([*self._shared.models, *alone])

    @property
    def counts(self) -> Counts:
        """Return counts of the wind, and of clamped or restarted trees."""
        trees = [self._shared.counts, *(each.counts for each in self._alone.values())]
        return replace(
            self._counts,
            clamped=sum(each.clamped for each in trees),
            reduced=sum(each.reduced for each in trees),
            restarted=sum(each.restarted for each in trees),
        )

    @property
    def wind_told(self) -> str:
        """By which gusts the trees sway, as `Settings.wind_told`; the way is the first tree's."""
        seed = self.settings.gust_seed
        return replace(self._scene.settings_of(0, self.settings), gust_seed=seed).wind_told

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
    def groups(self) -> list[TreeGroup]:
        """Trees that share a table, table by table, then each of the others."""
        alone = [
            each.groups[0]._replace(numbers=np.array([number]))
            for number, each in self._alone.items()
        ]
        return self._shared.groups + alone

    @property
    def models(self) -> tuple[SwayModel, ...]:
        """Prepared models of the shared tables, then of the other trees."""
        return tuple(each.models[0] for each in self._kinds_and_alone)

    @property
    def banks(self) -> tuple[Bank, ...]:
        """Records and oscillators, as `models`."""
        return tuple(each.banks[0] for each in self._kinds_and_alone)

    @property
    def _kinds_and_alone(self) -> tuple[SwaySimulator, ...]:
        return *self._shared.kinds, *self._alone.values()

    @property
    def mass(self) -> float:
        """Mass of wood and leaves of all trees in [kg]."""
        return self._shared.mass + sum(each.mass for each in self._alone.values())

    @property
    def places(self) -> Floats:
        """
        Place of each tree, (t, 5): x y z of its root node [m], its turn [rad], its scale.

        The records of a tree that shares no table are at its place: it has no turn and scale.
        """
        trees = self._scene.trees
        places = np.array([(each.x, each.y, each.z, each.yaw, each.scale) for each in trees])
        for number, one in self._alone.items():
            places[number] = one.places[0]
        return places

    @property
    def speeds(self) -> Floats:
        """Wind of each tree over that of its kind, (t,)."""
        return self._shared.placements.speeds.copy()

    def frequencies(self, count: int = 10) -> Floats:
        """Lowest natural frequencies of all trees, as `SwaySimulator.frequencies`."""
        alone = [each.frequencies(count) for each in self._alone.values()]
        found = np.concatenate([*alone, *self._shared.frequencies(count)])
        return np.sort(found)[: int(count)]

    def digest(self) -> str:
        """Digest of trees, places, settings and tuning."""
        trees = [*self._shared.digests(), *(each.digest() for each in self._alone.values())]
        sharing = self._sharing.tables, self._sharing.counts
        return digest_of(trees, self.settings, self.places, *sharing)

    def _memory(self) -> tuple[NDArray[Any], ...]:
        """Return views of the wind, and of the trees on shared tables."""
        return self.wind, *self.gusts.memory(), *self._shared.memory()

    def state(self) -> TreeState:
        """Return a copy of the state of all trees, and of the wind of the last minute."""
        asked = ' '.join(map(str, self._sharing.counts.tolist()))
        alone = [each.state().values for each in self._alone.values()]
        values = np.concatenate([values_of(self._memory()), *alone])
        return TreeState(self.name, self.digest(), asked, values)

    def set_state(self, state: TreeState) -> None:
        """Continue from a state, as `SwaySimulator.set_state`."""
        refuse_other_state(state, self.state())
        shared = self._memory()
        fill_memory(shared, state.values)
        first = sum(array.size for array in shared)
        for each in self._alone.values():
            own = each.state()
            last = first + len(own.values)
            each.set_state(replace(own, values=state.values[first:last]))
            first = last
        self._shared.refresh()

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
            A step that is not above 0, or longer than `LONGEST_STEP`.

        """
        refuse_time_step(dt)
        status = Outcome.OK
        # The history must not contain winds that the trees refuse.
        wind = three_numbers('wind', wind_mean)
        if is_wind(*wind, self.settings.max_wind):
            self.wind[:] = wind
        else:
            status = Outcome.WIND_REFUSED
            self._counts.refused += 1
        self._counts.steps += 1
        winds = self.gusts.push(self.wind, dt)
        is_clamped, has_restarted = self._shared.step(winds, dt)
        status |= Outcome.LOAD_CLAMPED if is_clamped else Outcome.OK
        status |= Outcome.RESTARTED if has_restarted else Outcome.OK
        is_far = self.settings.is_far  # such a tree knows by itself how late gusts are
        for number, simulator in self._alone.items():
            status |= simulator.step((self.wind if is_far else winds[number]).tolist(), dt)
        return status

    def push(
        self, segment: int, force: ArrayLike | Spring, seconds: float, *, along: float = 0.5
    ) -> None:
        """Push or pull at a segment by its row in the pose block, as `SwaySimulator.push`."""
        from tree_sway.core.run import MOST_PUSHES, row_of

        try:
            row = row_of(segment, int(self._ends[-1]))
            number = int(self._ends.searchsorted(row, 'right')) - 1
            active = {t for t, touch in self.pushed.items() if touch.pushes}
            if len(active | {number}) > MOST_PUSHES:
                raise ParameterError(f'more than {MOST_PUSHES} trees at once', where='push')
            own_row = row - int(self._ends[number])
            if number in self._alone:
                self._alone[number].push(own_row, force, seconds, along=along)
            else:
                self._shared.push(number, own_row, force, seconds, along)
        except ParameterError:
            self._counts.refused_pushes += 1
            raise

    @property
    def pushed(self) -> dict[int, Touch]:
        """Pushes on trees by their numbers, until their effect is gone."""
        alone = self._alone.items()
        own = {number: touch for number, one in alone for touch in one.pushed.values()}
        return self._shared.pushed | own

    @property
    def push_load(self) -> Floats:
        """
        Load of the last step's pushes on each tree, (t, 6).

        Force [N] and moment about its root node [N m].
        """
        loads = np.zeros((len(self.names), 6))
        for number in self._shared.pushed:
            loads[number] = self._shared.push_load(number)
        for number, one in self._alone.items():
            loads[number] = one.push_load
        return loads

    @property
    def wind_moment(self) -> Floats:
        """Moment of the last step's wind on each tree about its root node, [N m], (t, 3)."""
        moments = np.zeros((len(self.names), 3))
        for number in range(len(moments)):
            alone = self._alone.get(number)
            moments[number] = (
                self._shared.wind_moment(number) if alone is None else alone.wind_moment
            )
        return moments

    def check_tuning(self, **changes: float) -> Tuning:
        """Check changes for all trees, as `SwaySimulator.check_tuning`."""
        shared = self._shared.check_tuning(**changes)
        alone = [each.check_tuning(**changes) for each in self._alone.values()]
        return (shared + alone)[-1]

    def tune(self, **changes: float) -> None:
        """Change every tree while it sways, as `SwaySimulator.tune`; all or none."""
        self.check_tuning(**changes)
        self._shared.tune(**changes)
        for each in self._alone.values():
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
        poses = self._to_fill(out)
        self._shared.place(self._ends, poses)
        for number, simulator in self._alone.items():
            simulator.place(self._rows(number, poses))
        return poses

    def _to_fill(self, out: Floats | None) -> Floats:
        shape = int(self._ends[-1]), 7
        return np.zeros(shape) if out is None else array_to_fill('out', out, shape)

    def _rows(self, number: int, poses: Floats) -> Floats:
        """Return the part of a tree in a pose block."""
        return poses[self._ends[number] : self._ends[number + 1]]

    def rotations(self) -> Floats:
        """Key rotations of all trees in [rad], one tree after another, (N,)."""
        found = []
        for number in range(len(self.names)):
            one = self._alone.get(number) or self._shared.tree(number)
            found.append(one.rotations().copy())
        return np.concatenate(found)

    def place_rotations(self, rotations: Floats, out: Floats | None = None) -> Floats:
        """Place every segment by key rotations (N,), as `SwaySimulator.place_rotations`."""
        sizes = [self._n_keys(number) for number in range(len(self.names))]
        read = array_to_read('rotations', rotations, (sum(sizes),))
        poses = self._to_fill(out)
        first = 0
        for number, size in enumerate(sizes):
            keys = read[first : first + size]
            rows = self._rows(number, poses)
            if number in self._alone:
                self._alone[number].place_rotations(keys, rows)
            else:
                self._shared.place_rotations(number, keys, rows)
            first += size
        return poses

    def _n_keys(self, number: int) -> int:
        alone = self._alone.get(number)
        return self._shared.n_keys(number) if alone is None else alone.models[0].n_keys

    @cached_property
    def _highest(self) -> tuple[int, Tree]:
        """Number of the tree whose tip is the highest, and the tree where it is."""
        places = self._shared.placements.places
        tops = places[:, 2] + places[:, 4] * kind_heights(self._scene)
        number = int(np.argmax(tops))
        return number, self._scene.trees[number].placed()

    @property
    def tip_displacement(self) -> Floats:
        """Displacement of the highest tip of all from rest in [m], (3,)."""
        number, tree = self._highest
        if number in self._alone:
            return self._alone[number].tip_displacement
        top = int(np.argmax(tree.end[:, 2]))
        poses = np.empty((tree.n_segments, 7))
        self._shared.place_tree(number, poses)
        return np.asarray(ends_of_poses(poses, tree.length)[1][top] - tree.end[top])

    def reset(self) -> None:
        """Bring every tree to rest and forget the wind; the counts stay."""
        self._shared.reset()
        for simulator in self._alone.values():
            simulator.reset()
        self.gusts.reset()
        self.wind[:] = 0.0


Simulator: TypeAlias = SwaySimulator | SceneSimulator
"""Simulator of a tree on any model, or of the trees of a scene, with the same interface."""
