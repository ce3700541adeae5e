# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A tree with the smallest sufficient number of coordinates, changed without a visible jump.

The error and the cost of every number of coordinates, in the wind of the last minute and in the
present wind, are estimated (`estimate`). The cheapest number within the tolerance in both is
chosen, or, where none is within the budget, the most accurate one that is.

All coordinates are always stepped; those that are left out are not shown, and do not change the
load of the others. So added coordinates need no initial state.

**Up at once.** A load beyond that of the choice is detected in its first step. A load beyond all
of the last minute is solved with all coordinates within the budget, as it is unknown. What they
do from then on is shown at once, less the displacement that they begin with, which is nothing
after a calm. That fades in within 0.4 s.

**Down slowly.** Coordinates that are not needed fade within a second. They are left out only when
the others suffice with a margin of a third, so that a wind at the border does not switch them on
and off.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
import math
from operator import attrgetter
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import refuse_time_step, three_numbers, within
from tree_sway.core.model import SwayModel
from tree_sway.core.run import SwaySimulator
from tree_sway.core.tree_state import TreeState
from tree_sway.core.wind import is_wind, simulate_turbulence
from tree_sway.fidelity.climate import ClimateTracker, WindClimate
from tree_sway.fidelity.estimate import dialled, ErrorEstimator, Estimate

if TYPE_CHECKING:
    from tree_sway.core.run import Spring

LEAVE_IN = 1.0
"""Time in [s] in which coordinates that are left out fade."""

_ADD_IN = 0.4
"""Time in [s] in which the displacement that added coordinates begin with is faded in."""

_SURPRISE = 1.2
"""Ratio of the load to the largest load of the choice above which the choice is made again."""

_LOAD_JUMP = 2.0
"""
Ratio of the load to the largest of the last minute above which all coordinates within the budget
are used.
"""

_GUST_MEMORY = 5.0
"""Time in [s] after which the weight of a gust is 1/e."""

_SWINGS_ON = 20.0
"""Time in [s] that a tree may swing freely after a push."""

REVIEW = 2.0
"""Interval in [s] at which the choice is made again."""

_SPARE = 2.0 / 3.0


