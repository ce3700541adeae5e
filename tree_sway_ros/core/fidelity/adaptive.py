# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A tree that uses no more model than its scene needs, and changes models unseen.

The error and the cost of every model in the wind of the last minute, and in the wind that blows
now, are known beforehand (`ladder`); the cheapest that stays within the tolerance in both is used,
or, where none that can be afforded does, the most accurate of those.

**Up at once.** A load beyond what the model was chosen for is noticed in the step in which it
comes; one beyond all of the last minute is met by the best model that can be afforded, as nothing
is known of it yet. The better model goes on from the motion that is shown, its coordinates mapped
one by one; what the two still differ by fades within 0.4 s.

**Down slowly.** A lesser model first sways along unseen until it has forgotten that it started at
rest, then the picture goes over to it within a second. It is taken only when it would do with a
third to spare, so that a wind on the border does not flicker.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tree_sway_ros.core.arrays import Floats, Ints, Records
from tree_sway_ros.core.checks import array_to_fill, array_to_read
from tree_sway_ros.core.fidelity.estimate import choose, Estimate
from tree_sway_ros.core.fidelity.ladder import FidelityLadder
from tree_sway_ros.core.motion.rotation_fit import coordinates_within
from tree_sway_ros.core.simulator.assembly import Bank
from tree_sway_ros.core.simulator.live_tuning import Tuning
from tree_sway_ros.core.simulator.one_tree import OneTree
from tree_sway_ros.core.simulator.season import in_season
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.core.simulator.simulator import Counts, SwaySimulator, WIND_REFUSED
from tree_sway_ros.core.state.tree_state import digest_of, KeepsState, TreeState
from tree_sway_ros.core.tree.species import Species, species_named
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.core.wind.climate import ClimateTracker, WindClimate
from tree_sway_ros.core.wind.limits import is_wind
from tree_sway_ros.errors import StateError

RUN_IN = 10.0
"""How long a new model sways unseen in [s]."""

CROSS_FADE = 1.0
"""How long the picture takes to go over in [s]."""

HAND_OVER = 0.4
"""How long it takes in [s] until a better model is shown as it is."""

SURPRISE = 1.2
"""Load over the largest that the model was chosen for, at which the choice is looked at again."""

UNFORESEEN = 2.0
"""Load over the largest of the last minute at which the best model is taken that is affordable."""

GUST_MEMORY = 5.0
"""Time in [s] after which a gust counts 1/e."""

REVIEW = 2.0
"""How often the choice is looked at again in [s]."""

_SPARE = 2.0 / 3.0


