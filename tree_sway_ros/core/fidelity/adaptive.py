"""
A tree that uses no more model than its scene needs, and changes models unseen.

The error and the cost of every model in the wind of the last minute, and in the wind that blows
now, are known beforehand (`ladder`); the cheapest that stays within the tolerance in both is used,
or, where none that can be afforded does, the most accurate of those.

**Up at once.** A load beyond what the model was chosen for is noticed in the step in which it
comes. The better model goes on from the motion that is shown, its coordinates mapped one by one;
what the two still differ by fades within a quarter of a second.

**Down slowly.** A lesser model first sways along unseen until it has forgotten where it started,
then the picture goes over to it within a second. It is taken only when it would do with a third to
spare, so that a wind on the border does not flicker.

"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from tree_sway_ros.core.arrays import Floats, Ints
from tree_sway_ros.core.fidelity.estimate import Estimate, choose
from tree_sway_ros.core.fidelity.ladder import FidelityLadder
from tree_sway_ros.core.kernel import fused
from tree_sway_ros.core.simulator.season import in_season
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.core.simulator.simulator import WIND_REFUSED, Counts, SwaySimulator
from tree_sway_ros.core.tree.species import Species, species_named
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.core.wind.climate import ClimateTracker, WindClimate

RUN_IN = 10.0
"""How long a new model sways unseen in [s]."""

CROSS_FADE = 1.0
"""How long the picture takes to go over in [s]."""

HAND_OVER = 0.25
"""How long it takes in [s] until a better model is shown as it is."""

SURPRISE = 1.2
"""Load over the largest that the model was chosen for, at which the choice is looked at again."""

GUST_MEMORY = 5.0
"""Time in [s] after which a gust counts 1/e."""

REVIEW = 2.0
"""How often the choice is looked at again in [s]."""

_SPARE = 2.0 / 3.0


class AdaptiveSimulator:
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
        self.pace = 1.0
        """Cost here over the cost that the ladder says: set it once it is measured."""
        self._expected = expected or WindClimate.steady(8.0, 0.2)
        self._built: dict[str, SwaySimulator] = {}
        self._coordinates: dict[str, Ints] = {}
        self.counts = Counts()
        """Steps, refused winds and held loads since the start, whatever the model."""
        self._expect()
        for estimate in self.ladder.estimates(WindClimate.steady(0.0, 0.0)):
            self._simulator(estimate)  # now, for a change must not hold up the stream
        self._shown = self._simulator(self.choice)
        self._next: SwaySimulator | None = None
        self._next_age = self._since_review = 0.0
        self._left: SwaySimulator | None = None
        self._behind, self._difference = 0.0, np.zeros((tree.n_segments, 7))
        self._poses = np.zeros((tree.n_segments, 7))
        self._mixed = np.zeros((tree.n_segments, 7))

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
    def frame_cost(self) -> float:
        """What a step and a placing of the chosen model take on this machine in [us]."""
        return self.pace * self.choice.cost

    @property
    def tip_displacement(self) -> Floats:
        """Way of the highest tip from rest in [m], (3,), as last placed by the model in use."""
        return self._shown.tip_displacement

    @property
    def shown(self) -> SwaySimulator:
        """Simulator whose poses are seen, or fade."""
        return self._shown

    @property
    def is_changing(self) -> bool:
        """Whether another model is swaying along to take over."""
        return self._next is not None

    def step(self, wind_mean: ArrayLike, dt: float) -> int:
        """Advance one step, as `SwaySimulator.step`; look at the choice again when it is time."""
        self._feel(wind_mean, dt)
        held = self._shown.counts.held
        status = self._shown.step(wind_mean, dt)
        self.counts.steps += 1
        self.counts.refused += bool(status & WIND_REFUSED)
        self.counts.held += self._shown.counts.held - held
        self._tracker.add(self._shown.wind, dt)
        self._behind = max(self._behind - dt / HAND_OVER, 0.0)
        if self._left is not None:
            self._left.step(wind_mean, dt)
            np.subtract(self._left.place(), self._shown.place(self._mixed), out=self._difference)
            _nearer(self._difference, self._left.place(), self._mixed)
            self._left, self._behind = None, 1.0
        if self._next is not None:
            self._next.step(wind_mean, dt)
            self._next_age += dt
            if self._next_age >= RUN_IN + CROSS_FADE:
                self._shown, self._next = self._next, None
        self._since_review += dt
        if self._since_review >= REVIEW:
            self.review()
        return status

    def review(self) -> Estimate:
        """
        Look at the choice again: call it when the tolerance has changed. Returns what is chosen.

        """
        self._since_review, self._judged = 0.0, self._gust
        estimates = self._estimates(self._tracker.climate, self._gust_climate())
        wanted = self._choose(estimates, current=self.choice)
        now = next(e for e in estimates if e.name == self.choice.name)
        if wanted.name == self.choice.name:
            self.choice = wanted
        elif wanted.error < now.error:
            self._hand_over(wanted)
        elif self._next is None:
            self._next, self._next_age = self._simulator(wanted), 0.0
            self._next.reset()
            self.choice = wanted
        return self.choice

    def place(self, out: Floats | None = None) -> Floats:
        """Place every segment, as `SwaySimulator.place`."""
        poses = self._shown.place(self._poses if out is None else out)
        share = (self._next_age - RUN_IN) / CROSS_FADE
        if self._next is not None and share > 0.0:
            _mix(poses, self._next.place(self._mixed), _smooth(share))
        if self._behind > 0.0:
            _shift(poses, self._difference, _smooth(self._behind))
        return poses

    def _feel(self, wind_mean: ArrayLike, dt: float) -> None:
        """Notice a load beyond what the model was chosen for, before the step in which it comes."""
        x, y, z = float(wind_mean[0]), float(wind_mean[1]), float(wind_mean[2])  # type: ignore[index, arg-type]
        load = x * x + y * y + z * z
        self._gust *= math.exp(-dt / GUST_MEMORY)
        if self._gust < load <= self.settings.max_wind**2:
            self._gust, self._bearing = load, (x, y)
            if load > SURPRISE * self._judged:
                self.review()

    def _gust_climate(self) -> WindClimate:
        """The wind that may come until the next look: the last gust holds on, as unsteady as now."""
        mean = np.array(self._bearing)
        mean *= self._gust / max(float(np.linalg.norm(mean)), 1e-9)
        climate = self._tracker.climate
        return replace(climate, mean=mean, speed=math.sqrt(self._gust))

    def _hand_over(self, wanted: Estimate) -> None:
        """Let a better model go on from the motion that is shown."""
        fading = self._next is not None and self._next_age > RUN_IN
        shown = self._next if self._next is not None and fading else self._shown
        better = self._simulator(wanted)
        if better is not self._shown:
            x, v = np.zeros((2, self.ladder.n_coordinates))
            here = self._coordinates[self._name_of(shown)]
            x[here], v[here] = shown.motion()
            here = self._coordinates[wanted.name]
            better.take_over(x[here], v[here])
            self._left, self._shown = self._shown, better
        self._next, self.choice = None, wanted

    def reset(self) -> None:
        """
        Go back to rest and to the wind that was expected, at once on the model that it asks for.

        """
        self._expect()
        self._shown, self._next, self._left = self._simulator(self.choice), None, None
        self._shown.reset()
        self._since_review = self._behind = 0.0

    def _expect(self) -> None:
        """Choose for the wind that is expected."""
        self._tracker = ClimateTracker()
        self._gust, self._bearing = 0.0, (1.0, 0.0)
        self._judged = float(np.linalg.norm(self._expected.mean))
        self.choice = self._choose(self.ladder.estimates(self._expected))

    def _estimates(self, *climates: WindClimate) -> list[Estimate]:
        """Judge every model in several winds by the worst."""
        each = [self.ladder.estimates(climate) for climate in climates]
        return [max(of_model, key=lambda e: e.error) for of_model in zip(*each, strict=True)]

    def _choose(self, estimates: list[Estimate], current: Estimate | None = None) -> Estimate:
        affordable = [e for e in estimates if self.pace * e.cost <= self.budget]
        affordable = (affordable or estimates[:1]) if self.budget > 0.0 else estimates
        same = next((e for e in affordable if current and e.name == current.name), None)
        wanted = _least(affordable, self.tolerance)
        if wanted is None:
            wanted = choose(affordable)
            return same if same is not None and _SPARE * same.error < wanted.error else wanted
        if same is not None and wanted.cost < same.cost:
            careful = _least(affordable, _SPARE * self.tolerance)
            return careful if careful is not None and careful.cost < same.cost else same
        return wanted

    def _name_of(self, simulator: SwaySimulator) -> str:
        return next(name for name, built in self._built.items() if built is simulator)

    def _simulator(self, wanted: Estimate) -> SwaySimulator:
        if wanted.name not in self._built:
            model = replace(self.settings, model=wanted.model, n_modes=max(wanted.n_modes, 1))
            calibrated = self.ladder.calibrated(wanted)
            sim = SwaySimulator(self.tree, self.species, model, calibrated=calibrated)
            sim.step((0.0, 0.0, 0.0), 1.0 / 60.0)
            sim.reset()
            sim.counts.steps = 0
            self._built[wanted.name] = sim
            self._coordinates[wanted.name] = self.ladder.coordinates(wanted)
        return self._built[wanted.name]


def _least(estimates: Sequence[Estimate], tolerance: float) -> Estimate | None:
    """Find the cheapest within a tolerance, if there is one."""
    return min((e for e in estimates if e.error <= tolerance), key=lambda e: e.cost, default=None)


def _smooth(share: float) -> float:
    return share * share * (3.0 - 2.0 * share)


def _nearer(difference: Floats, poses: Floats, others: Floats) -> None:
    """Take the difference of two quaternions of one rotation from the nearer sign."""
    apart = np.einsum("jk,jk->j", poses[:, 3:], others[:, 3:]) < 0.0
    difference[apart, 3:] = -poses[apart, 3:] - others[apart, 3:]


@fused
def _shift(poses: Floats, difference: Floats, share: float) -> None:
    """Add a share of a difference to poses, in place."""
    for j in range(len(poses)):
        square = 0.0
        for k in range(7):
            poses[j, k] += share * difference[j, k]
            if k >= 3:
                square += poses[j, k] * poses[j, k]
        for k in range(3, 7):
            poses[j, k] /= np.sqrt(square)


@fused
def _mix(poses: Floats, others: Floats, share: float) -> None:
    """Go over from poses to others by a share of the way, in place."""
    for j in range(len(poses)):
        towards = 0.0
        for k in range(3, 7):
            towards += poses[j, k] * others[j, k]
        sign = 1.0 if towards >= 0.0 else -1.0
        square = 0.0
        for k in range(7):
            other = others[j, k] if k < 3 else sign * others[j, k]
            poses[j, k] += share * (other - poses[j, k])
            if k >= 3:
                square += poses[j, k] * poses[j, k]
        for k in range(3, 7):
            poses[j, k] /= np.sqrt(square)
