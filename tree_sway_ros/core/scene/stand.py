# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A stand: thousands of trees of a few kinds in one wind.

Trees of one kind share its model, tables and rest geometry: a tree is a state, a pose, a scale and
the delay with which gusts reach it. All are solved in one call, on the model `wind_basis`, and
placed only where asked for. A tree may stand still, or be solved on a model of its own.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import cached_property
import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tree_sway_ros.core.arrays import Floats, Ints
from tree_sway_ros.core.checks import array_to_fill, within
from tree_sway_ros.core.motion.harmonics import COUNT
from tree_sway_ros.core.motion.placing import place_standing_at
from tree_sway_ros.core.motion.records import zeros_in_lines
from tree_sway_ros.core.motion.standing import find_rests, place_standing, STANDING, step_standing
from tree_sway_ros.core.motion.wind_basis import (
    CARRIED,
    expand_one,
    fill_pace,
    instance_layout,
    WindBasisBank,
)
from tree_sway_ros.core.motion.wind_basis_force import pace_layout
from tree_sway_ros.core.scene.make import make_simulator
from tree_sway_ros.core.scene.placed_tree import joined, PlacedTree, refuse_nowhere
from tree_sway_ros.core.simulator.assembly import Kept
from tree_sway_ros.core.simulator.live_tuning import Tuning
from tree_sway_ros.core.simulator.protocol import TreeSimulator
from tree_sway_ros.core.simulator.settings import Settings, settings_with
from tree_sway_ros.core.simulator.simulator import (
    Counts,
    LOAD_HELD,
    OK,
    refuse_time_step,
    RESTARTED,
    SwaySimulator,
    WIND_REFUSED,
)
from tree_sway_ros.core.state.tree_state import digest_of, KeepsState
from tree_sway_ros.core.tree.species import Species, species_named
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.core.wind.gust_travel import GustHistory
from tree_sway_ros.core.wind.limits import take_wind
from tree_sway_ros.errors import ParameterError, TreeSwayError

SMALLEST, LARGEST = 0.2, 5.0
"""Scales that a tree of a kind may have."""

_FINEST_SCALE = 0.01


@dataclass(frozen=True)
class StandTree:
    """
    One tree of a stand.

    Parameters
    ----------
    name
        Its name in the stand.
    kind
        Name of its kind.
    x, y, z
        Where its root node stands in [m].
    scale
        Its height over that of its kind.
    yaw
        How far it is turned about the vertical, counterclockwise seen from above, in [rad].
    fidelity
        ``wind_basis``, ``frozen`` (it stands still), or another of `FIDELITIES`: then it is
        solved on its own.

    Raises
    ------
    ParameterError
        If a number is not finite or the scale is out of its range.

    """

    name: str
    kind: str
    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    scale: float = 1.0
    yaw: float = 0.0
    fidelity: str = 'wind_basis'

    def __post_init__(self) -> None:
        """Refuse what is nowhere."""
        refuse_nowhere(self.name, self.x, self.y, self.z, self.yaw)
        within(f'{self.name}: scale', self.scale, SMALLEST, LARGEST)


@dataclass(frozen=True)
class StandKind:
    """What trees of one kind share: the tree, and its species, by the tree's own if None."""

    tree: Tree
    species: Species | None = None