class AdaptiveSimulator(OneTree, KeepsState):
    """
    A tree on the least model that its scene needs; otherwise as `SwaySimulator`.

    Parameters
    ----------
    tree, species, settings
        As for `SwaySimulator`; the model of the settings does not matter.
    tolerance
        Largest error of the tips in [m], root mean square over time and tips.
    budget
        Largest cost of a step and a placing in [us]; 0 for none.
    expected
        The wind to start for; a fresh breeze of 8 m/s if None.

    """

    def __init__(
        self,
        tree: Tree,
        species: Species | None = None,
        settings: Settings | None = None,
        *,
        tolerance: float = 0.005,
        budget: float = 0.0,
        expected: WindClimate | None = None,
    ) -> None:
        """Judge all models once, and start on the one that the expected wind asks for."""
        self.tree = tree
        self.species = species if species is not None else species_named(tree.species)
        self.settings = in_season(tree, self.species, settings or Settings())
        self.ladder = FidelityLadder(tree, self.species, self.settings)
        self.tolerance, self.budget = tolerance, budget
        self.counts = Counts()
        """Steps, refused winds and held loads since the start, whatever models were in use."""
        self.pace = 1.0
        """Cost here over the cost that the ladder says: set it once it is measured."""
        self._expected = expected or WindClimate.steady(8.0, 0.2)
        self._built: dict[str, SwaySimulator] = {}
        self._among_whole: dict[str, Any] = {}
        self.choice = self._expect()
        for estimate in self.ladder.estimates(WindClimate.steady(0.0, 0.0)):
            self._simulator(estimate)  # now, for a change must not hold up the stream
        self._shown = self._simulator(self.choice)
        self._next: SwaySimulator | None = None
        self._next_age = self._since_review = 0.0
        self._left: SwaySimulator | None = None
        self._behind = 0.0
        self._turns_apart, self._poses_apart = np.zeros(0), np.zeros((tree.n_segments, 7))

    @property
    def model(self) -> str:
        """Model in use."""
        return self._shown.model

    @property
    def n_solved(self) -> int:
        """Branches that the model in use solves."""
        return self._shown.n_solved

    @property
    def n_copied(self) -> int:
        """Branches that copy the motion of another in the model in use."""
        return self._shown.n_copied

    @property
    def n_frozen(self) -> int:
        """Branches that move with their parent as one body in the model in use."""
        return self._shown.n_frozen

    @property
    def wind(self) -> Floats:
        """Wind of the last step in [m/s], (3,)."""
        return self._shown.wind

    @property
    def frame_cost(self) -> float:
        """Return what a step and a placing of the chosen model take on this machine in [us]."""
        return self.pace * self.choice.cost

    @property
    def tip_displacement(self) -> Floats:
        """Displacement of the highest tip from rest in [m], (3,), of the model in use."""
        return self._shown.tip_displacement

    @property
    def shown(self) -> SwaySimulator:
        """Return the simulator whose poses are seen, or fade."""
        return self._shown

    def step(self, wind_mean: ArrayLike, dt: float) -> int:
        """Advance one step, as `SwaySimulator.step`; look at the choice again when it is time."""
        self._feel(wind_mean, dt)
        held = self._shown.counts.held
        status = self._shown.step(wind_mean, dt)
        self.counts.steps += 1
        self.counts.refused += status & WIND_REFUSED
        self.counts.held += self._shown.counts.held - held
        self._tracker.add(self._shown.wind, dt)
        self._behind = max(self._behind - dt / HAND_OVER, 0.0)
        if self._left is not None:
            self._left.step(self._left.wind, dt)  # what changes is for the new model to meet
            self._set_apart(self._left)
        if self._next is not None:
            self._next.step(wind_mean, dt)
            self._next_age += dt
            if self._next_age >= RUN_IN + CROSS_FADE:
                self._shown, self._next = self._next, None
        self._since_review += dt
        if self._since_review >= REVIEW:
            self.review()
        return status

    @cached_property
    def bank(self) -> Bank:
        """Return what places the key rotations of the whole tree, whatever the model in use."""
        return self.ladder.whole.at_rest('coupled')

    @property
    def joints(self) -> Records:
        """Return the records of `BRANCH` by which key rotations are told on any model, (b,)."""
        return self.bank.branches

    def digest(self) -> str:
        """Digest of tree, species and settings."""
        return digest_of(self.tree, self.species, self.settings)

    def rotations(self) -> Floats:
        """Key rotations of the whole tree in [rad], (N,), also between one model and the next."""
        shown = self._whole_rotations(self._shown)
        share = self._faded
        if self._next is not None and share > 0.0:
            shown += share * (self._whole_rotations(self._next) - shown)
        if self._behind > 0.0:
            shown += _smooth(self._behind) * self._turns_apart
        return shown

    def place_rotations(self, rotations: Floats, out: Floats | None = None) -> Floats:
        """Place every segment by key rotations of the whole tree, (n, 7)."""
        shape = (self.tree.n_segments, 7)
        poses = np.empty(shape) if out is None else array_to_fill('out', out, shape)
        expected = self.bank.oscillators.rotations().shape
        rotations = array_to_read('rotations', rotations, expected)
        self.bank.place(rotations, self.tree.start[0], poses)
        return poses

    def state(self) -> TreeState:
        """Return all that the model in use carries from one step to the next."""
        name = self._name_of(self._shown)
        return replace(self._shown.state(), model=name, digest=self.digest())

    def set_state(self, state: TreeState) -> None:
        """Go on from a state, at once on the model that it is of; see `KeepsState.set_state`."""
        simulator = self._built.get(state.model)
        if simulator is None or state.digest != self.digest():
            raise StateError(
                f"a state of tree '{state.tree}', model '{state.model}', settings {state.digest}",
                where=self.tree.name,
                cure=f"this is tree '{self.tree.name}' with settings {self.digest()} and models: "
                + ', '.join(self._built),
            )
        simulator.set_state(replace(state, model=simulator.model, digest=simulator.digest()))
        self._shown, self._next, self._left, self._behind = simulator, None, None, 0.0
        estimates = self.ladder.estimates(self._tracker.climate)
        self.choice = next(each for each in estimates if each.name == state.model)

    def expand(self, state: TreeState, out: Floats | None = None) -> Floats:
        """Poses of a state, (n, 7); the simulator stays as it is."""
        kept = self._shown, self._next, self.choice, self._left, self._behind
        theirs = self._built.get(state.model, self._shown)
        before = theirs.state()
        self.set_state(state)
        rotations = self._whole_rotations(self._shown)
        theirs.set_state(before)
        self._shown, self._next, self.choice, self._left, self._behind = kept
        return self.place_rotations(rotations, out)

    def check_tuning(self, **changes: float) -> Tuning:
        """Refuse what any model could not take, as `SwaySimulator.check_tuning`."""
        return [each.check_tuning(**changes) for each in self._built.values()][-1]

    def tune(self, **changes: float) -> None:
        """Change the tree on every model while it sways, as `SwaySimulator.tune`."""
        self.check_tuning(**changes)
        for each in self._built.values():
            each.tune(**changes)

    def review(self, *, at_best: bool = False) -> Estimate:
        """Choose again once the tolerance has changed; with ``at_best`` whatever the tolerance."""
        self._since_review, self._judged = 0.0, self._gust
        climate = self._tracker.climate
        estimates = self._estimates(climate, self._in_gust(climate))
        wanted = self._choose(estimates, current=self.choice, at_best=at_best)
        now = next(e for e in estimates if e.name == self.choice.name)
        if wanted.name == self.choice.name:
            self.choice = wanted
        elif wanted.error < now.error:
            self._hand_over(wanted)
        elif self._next is None:
            self._next, self._next_age = self._simulator(wanted), 0.0
            self._next.reset()
            self._next.follow_wind(self._shown)
            self.choice = wanted
        return self.choice

    def place(self, out: Floats | None = None) -> Floats:
        """Place every segment, as `SwaySimulator.place`."""
        poses = self._shown.place(out)
        if self._next is not None and self._faded > 0.0:
            _mix(poses, self._next.place(), self._faded)
        if self._behind > 0.0:
            _shift(poses, _smooth(self._behind) * self._poses_apart)
        return poses

    def reset(self) -> None:
        """Go back to rest and to the expected wind, at once on the model that it asks for."""
        self.choice = self._expect()
        self._shown, self._next, self._left = self._simulator(self.choice), None, None
        self._shown.reset()
        self._since_review = self._behind = 0.0

    def _expect(self) -> Estimate:
        """Choose for the wind that is expected."""
        self._tracker = ClimateTracker()
        self._gust, self._bearing = 0.0, (1.0, 0.0)
        self._judged = float(np.linalg.norm(self._expected.mean))
        return self._choose(self.ladder.estimates(self._expected))

    def _feel(self, wind_mean: ArrayLike, dt: float) -> None:
        """Notice, before its step, a load beyond what the model was chosen for."""
        x, y, z = np.asarray(wind_mean, dtype=np.float64).tolist()
        load = x * x + y * y + z * z
        self._gust *= math.exp(-max(dt, 0.0) / GUST_MEMORY)
        if self._gust < load and is_wind(x, y, z, self.settings.max_wind):
            self._gust, self._bearing = load, (x, y)
            if load > SURPRISE * self._judged:
                self.review(at_best=load > UNFORESEEN * self._tracker.largest_load)

    def _in_gust(self, climate: WindClimate) -> WindClimate:
        """Forecast until the next look: the last gust holds on, as unsteady as the last minute."""
        mean = np.array(self._bearing)
        mean *= self._gust / max(float(np.linalg.norm(mean)), 1e-9)
        return replace(climate, mean=mean, speed=math.sqrt(self._gust))

    def _hand_over(self, wanted: Estimate) -> None:
        """Let a better model go on from the motion that is shown."""
        shown = self._next if self._next is not None and self._faded > 0.5 else self._shown
        better = self._simulator(wanted)
        if better is not shown:
            x, v = shown.motion()
            into_whole = self._into_whole(shown)
            here = self._among(better)
            better.follow_wind(shown)
            better.take_over((into_whole @ x)[here], (into_whole @ v)[here])
            self._left, self._shown = shown, better
        self._next, self.choice = None, wanted

    def _set_apart(self, left: SwaySimulator) -> None:
        """Note by how much the picture would jump from a model to the one now shown."""
        self._turns_apart = self._whole_rotations(left) - self._whole_rotations(self._shown)
        poses, others = left.place(), self._shown.place()
        apart = np.einsum('jk,jk->j', poses[:, 3:], others[:, 3:]) < 0.0
        poses[apart, 3:] *= -1.0
        self._poses_apart = poses - others
        self._left, self._behind = None, 1.0

    def _estimates(self, *climates: WindClimate) -> list[Estimate]:
        """Judge every model in several winds by the worst."""
        each = [self.ladder.estimates(climate) for climate in climates]
        return [max(of_model, key=lambda e: e.error) for of_model in zip(*each, strict=True)]

    def _choose(
        self, estimates: list[Estimate], current: Estimate | None = None, *, at_best: bool = False
    ) -> Estimate:
        affordable = [e for e in estimates if self.pace * e.cost <= self.budget]
        affordable = (affordable or estimates[:1]) if self.budget > 0.0 else estimates
        same = next((e for e in affordable if current and e.name == current.name), None)
        wanted = None if at_best else _least(affordable, self.tolerance)
        if wanted is None:
            wanted = choose(affordable)
            return same if same is not None and _SPARE * same.error < wanted.error else wanted
        if same is not None and wanted.cost < same.cost:
            careful = _least(affordable, _SPARE * self.tolerance)
            return careful if careful is not None and careful.cost < same.cost else same
        return wanted

    @property
    def _faded(self) -> float:
        """How far the picture has gone over to the next model."""
        return _smooth(max((self._next_age - RUN_IN) / CROSS_FADE, 0.0))

    def _whole_rotations(self, simulator: SwaySimulator) -> Floats:
        """Key rotations of a model among those of the whole tree, (N,), a new array."""
        rotations: Floats = self._into_whole(simulator) @ simulator.rotations()
        return rotations

    def _into_whole(self, simulator: SwaySimulator) -> Any:
        """Matrix from the coordinates of a model to those of the whole tree."""
        name = self._name_of(simulator)
        if name not in self._among_whole:
            self._among_whole[name] = coordinates_within(
                simulator.joints, self.ladder.moving(name), self.joints
            )
        return self._among_whole[name]

    def _among(self, simulator: SwaySimulator) -> Ints:
        """Where the coordinates of a model stand among those of the whole tree, (n,)."""
        first = self.joints['coordinate'][self.ladder.moving(self._name_of(simulator))]
        counts = simulator.joints['n_coordinates']
        within = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
        return np.repeat(first, counts) + within

    def _name_of(self, simulator: SwaySimulator) -> str:
        return next(name for name, each in self._built.items() if each is simulator)

    def _simulator(self, wanted: Estimate) -> SwaySimulator:
        if wanted.name not in self._built:
            model = replace(self.settings, model=wanted.model, n_modes=max(wanted.n_modes, 1))
            calibrated = self.ladder.calibrated(wanted)
            sim = SwaySimulator(self.tree, self.species, model, calibrated=calibrated)
            sim.step((0.0, 0.0, 0.0), 1.0 / 60.0)
            sim.reset()
            self._built[wanted.name] = sim
        return self._built[wanted.name]


def _least(estimates: Sequence[Estimate], tolerance: float) -> Estimate | None:
    """Find the cheapest within a tolerance, if there is one."""
    return min((e for e in estimates if e.error <= tolerance), key=lambda e: e.cost, default=None)


def _smooth(share: float) -> float:
    return share * share * (3.0 - 2.0 * share)


def _shift(poses: Floats, by: Floats) -> None:
    """Add a small difference to poses, in place."""
    poses += by
    poses[:, 3:] /= np.linalg.norm(poses[:, 3:], axis=1)[:, None]


def _mix(poses: Floats, others: Floats, share: float) -> None:
    """Go over from poses to others by a share, in place."""
    turn, other = poses[:, 3:], others[:, 3:]
    towards = np.einsum('jk,jk->j', turn, other)
    poses[:, :3] += share * (others[:, :3] - poses[:, :3])
    turn += share * (np.where(towards < 0.0, -1.0, 1.0)[:, None] * other - turn)
    turn /= np.sqrt(np.einsum('jk,jk->j', turn, turn))[:, None]
