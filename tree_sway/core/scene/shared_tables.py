# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The trees of a scene that share the tables of their kinds, solved in one call."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
import math
from typing import Any, TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.model import ModelCache, StateBasis
from tree_sway.core.native import NativeStand
from tree_sway.core.run import (
    Bank,
    bent_too_far,
    ClampWatch,
    come_to_rest,
    Counts,
    fewer,
    LiveTuning,
    Motion,
    STATE_FIELDS,
    SwaySimulator,
    TableOscillators,
    TreeGroup,
    Tuning,
)
from tree_sway.core.scene.kind_frame import KindFrame
from tree_sway.core.scene.placed_trees import PlacedTrees
from tree_sway.core.scene.placement_records import own_step, placements_of
from tree_sway.core.scene.sharing import Sharing
from tree_sway.core.scene.tree_on_table import TreeOnTable
from tree_sway.core.settings import Settings
from tree_sway.core.setup import prepare
from tree_sway.core.tree_state import digest_of
from tree_sway.errors import inside

if TYPE_CHECKING:
    from tree_sway.core.run import Spring, Touch


class SharedTables:
    """
    Trees on shared tables: a state, a place, a scale and a table each.

    Parameters
    ----------
    scene
        All trees; those on models of their own keep a record here that is never solved.
    sharing
        Which of them are on which table.
    settings
        Settings of the trees, except values that a tree has itself.
    cache
        Where prepared models are found again; nowhere if None.
    progress
        Called with the number of tables that are made.

    Raises
    ------
    TreeSwayError
        Error of a kind, with the name of its first tree.

    """

    def __init__(
        self,
        scene: PlacedTrees,
        sharing: Sharing,
        settings: Settings,
        *,
        cache: ModelCache | None,
        progress: Callable[[int], object],
    ) -> None:
        """Prepare every kind that has a table."""
        self._scene = scene
        self._sharing = sharing
        self.kinds: list[SwaySimulator] = []
        """Simulators of the kinds in their own frames; they are not stepped."""
        for row, number in enumerate(sharing.kinds.tolist()):
            kind = scene.kinds[number]
            first = int(sharing.trees_on(row)[0])
            with inside(scene.trees[first].name):
                chosen = replace(kind.settings(settings), model=sharing.size_of(row))
                prepared = prepare(kind.tree, kind.species, chosen, cache=cache)
                self.kinds.append(SwaySimulator(prepared.by_table()))
            progress(len(self.kinds))
        self.counts = Counts()
        """Counts of clamped, reduced and restarted trees."""
        self._oscillators = [_table_of(kind.banks[0]) for kind in self.kinds]
        self._trees_on = [sharing.trees_on(row) for row in range(len(self.kinds))]
        self.placements = placements_of(scene, settings.profile)
        """Where the trees stand."""
        self._counted = sharing.counts.copy()
        """Numbers of coordinates that the trees show, (t,); -1 on models of their own."""
        self._stand: NativeStand | None = None
        self._ends: Ints | None = None
        """First rows of the trees in the last pose block, which `_rows` are of."""
        self._rows = np.zeros((0, 2), dtype=np.int64)
        if self.kinds:
            models = [kind.banks[0].stand.models[0] for kind in self.kinds]
            self._kind_numbers = np.maximum(sharing.tables, 0)
            self._stand = NativeStand(models, self._kind_numbers, *self.placements)
        self._tunings = [
            LiveTuning(bank.tunable, kind.settings, kind.models[0].damping_ratio)
            for kind, bank in zip(self.kinds, self._oscillators, strict=True)
        ]
        self._watches: dict[int, ClampWatch] = {}
        self._pushed: dict[int, TreeOnTable] = {}
        self._dt = math.nan
        self._show()

    @property
    def stand(self) -> NativeStand:
        """Return the native stand of all trees, those on models of their own at rest."""
        assert self._stand is not None
        return self._stand

    @property
    def models(self) -> list[str]:
        """Return the numbers of coordinates in use, as words."""
        return np.unique(self._counted[self._sharing.is_shared]).astype(str).tolist()

    @property
    def groups(self) -> list[TreeGroup]:
        """Return the trees on each table."""
        return [
            TreeGroup(kind, trees, partial(self._in_basis, oscillators, trees))
            for kind, oscillators, trees in self._by_table()
        ]

    def _by_table(self) -> list[tuple[SwaySimulator, TableOscillators, Ints]]:
        """Return the kind of each table, the table, and the numbers of its trees."""
        return list(zip(self.kinds, self._oscillators, self._trees_on, strict=True))

    def _in_basis(self, oscillators: TableOscillators, trees: Ints, basis: StateBasis) -> Motion:
        """Return a function that finds the motion of trees of one kind in a basis, (t, m)."""
        per_shape = oscillators.all_shapes @ basis.projection.T
        n_modes = oscillators.shapes.shape[1]

        def found() -> Floats:
            is_shown = np.arange(n_modes) < self._counted[trees, None]
            shown = np.where(is_shown, self.stand.states.eta[trees, :n_modes], 0.0)
            return np.asarray(shown @ per_shape)

        return found

    @property
    def mass(self) -> float:
        """Mass of wood and leaves of these trees in [kg]."""
        masses = [
            kind.mass * float((self.placements.places[trees, 4] ** 3).sum())
            for kind, _, trees in self._by_table()
        ]
        return sum(masses)

    def frequencies(self, count: int) -> list[Floats]:
        """Return the lowest natural frequencies of the trees of each table in [Hz]."""
        return [
            (kind.frequencies(count) / self.placements.places[trees, 4, None]).ravel()
            for kind, _, trees in self._by_table()
        ]

    def digests(self) -> list[str]:
        """Return a digest of each kind with its tuning."""
        pairs = zip(self.kinds, self._tunings, strict=True)
        return [digest_of(kind.digest(), *tuning.changes) for kind, tuning in pairs]

    def memory(self) -> tuple[NDArray[Any], ...]:
        """Return views of the states of the trees."""
        if self._stand is None:
            return (self._counted,)
        states = self._stand.states
        return *(getattr(states, name) for name in STATE_FIELDS), self._counted

    def refresh(self) -> None:
        """Follow a state that was written to the memory."""
        self._show()
        self._dt = math.nan

    def reset(self) -> None:
        """Bring every tree to rest; the counts stay."""
        if self._stand is not None:
            self._stand.reset()
        self._counted[:] = self._sharing.counts
        self._watches.clear()
        self._pushed.clear()
        self.refresh()

    def _show(self) -> None:
        """Hide the coordinates of the table that a tree does not have; let others rest."""
        if self._stand is None:
            return
        states = self._stand.states
        sizes = np.array([table.shapes.shape[1] for table in self._oscillators])
        size = sizes[self._kind_numbers]
        states.left_out[:] = np.maximum(size - np.maximum(self._counted, 0), 0)
        is_still = ~self._sharing.is_shared | (self._sharing.counts == 0)
        is_reduced = self._counted < self._sharing.counts
        states.at_rest[:] = np.where(is_still, size, np.where(is_reduced, states.left_out, 0.0))

    def step(self, winds: Floats, dt: float) -> tuple[bool, bool]:
        """
        Advance one step of dt [s] in the wind at each tree in [m/s], (t, 3).

        Returns whether a load was clamped, and whether a tree continued from rest.
        """
        if not self.kinds:
            return False, False
        has_glided = any([tuning.step(dt) for tuning in self._tunings])
        if dt != self._dt or has_glided:
            self._set_step(dt)
        clamped, restarted = self.stand.step(winds)
        pushed_too_far = self._step_pushes(dt) if self._pushed else 0
        self.counts.steps += 1
        if clamped:
            self._watch_clamped(dt)
        self.counts.clamped += clamped + pushed_too_far
        self.counts.restarted += restarted
        return clamped + pushed_too_far > 0, restarted > 0

    def _set_step(self, dt: float) -> None:
        """Fill the coefficients of every kind and scale."""
        for row, table in enumerate(self._oscillators):
            self.stand.tune(row, table.modal.stiffness, table.modal.damping)
        self.stand.set_step(dt)
        self._dt = dt

    def _watch_clamped(self, dt: float) -> None:
        """Show fewer coordinates of trees whose steps stay clamped, and which no push bends."""
        most = np.array([table.most_pressure for table in self._oscillators])
        is_bent = bent_too_far(self.stand.states, most[self._kind_numbers])
        for number in np.flatnonzero(is_bent).tolist():
            watch = self._watches.setdefault(number, ClampWatch())
            if number in self._pushed or not watch.is_stuck(self.counts.steps, dt):
                continue
            oscillators = self._oscillators[self._kind_numbers[number]]
            before = min(int(self._counted[number]), oscillators.shapes.shape[1])
            count = fewer(before)
            if count < before:
                self._counted[number] = count
                self.counts.reduced += 1
                come_to_rest(self.stand.states, number)
                self.refresh()  # it has a step of its own from now on

    def check_tuning(self, **changes: float) -> list[Tuning]:
        """Check changes for all kinds, as `SwaySimulator.check_tuning`."""
        return [tuning.changed(**changes) for tuning in self._tunings]

    def tune(self, **changes: float) -> None:
        """Change every kind while it sways, as `SwaySimulator.tune`."""
        for tuning, goal in zip(self._tunings, self.check_tuning(**changes), strict=True):
            tuning.go_to(goal)

    def tree(self, number: int) -> TreeOnTable:
        """Return a tree by its number; its state is a view."""
        found = self._pushed.get(number)
        if found is not None:
            return found
        kind = self._kind_of(number)
        table = self._oscillators[self._kind_numbers[number]]
        return TreeOnTable(kind.tree, kind.banks[0], table.of_tree(self.stand, number))

    def _kind_of(self, number: int) -> SwaySimulator:
        return self.kinds[int(self._kind_numbers[number])]

    def n_keys(self, number: int) -> int:
        """Return the number of key rotations of a tree."""
        return self._kind_of(number).models[0].n_keys

    def wind_moment(self, number: int) -> Floats:
        """Moment of the last step's wind on a tree about its root node, [N m], (3,)."""
        moment = self.tree(number).bank.wind_moment()
        return self._frame(number).to_tree(np.zeros(3), moment)[1]

    def _frame(self, number: int) -> KindFrame:
        return KindFrame(self._scene.trees[number])

    def push(
        self, number: int, segment: int, force: ArrayLike | Spring, seconds: float, along: float
    ) -> None:
        """Push or pull at a segment of a tree, as `SwaySimulator.push`."""
        tree = self.tree(number)
        tree.touch.add(segment, self._frame(number).to_kind(force), seconds, along)
        self._pushed[number] = tree

    @property
    def pushed(self) -> dict[int, Touch]:
        """Pushes on trees by their numbers, until their effect is gone."""
        return {number: tree.touch for number, tree in self._pushed.items()}

    def push_load(self, number: int) -> Floats:
        """Force [N] and moment [N m] about its root node of the pushes on a tree, (6,)."""
        load = self._pushed[number].touch.load
        return np.concatenate(self._frame(number).to_tree(load[:3], load[3:]))

    def _step_pushes(self, dt: float) -> int:
        """Add the effect of pushes; return the number of trees on which they were clamped."""
        clamped = 0
        for number, tree in list(self._pushed.items()):
            if tree.touch.is_gone:
                del self._pushed[number]
                continue
            own_dt = own_step(self._scene.trees[number].scale, dt)
            clamped += tree.step_pushes(own_dt, dt)
        return clamped

    def place(self, ends: Ints, out: Floats) -> None:
        """
        Place every tree on a table.

        Parameters
        ----------
        ends
            First row of each tree in the pose block, and the end of the last, (t + 1,).
        out
            Pose block to write, (n, 7).

        """
        if not self.kinds:
            return
        if ends is not self._ends:
            # Those of a kind one after another: its arrays stay in the caches.
            trees = np.concatenate(self._trees_on)
            self._ends, self._rows = ends, np.stack([trees, ends[trees]], axis=1)
        self._place_rows(self._rows, out)

    def place_tree(self, number: int, out: Floats) -> None:
        """Place a tree in a pose block of its own."""
        self._place_rows(np.array([[number, 0]]), out)

    def _place_rows(self, rows: Ints, out: Floats) -> None:
        """Place trees: their numbers and first rows in a pose block, (w, 2)."""
        self.stand.place(rows, out)
        for number, first in rows.tolist() if self._pushed else ():
            if number in self._pushed:
                own = out[first : first + self._kind_of(number).tree.n_segments]
                self.place_rotations(number, self._pushed[number].rotations(), own)

    def place_rotations(self, number: int, rotations: Floats, out: Floats) -> None:
        """Place a tree by its key rotations (N,) in [rad], in its part of a pose block."""
        self.stand.place_keys(number, np.ascontiguousarray(rotations), out)


def _table_of(bank: Bank) -> TableOscillators:
    oscillators = bank.oscillators
    assert isinstance(oscillators, TableOscillators)
    return oscillators