class Stand(KeepsState):
    """
    Trees of a few kinds that sway in one wind; used like a `SwaySimulator`.

    Parameters
    ----------
    trees
        The trees, each with a name of its own.
    kinds
        What they are, by name.
    settings
        How they are modelled; the model does not matter.
    anemometer, convection_ratio
        As of `Forest`.
    threads
        How many threads place, 1 to 64.
    progress
        Called with the number of kinds that are ready, while the stand is set up.
    kept
        As of `SwaySimulator`.
    **changes
        Fields of the settings, as keywords.

    Raises
    ------
    ParameterError
        No trees, two of one name, an unknown kind, a setting out of its range.
    TreeSwayError
        What is wrong with a kind, under its name.

    Examples
    --------
    >>> trees = [StandTree(f"tree{i}", "oak", x=5.0 * i, scale=0.8 + 0.01 * i) for i in range(40)]
    >>> stand = Stand(trees, {"oak": StandKind(oak)})
    >>> stand.step((8.0, 0.0, 0.0), 1 / 60)
    0

    """

    def __init__(
        self,
        trees: Sequence[StandTree],
        kinds: Mapping[str, StandKind],
        settings: Settings | None = None,
        *,
        anemometer: ArrayLike | None = None,
        convection_ratio: float = 1.0,
        threads: int = 1,
        progress: Callable[[int], object] = lambda done: None,
        kept: Kept | None = None,
        **changes: Any,
    ) -> None:
        """Make a table for every kind that is used."""
        _refuse(trees, kinds)
        self.trees = tuple(trees)
        self.names = tuple(tree.name for tree in trees)
        self.settings = settings_with(settings, changes)
        self.counts = Counts()
        self._used = tuple(dict.fromkeys(tree.kind for tree in trees))
        self._kinds = {name: kinds[name] for name in self._used}
        self._models: list[SwaySimulator] = []
        for done, name in enumerate(self._used, start=1):
            self._models.append(_model_of(name, kinds[name], self.settings, kept))
            progress(done)
        banks: list[WindBasisBank] = [_oscillators(model) for model in self._models]
        self._banks = banks
        self._tables = np.concatenate([bank.record for bank in banks])
        self._laws = np.array([model.drag_law for model in self._models])
        self._standing = np.zeros(len(trees), dtype=STANDING)
        self._fill_standing()
        n_modes = max(bank.shapes.shape[1] for bank in banks)
        layout = instance_layout(n_modes, COUNT[self.settings.degree])
        self._instances = np.zeros(len(trees), dtype=layout)
        self._paces = np.zeros(0, dtype=pace_layout(n_modes))
        self.own = {
            t: _own_simulator(tree, self._kinds[tree.kind], self.settings)
            for t, tree in enumerate(trees)
            if tree.fidelity not in ('wind_basis', 'frozen')
        }
        """Simulators of the trees that are solved on a model of their own, by their numbers."""
        for t in self.own:
            self._standing['is_still'][t] = 1
        sizes = [self._models[k].tree.n_segments for k in self._standing['kind']]
        self._ends = np.cumsum([0, *sizes])
        self.gusts = GustHistory(
            self._standing['at'], anemometer, convection_ratio=convection_ratio
        )
        self._wind, self._dt = np.zeros(3), math.nan
        self._scratch = [self._allocate() for _ in range(int(within('threads', threads, 1, 64)))]
        self._pool = ThreadPoolExecutor(threads - 1, 'placing') if threads > 1 else None

    @property
    def model(self) -> str:
        """Models in use."""
        shared = ['wind_basis'] if not self._standing['is_still'].all() else []
        return ', '.join([*shared, *dict.fromkeys(sim.model for sim in self.own.values())])

    @property
    def simulators(self) -> tuple[TreeSimulator, ...]:
        """Return the simulators of the trees that are solved on a model of their own."""
        return tuple(self.own.values())

    @property
    def n_segments(self) -> int:
        """Segments of all trees, rows of the pose block."""
        return int(self._ends[-1])

    @property
    def n_solved(self) -> int:
        """Branches that are solved, of kinds once for each tree."""
        sizes = np.array([model.n_solved for model in self._models])
        moving = self._standing['is_still'] == 0
        own = sum(sim.n_solved for sim in self.own.values())
        return int(sizes[self._standing['kind'][moving]].sum()) + own

    @property
    def n_copied(self) -> int:
        """Branches that copy the motion of another."""
        return sum(sim.n_copied for sim in self.own.values())

    @property
    def n_frozen(self) -> int:
        """Branches of trees that stand still."""
        return sum(
            self._kinds[tree.kind].tree.n_branches
            for tree in self.trees
            if tree.fidelity == 'frozen'
        )

    @property
    def wind(self) -> Floats:
        """Wind at the anemometer in the last step in [m/s], (3,)."""
        return self._wind

    @cached_property
    def tree(self) -> Tree:  # type: ignore[override]
        """All trees in one record, to be described or drawn."""
        return joined([self.tree_of(t) for t in range(len(self.trees))], 'stand')

    def tree_of(self, number: int) -> Tree:
        """Return a tree scaled, turned, and where it stands."""
        told = self.trees[number]
        return _standing_tree(told, self._kinds[told.kind].tree)

    def segments_of(self, name: str) -> slice:
        """Return the rows of a tree in the pose block, as `Forest.segments_of`."""
        if name not in self.names:
            raise ParameterError(f"no tree is called '{name}'", where='stand')
        number = self.names.index(name)
        return slice(int(self._ends[number]), int(self._ends[number + 1]))

    def step(self, wind_mean: ArrayLike, dt: float) -> int:
        """Advance one step, as `Forest.step`; a wind beyond a table is held at its limit."""
        status = OK
        if not take_wind(self._wind, wind_mean, self.settings.max_wind):
            status = WIND_REFUSED
            self.counts.refused += 1
        if dt != self._dt:
            self._set_step(dt)
        felt = self.gusts.push(self._wind, dt)
        held, restarted = step_standing(
            self._tables, self._paces, self._standing, self._instances, self._laws, felt
        )
        for number, simulator in self.own.items():
            status |= simulator.step(felt[number].tolist(), dt)
        self.counts.steps += 1
        self.counts.held += held
        self.counts.restarted += restarted
        return status | (LOAD_HELD if held else OK) | (RESTARTED if restarted else OK)

    def check_tuning(self, **changes: float) -> Tuning:
        """Refuse: trees of a stand share what they are made of."""
        raise ParameterError(
            f'a change of {", ".join(changes)} in a stand', where='tune', cure='make it anew'
        )

    def tune(self, **changes: float) -> None:
        """Refuse, as `check_tuning`."""
        self.check_tuning(**changes)

    def place(self, out: Floats | None = None, which: ArrayLike | None = None) -> Floats:
        """
        Place every segment of every tree, or of some trees.

        Parameters
        ----------
        out
            Where to write, (n, 7) float64, to be fast; a new array if None.
        which
            Numbers of the trees to place; all if None. Rows of the others stay as they are.

        Returns
        -------
        Floats
            Pose block of all trees, one after another; see `SwaySimulator.place`.

        Raises
        ------
        ParameterError
            An array that cannot hold the poses, or a tree that is not there.

        """
        shape = (self.n_segments, 7)
        poses = np.zeros(shape) if out is None else array_to_fill('out', out, shape)
        shares = [np.array_split(rows, len(self._scratch)) for rows in self._rows(which)]
        others = [
            self._pool.submit(self._place, poses, shares, thread)  # type: ignore[union-attr]
            for thread in range(1, len(self._scratch))
        ]
        self._place(poses, shares, 0)
        for other in others:
            other.result()
        wanted = None if which is None else set(np.atleast_1d(which).tolist())
        for number, simulator in self.own.items():
            if wanted is None or number in wanted:
                simulator.place(poses[self._ends[number] : self._ends[number + 1]])
        return poses

    def _place(self, poses: Floats, shares: list[list[Ints]], thread: int) -> None:
        """Place a thread's share of the trees of each kind."""
        for kind, share in enumerate(shares):
            if len(share[thread]):
                bank, records = self._banks[kind], self._models[kind].bank
                heads, bases, x, block = self._scratch[thread][kind]
                place_standing(
                    self._tables, self._standing, self._instances, share[thread], bank.laid_shapes,
                    records.branches, records.segments, heads, bases, x, block, poses,
                )  # fmt: skip

    def _allocate(self) -> list[tuple[Any, Any, Floats, Floats]]:
        """Make what placing works in, of each kind."""
        scratch = []
        for model, bank in zip(self._models, self._banks, strict=True):
            heads = zeros_in_lines(len(model.bank.heads), model.bank.heads.dtype)
            heads[:] = model.bank.heads
            block = np.zeros((model.tree.n_segments, 7))
            bases = np.zeros_like(model.bank.bases)
            scratch.append((heads, bases, bank.room_for_rotations(), block))
        return scratch

    @property
    def held(self) -> tuple[str, ...]:
        """Names of the trees whose wind was held at the limit of their table in the last step."""
        return tuple(self.names[t] for t in np.flatnonzero(self._standing['is_held']))

    @property
    def told_as(self) -> str:
        """Name that its states bear."""
        return 'stand'

    def digest(self) -> str:
        """Digest of all trees, what they are, and how they are modelled."""
        kinds = [each for model in self._models for each in (model.tree, model.species)]
        return digest_of(*kinds, *self.trees, self.settings)

    def memory(self) -> tuple[Any, ...]:
        """Return views of what is carried from one step to the next, the wind first."""
        carried = (self._instances[name] for name in CARRIED)
        own = (array for simulator in self.own.values() for array in _memory_of(simulator))
        return self._wind, *self.gusts.memory(), *carried, *own

    def rotations(self) -> Floats:
        """Key rotations of all trees, one after another, in [rad], (N,)."""
        return np.concatenate([self._rotations(number) for number in range(len(self.trees))])

    @property
    def shared(self) -> list[tuple[SwaySimulator, Ints]]:
        """Each model, in a frame of its own, and the numbers of the trees that share it."""
        is_shared = np.ones(len(self.trees), dtype=bool)
        is_shared[list(self.own)] = False
        found = [
            (model, np.flatnonzero(is_shared & (self._standing['kind'] == kind)))
            for kind, model in enumerate(self._models)
        ]
        return [(model, numbers) for model, numbers in found if len(numbers)]

    def shares(self, numbers: Ints) -> Floats:
        """How much trees of one kind bend in each shape of their table, (t, m + r)."""
        find_rests(self._tables, self._standing, self._instances, numbers)
        n_modes = self._banks[self._standing['kind'][numbers[0]]].shapes.shape[1]
        eta, rest = self._instances['eta'], self._instances['rest']
        return np.hstack([eta[numbers, :n_modes], rest[numbers]])

    def _rotations(self, number: int) -> Floats:
        """Key rotations of a tree in [rad], (N,)."""
        if number in self.own:
            return self.own[number].rotations()
        bank, here = self._banks[self._standing['kind'][number]], slice(number, number + 1)
        found = bank.room_for_rotations()
        expand_one(bank.record, self._instances[here], bank.laid_shapes, found)
        return found[: len(bank.shapes)]

    def place_rotations(self, rotations: Floats, out: Floats | None = None) -> Floats:
        """Place every segment by key rotations (N,), (n, 7); a new array if out is None."""
        shape = (self.n_segments, 7)
        poses = np.empty(shape) if out is None else array_to_fill('out', out, shape)
        first = 0
        for number, here in enumerate(self._standing):
            rows = poses[self._ends[number] : self._ends[number + 1]]
            kind = int(here['kind'])
            own, records = self.own.get(number), self._models[kind].bank
            size = len(own.rotations() if own else self._banks[kind].shapes)
            x, first = rotations[first : first + size], first + size
            if own:
                own.place_rotations(x, rows)
                continue
            heads, bases = self._scratch[0][kind][:2]
            east, north, up = here['at'].tolist()
            place_standing_at(
                records.branches, records.segments, heads, bases, x, east, north, up,
                float(here['cosine']), float(here['sine']), float(here['scale']), rows,
            )  # fmt: skip
        return poses

    @property
    def tip_displacement(self) -> Floats:
        """Displacement of the highest tip of all from rest in [m], (3,)."""
        heights = [
            tree.z + tree.scale * float(np.ptp(self._kinds[tree.kind].tree.end[:, 2]))
            for tree in self.trees
        ]
        number = int(np.argmax(heights))
        tree = self.tree_of(number)
        top = int(np.argmax(tree.end[:, 2]))
        row = int(self._ends[number]) + top
        x, y, z, qx, qy, qz, qw = self.place(which=[number])[row]
        along = np.array(
            [1 - 2 * (qy * qy + qz * qz), 2 * (qx * qy + qz * qw), 2 * (qx * qz - qy * qw)]
        )
        moved: Floats = np.array([x, y, z]) + tree.length[top] * along - tree.end[top]
        return moved

    def reset(self) -> None:
        """Bring every tree to rest and forget the wind; the counts stay."""
        self._instances[:] = np.zeros((), dtype=self._instances.dtype)
        for simulator in self.own.values():
            simulator.reset()
        self.gusts.reset()
        self._wind[:] = 0.0

    def _rows(self, which: ArrayLike | None) -> list[Ints]:
        """Trees to place of each kind that stand on its table, with their first rows, (w, 2)."""
        n = len(self.trees)
        numbers = np.arange(n) if which is None else np.unique(np.asarray(which, dtype=np.int64))
        if len(numbers) and not 0 <= numbers[0] <= numbers[-1] < n:
            raise ParameterError(
                f'tree {numbers[-1]} of a stand of {n}', where='which', cure=f'give 0 to {n - 1}'
            )
        shared = np.array([t for t in numbers.tolist() if t not in self.own], dtype=np.int64)
        kinds = self._standing['kind'][shared]
        return [
            np.ascontiguousarray(np.stack([here, self._ends[here]], axis=1))
            for here in (shared[kinds == kind] for kind in range(len(self._used)))
        ]

    def _fill_standing(self) -> None:
        heights = {name: float(np.ptp(kind.tree.end[:, 2])) for name, kind in self._kinds.items()}
        profile = self.settings.profile
        for row, tree in zip(self._standing, self.trees, strict=True):
            row['kind'] = self._used.index(tree.kind)
            row['is_still'] = tree.fidelity == 'frozen'
            row['scale'], row['at'] = tree.scale, (tree.x, tree.y, tree.z)
            row['cosine'], row['sine'] = math.cos(0.5 * tree.yaw), math.sin(0.5 * tree.yaw)
            crown = profile.ground + _CROWN * heights[tree.kind] * np.array([1.0, tree.scale])
            own, scaled = profile.over_anemometer(crown)
            row['speed'] = scaled / own if own > 0.0 else 1.0

    def _set_step(self, dt: float) -> None:
        """Fill a pace for every kind and scale that there is, to a hundredth."""
        refuse_time_step(dt)
        scale = np.round(np.log(self._standing['scale']) / _FINEST_SCALE).astype(np.int64)
        told = np.stack([self._standing['kind'], scale], axis=1)
        found, rows = np.unique(told, axis=0, return_inverse=True)
        self._paces = np.zeros(len(found), dtype=self._paces.dtype)
        for pace, (kind, step) in zip(self._paces, found.tolist(), strict=True):
            modal = self._banks[kind].modal
            modal.set_pace(dt / math.exp(step * _FINEST_SCALE))
            fill_pace(pace, modal)
        self._standing['pace'] = rows.ravel()
        self._dt = dt