class AdaptiveSimulator(SwaySimulator):
    """
    A tree on the smallest sufficient number of coordinates; otherwise as `SwaySimulator`.

    Parameters
    ----------
    prepared
        Model of the tree on all coordinates that may be shown, such as `USUAL`.
    tolerance
        Largest error of the tips in [m], root mean square over time and tips.
    budget
        Largest cost of a step and a placing in [us]; 0 for no limit.

    """

    choice: Estimate
    """Number of coordinates in use, or faded in."""

    def __init__(
        self,
        prepared: SwayModel,
        *,
        tolerance: float = 0.005,
        budget: float = 0.0,
    ) -> None:
        """Make the tree on all coordinates, and choose for the expected wind."""
        super().__init__(prepared)
        self._estimator = ErrorEstimator(self._bank)
        self.tolerance = within('tolerance', tolerance, 0.0, math.inf, 'm')
        self.budget = within('budget', budget, 0.0, math.inf, 'us')
        self.cost_scale = 1.0
        """Measured cost over estimated cost; set once it is measured."""
        self._touched_for = 0.0
        breeze = simulate_turbulence(
            8.0, rate=20.0, duration=60.0, rng=np.random.default_rng(0), intensity=0.2
        )
        self._expected_wind = WindClimate.of_samples(breeze, 20.0)
        n_coordinates = self._bank.oscillators.shapes.shape[1]
        self._shares = np.zeros(n_coordinates)
        self._begun = np.zeros(n_coordinates)
        self._left = np.zeros(1)
        self._expect()

    @property
    def model(self) -> str:
        """Return the name of the model."""
        return 'auto'

    @property
    def frame_cost(self) -> float:
        """Return the cost of a step and a placing of the chosen number on this machine in [us]."""
        return self.cost_scale * self.choice.cost

    def estimates(self, climate: WindClimate) -> list[Estimate]:
        """Estimate every number of coordinates of the tuned tree in a wind."""
        return self._estimator.estimates(climate)

    def _memory(self) -> tuple[Floats, ...]:
        """Return views of the state, and of how each coordinate is shown."""
        return *super()._memory(), self._shares, self._begun, self._left

    def set_state(self, state: TreeState) -> None:
        """Continue from a state and its shown shares; see `SwaySimulator.set_state`."""
        super().set_state(state)
        estimates = self.estimates(self._tracker.climate)
        is_whole = self._shares == 1.0
        count = int(is_whole.sum())
        self.choice = next(each for each in estimates if each.n_coordinates >= count)
        self._show()

    def step(self, wind_mean: ArrayLike, dt: float) -> int:
        """Advance one step, as `SwaySimulator.step`; choose again when it is time."""
        self._check_load(wind_mean, dt)
        is_tuned = self._tuning is not None and self._tuning.is_moving
        status = super().step(wind_mean, dt)
        self._tracker.add(self._wind, dt)
        if is_tuned:
            self._estimator.refresh()
        self._since_review += dt
        self._touched_for -= dt
        if self._since_review >= REVIEW:
            self.review()
        self._fade(dt)
        return status

    def push(
        self, segment: int, force: ArrayLike | Spring, seconds: float, *, along: float = 0.5
    ) -> None:
        """Push as `SwaySimulator.push`, on most coordinates until the free swing is over."""
        super().push(segment, force, seconds, along=along)
        was_free = self._touched_for <= 0.0
        self._touched_for = seconds + _SWINGS_ON
        if was_free:
            self.review()

    def review(self, *, at_best: bool = False) -> Estimate:
        """Choose again once the tolerance has changed; with ``at_best`` whatever the tolerance."""
        self._since_review = 0.0
        self._judged = self._gust
        climate = self._tracker.climate
        # The wind to come has the last gust and the last minute's turbulence.
        speed = max(float(np.linalg.norm(self._bearing)), 1e-9)
        mean = self._bearing * (self._gust / speed)
        gust = replace(climate, mean=mean, speed=math.sqrt(self._gust))
        in_both = zip(self.estimates(climate), self.estimates(gust), strict=True)
        estimates = [max(pair, key=attrgetter('error')) for pair in in_both]
        if self._touched_for > 0.0:  # the effect of a push is not estimated
            self.choice = max(self._affordable(estimates), key=attrgetter('n_coordinates'))
        else:
            self.choice = self._choose(estimates, self.choice, at_best=at_best)
        self._add()
        return self.choice

    def reset(self) -> None:
        """Return to rest, with the number of coordinates for the expected wind."""
        super().reset()
        self._expect()
        self._show()

    def _show_at_most(self, count: int) -> None:
        """Choose among the numbers up to a count from now on, until `reset`."""
        dialled(self._bank).keep_only(count)
        self.review()
        self._shares[count:] = 0.0
        self._begun[:] = 0.0
        self._show()

    def _expect(self) -> None:
        """Choose for the expected wind."""
        self._tracker = ClimateTracker()
        self._gust = 0.0
        self._bearing = np.array([1.0, 0.0, 0.0])
        self._since_review = 0.0
        self._judged = float(np.linalg.norm(self._expected_wind.mean))
        self.choice = self._choose(self.estimates(self._expected_wind))
        self._add()
        self._fade(math.inf)

    def _add(self) -> None:
        """Show in full what was not, from its present displacement on."""
        count = self.choice.n_coordinates
        shares = self._shares[:count]
        if shares.min(initial=1.0) < 1.0:
            self._begun[:count] = self._hidden[:count]
            shares[:] = 1.0
            self._left[:] = 1.0
            self._show()

    def _fade(self, dt: float) -> None:
        """Fade what is left out, and the displacement that added coordinates began with."""
        left_out = self._shares[self.choice.n_coordinates :]
        before = _smooth(self._left)
        if before > 0.0 or left_out.max(initial=0.0) > 0.0:
            self._left -= dt / _ADD_IN
            np.maximum(self._left, 0.0, out=self._left)
            after = _smooth(self._left)
            self._begun *= after / np.maximum(before, 1e-300)
            left_out -= dt / LEAVE_IN
            np.maximum(left_out, 0.0, out=left_out)
            self._show()

    @property
    def _hidden(self) -> Floats:
        """Return the part of each coordinate that is not shown, (m,)."""
        now = dialled(self._bank).swing[0]
        faded_in = _smooth(self._shares) * (now - self._begun)
        return np.asarray(now - faded_in)

    def _show(self) -> None:
        is_shown = self._shares > 0.0
        dialled(self._bank).show(self._hidden, int(is_shown.sum()))

    def _check_load(self, wind_mean: ArrayLike, dt: float) -> None:
        """Detect a load beyond that of the choice before its step."""
        x, y, z = three_numbers('wind', wind_mean)
        refuse_time_step(dt)
        load = x * x + y * y + z * z
        self._gust *= math.exp(-dt / _GUST_MEMORY)
        if self._gust < load and is_wind(x, y, z, self._max_wind):
            self._gust = load
            self._bearing = np.array([x, y, z])
            if load > _SURPRISE * self._judged:
                usual = self._tracker.largest_load
                self.review(at_best=load > _LOAD_JUMP * usual)

    def _affordable(self, estimates: list[Estimate]) -> list[Estimate]:
        """Find the numbers within the budget, or the cheapest one."""
        most = dialled(self._bank).n_solved
        solved = [each for each in estimates if each.n_coordinates <= most]
        if self.budget <= 0.0:
            return solved
        affordable = [each for each in solved if self.cost_scale * each.cost <= self.budget]
        return affordable or solved[:1]

    def _choose(
        self, estimates: list[Estimate], current: Estimate | None = None, *, at_best: bool = False
    ) -> Estimate:
        affordable = self._affordable(estimates)
        same = None if current is None else _named(affordable, current.name)
        wanted = None if at_best else _least(affordable, self.tolerance)
        if wanted is None:
            best = min(affordable, key=attrgetter('error', 'cost'))
            if same is not None and _SPARE * same.error < best.error:
                return same
            return best
        if same is None or wanted.cost >= same.cost:
            return wanted
        careful = _least(affordable, _SPARE * self.tolerance)
        if careful is None or careful.cost >= same.cost:
            return same
        return careful


def _smooth(shares: Floats) -> Floats:
    """Let shares from 0 to 1 begin and end without a jump of their rate."""
    return shares * shares * (3.0 - 2.0 * shares)


def _least(estimates: Sequence[Estimate], tolerance: float) -> Estimate | None:
    """Find the cheapest number within a tolerance, if there is one."""
    within = [each for each in estimates if each.error <= tolerance]
    return min(within, key=attrgetter('cost'), default=None)


def _named(estimates: Sequence[Estimate], name: str) -> Estimate | None:
    """Find the number of a name, if it is among some."""
    found = [each for each in estimates if each.name == name]
    return found[0] if found else None