_CROWN = 0.7


def _refuse(trees: Sequence[StandTree], kinds: Mapping[str, StandKind]) -> None:
    """Refuse no trees, two of one name, and kinds that are not there."""
    if not trees:
        raise ParameterError('no trees', where='stand', cure='give at least one')
    name, count = Counter(tree.name for tree in trees).most_common(1)[0]
    if count > 1:
        raise ParameterError(
            f"{count} trees called '{name}'", where='stand', cure='name each, or none'
        )
    for tree in trees:
        if tree.kind not in kinds:
            raise ParameterError(
                f"unknown kind '{tree.kind}'",
                where=tree.name,
                cure=f'use one of: {", ".join(kinds)}',
            )


def _oscillators(model: SwaySimulator) -> WindBasisBank:
    oscillators = model.bank.oscillators
    assert isinstance(oscillators, WindBasisBank)
    return oscillators


def _model_of(name: str, kind: StandKind, settings: Settings, kept: Kept | None) -> SwaySimulator:
    """Make the model that trees of a kind share; what is wrong with it names the kind."""
    try:
        species = kind.species if kind.species is not None else species_named(kind.tree.species)
        return SwaySimulator(kind.tree, species, replace(settings, model='wind_basis'), kept=kept)
    except TreeSwayError as error:
        raise error.inside(name) from error


def _memory_of(simulator: Any) -> tuple[Floats, ...]:
    memory: tuple[Floats, ...] = simulator.memory()
    return memory


def scaled_tree(tree: Tree, scale: float) -> Tree:
    """Return a tree of another size, its root node where it was."""
    root = tree.start[0]
    return replace(
        tree,
        start=root + scale * (tree.start - root),
        end=root + scale * (tree.end - root),
        base_diameter=scale * tree.base_diameter,
        tip_diameter=scale * tree.tip_diameter,
    )


def _standing_tree(told: StandTree, kind: Tree) -> Tree:
    scaled = scaled_tree(kind, told.scale)
    return PlacedTree(told.name, scaled, told.x, told.y, told.z, told.yaw).placed()


def _own_simulator(told: StandTree, kind: StandKind, settings: Settings) -> TreeSimulator:
    tree = _standing_tree(told, kind.tree)
    species = kind.species if kind.species is not None else species_named(kind.tree.species)
    return make_simulator(tree, species, settings, model=told.fidelity)
