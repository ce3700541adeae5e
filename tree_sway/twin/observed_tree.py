# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A simulator whose motion sensors on the real tree correct.

It steps in the wind alone, adds the correction of its observer, and takes it off again before the
next step. What places, streams or records the tree reads the corrected state.

The wind of the steps is the one expected at the limbs: by `far_wind` where there is no sensor and
the distance of the anemometer is known; else given that of the anemometer: a share of
each gust reaches the whole crown at once, the rest limb after limb (`crown_wind`). The gusts of
each limb are for the sensors to tell.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain
import math
from typing import Any, TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import (
    array_to_read,
    LONGEST_STEP,
    refuse_time_step,
    three_numbers,
    within,
)
from tree_sway.core.model import ModelCache, PREPARED
from tree_sway.core.run import FarCrown, Outcome, SwaySimulator
from tree_sway.core.settings import Settings, settings_with
from tree_sway.core.setup import prepared, TreeReductions
from tree_sway.core.species import Species, WOOD_SPREAD
from tree_sway.core.tree import GrownTree, Tree, tree_and_species
from tree_sway.core.wind import is_wind
from tree_sway.core.wind.gusts import CrownWind, delays_of, N_DELAYS, USUAL_COHERENCE
from tree_sway.errors import ParameterError
from tree_sway.twin.disturbance import crown_slope
from tree_sway.twin.dragged_motion import DraggedMotion
from tree_sway.twin.explained_motion import ExplainedMotion
from tree_sway.twin.late_wind import LateWind
from tree_sway.twin.learned_tree import LearnedTree
from tree_sway.twin.members import Members, most_of, uncertainty_of
from tree_sway.twin.motion_sensor import MotionSensor
from tree_sway.twin.observer import Observer
from tree_sway.twin.sensor_place import place_on, reach_of, tip_slopes
from tree_sway.twin.sensor_track import SensorTrack
from tree_sway.twin.sway_watch import SwayChange
from tree_sway.twin.tree_fit import TreeFit

if TYPE_CHECKING:
    from tree_sway.core.run import Tuning
    from tree_sway.core.tree_state import TreeState

_STORM = 36.0
"""Wind in [m/s] whose static deflection bounds the energy of the corrected motion."""

_KNOWN_AHEAD = 0.5
"""Time in [s] by which samples of records are known ahead of a step."""

_FOLLOWED_EVERY = 5.0
_PACE = 0.01
"""
Pace in [1/s] at which the logarithms of stiffness and damping follow those of the real tree.

A softer tree leans more; at this pace its lean changes by a fifth in 20 s, less than gusts do.
"""

_DYNAMIC = 4.0
"""Energy of the motion in a storm over that of the static deflection."""


@dataclass
class _Record:
    """Times [s], rows of each quantity, (n, 3) or (n, 4), and the next one to be offered."""

    time: list[float]
    rows: dict[str, Floats]
    next: int = 0


class ObservedTree(SwaySimulator):
    """
    A tree that sways as the sensors on it do.

    Parameters
    ----------
    tree, species, settings, cache, **changes
        Arguments of `make_simulator`. The model is a number of coordinates, or ``full``.
    at
        Place of each sensor by its name, as `place_on` takes it.
    rate
        Steps per second in [Hz].
    learns
        Whether stiffness and damping follow the sensors.
    has_band
        Whether it also says how sure it is (`band`).
    upwind
        Distance of the anemometer upwind of the tree in [m], for a tree without sensors: those
        find how long gusts travel, and more exactly than the mean wind of the first minutes.

    Raises
    ------
    ParameterError
        No such place, or a model without coordinates that can be corrected.

    Examples
    --------
    >>> twin = ObservedTree(tree, at={'phone': 3.2})
    >>> twin.offer('phone', time, acceleration=(0.1, -0.2, 9.8), rate=(0.0, 0.01, 0.0))
    >>> twin.step(wind, 1 / 60)

    """

    def __init__(
        self,
        tree: Tree | GrownTree,
        species: Species | None = None,
        settings: Settings | None = None,
        *,
        at: Mapping[str, str | float],
        rate: float = 60.0,
        learns: bool = True,
        has_band: bool = False,
        upwind: float = 0.0,
        cache: ModelCache | None = PREPARED,
        **changes: Any,
    ) -> None:
        chosen = self._chosen = settings_with(settings, changes)
        # Apart from its anemometer, the wind of a crown is the one expected there (`far_wind`).
        usual = 1.0 if chosen.is_far else USUAL_COHERENCE
        coherence = min(chosen.crown_coherence, usual)
        bare, wood = tree_and_species(tree, species)
        whole = replace(chosen, crown_coherence=1.0, anemometer_distance=0.0)
        reductions = TreeReductions(bare, wood, whole)
        super().__init__(prepared(reductions, cache=cache))
        if not hasattr(self._bank.oscillators, 'swing') or self.settings.model == 0:
            raise ParameterError(
                f"motion sensors on model '{self.model}'",
                where='model',
                cure='use a number of coordinates, such as 60',
            )
        self._places = {name: place_on(self.tree, where) for name, where in at.items()}
        self.at = {name: str(where) for name, where in at.items()}
        """Place of each sensor as it was given."""
        self._explained = ExplainedMotion()
        self._has_band, self._rate = has_band, 0.0
        self._as_made = self.check_tuning()
        self._tuned: tuple[Tuning, ...] = ()
        tunable = self._bank.oscillators.tunable
        slowest = np.argmin(tunable.stiffness / tunable.inertia)
        weight = float(tunable.weight[slowest])
        self._slowest = float(tunable.stiffness[slowest]) - weight, weight
        self._records: dict[str, _Record] = {}
        distance = within('upwind', upwind, 0.0, 1000.0, 'm')
        is_told = chosen.is_far and chosen.anemometer_bearing is not None
        far = FarCrown(self.models[0], self._bank, None, chosen) if chosen.is_far else None
        self._far_crown = far
        self.late_wind = LateWind(
            0.0 if self._places else distance,
            is_told=is_told,
            far=None if far is None else far.wind,
        )
        """The wind on its way from the anemometer."""
        self.set_rate(rate)
        delays = delays_of(self.tree, reductions.leaf_load_area)
        self._share = delays.share
        self._about_mean = np.eye(N_DELAYS) - delays.share  # takes the mean away
        self._crown = CrownWind(delays.spread, coherence)
        self._apart, self._whole = np.zeros((N_DELAYS, 3)), np.zeros(3)
        oscillators: Any = self._bank.oscillators
        self._swing: tuple[Floats, ...] = tuple(oscillators.swing)
        self._corrected = self._swing[0][: self.observer.count]
        self._added = np.zeros((2, len(self._swing[0])))
        load = _STORM * crown_slope(self, _STORM, self.observer.count)
        bent = (np.square(load).sum(axis=0) / self.observer.stiffness).sum()
        # Energy that no correction exceeds, per unit mass of the coordinates.
        self._limit = _DYNAMIC * float(bent)
        self.now = 0.0
        """Time of the end of the last step in [s], on the clock of the sensors."""
        self._given: float | None = None
        self._held_wind = (0.0, 0.0, 0.0)
        self._learned = np.zeros(2)
        self._followed = 0.0
        self.learned_before: LearnedTree | None = getattr(tree, 'learned', None)
        """What sensors told in earlier runs, in the species already; None without."""
        if chosen.is_far and not at:  # sensors tell the wood
            known = self.learned_before
            spread = WOOD_SPREAD if known is None else known.stiffness_error
            tunable.spread_wood(spread)
        self.learns = learns
        """Whether stiffness and damping follow the sensors."""

    @property
    def wind_told(self) -> str:
        """By which gusts it sways: the expected ones where what is drawn would be a sample."""
        gusts = 'expected' if self._chosen.is_far else self._chosen.gusts
        return replace(self._chosen, gusts=gusts).wind_told

    def set_rate(self, rate: float) -> None:
        """
        Set the steps per second in [Hz]; the sensors begin anew if it changes.

        A `ParameterError` refuses a rate beyond 1 to 10,000 Hz.
        """
        if within('rate', rate, 1.0 / LONGEST_STEP, 10_000.0, 'Hz') == self._rate:
            return
        before = self.observer if self._rate else None
        self._rate = rate
        frequency = float(self.frequencies(1)[0])
        self.sensors = {name: MotionSensor(name, place) for name, place in self._places.items()}
        """Sensors by their names."""
        dt = self.period
        tracks = [
            SensorTrack(each, frequency, dt, reach_of(self.tree, each.place))
            for each in self.sensors.values()
        ]
        self.observer: Observer = Observer(self, tracks, dt, before=before, wind=self.late_wind)
        """What the sensors tell."""
        self._dragged = DraggedMotion(self.observer, dt)
        self.members: Members | None = None
        """Trees that the real one might be; None without a band."""
        if self._has_band:
            spreads = uncertainty_of(in_leaf=bool(self.settings.in_leaf))
            far = None if self._far_crown is None else (self._far_crown.wind, self)
            self.members = Members(self.observer, dt, spreads, far)

    @property
    def period(self) -> float:
        """Time step in [s] of the sensors' gains."""
        return 1.0 / self._rate

    def offer(
        self,
        name: str,
        time: float,
        *,
        acceleration: ArrayLike | None = None,
        rate: ArrayLike | None = None,
        orientation: ArrayLike | None = None,
    ) -> bool:
        """
        Offer a sample of a sensor that comes now, as `MotionSensor.offer`.

        The time is in [s] on the clock of the steps. A `KeyError` is for no such sensor.
        """
        return self.sensors[name].offer(
            time,
            acceleration=acceleration,
            rate=rate,
            orientation=orientation,
            arrival=self.now + self.period,  # the step that is next
        )

    def replay(
        self,
        name: str,
        time: Floats,
        *,
        acceleration: Floats | None = None,
        rate: Floats | None = None,
        orientation: Floats | None = None,
    ) -> None:
        """
        Offer a record of a sensor, sample by sample as the steps reach its times.

        Times are in [s] after `reset`, (n,); the quantities, (n, 3) and (n, 4), are those of
        `offer`. A `ParameterError` names an array of another shape, or without numbers.
        """
        times = array_to_read(f'{name}: time', time, (np.size(time),))
        order = np.argsort(times, kind='stable')
        rows = {
            key: array_to_read(f'{name}: {key}', each, (len(times), width))[order]
            for key, each, width in (
                ('acceleration', acceleration, 3),
                ('rate', rate, 3),
                ('orientation', orientation, 4),
            )
            if each is not None
        }
        self._records[name] = _Record(times[order].tolist(), rows)

    def _offer_records(self, until: float) -> None:
        """Offer the samples of all records up to a time in [s]."""
        for name, record in self._records.items():
            while record.next < len(record.time) and record.time[record.next] <= until:
                row = {key: each[record.next] for key, each in record.rows.items()}
                self.sensors[name].offer(record.time[record.next], **row)
                record.next += 1

    def set_time(self, time: float) -> None:
        """Set the time in [s] at which the next step ends; else it goes on by its length."""
        self._given = time

    def step(self, wind_mean: ArrayLike, dt: float) -> int:
        """Advance one step as `SwaySimulator.step`, then correct the motion."""
        x, y, z = three_numbers('wind', wind_mean)
        refuse_time_step(dt)  # before anything changes
        swing, added = self._swing, self._added
        eta, rate, _ = swing
        eta -= added[0]
        rate -= added[1]
        refused = not is_wind(x, y, z, self._max_wind)
        if refused:  # the last wind goes on
            self.counts.refused += 1
            x, y, z = self._held_wind
        self._held_wind = x, y, z
        late = x, y, z = self.late_wind.push(x, y, z, dt)
        whole = self._whole
        if self._far_crown is not None:
            whole[:] = self._far_crown.push(x, y, z, dt)
        else:
            by_delay = self._crown.push(x, y, z, dt)
            np.dot(self._share, by_delay, out=whole)
            np.dot(self._about_mean, by_delay, out=self._apart)
            whole += late
        status = super().step(whole, dt)
        if refused:
            status |= Outcome.WIND_REFUSED
        if status & Outcome.RESTARTED:
            added[:] = 0.0
            self._dragged.reset()
            self.observer.reset()
        self.now = self.now + dt if self._given is None else self._given
        self._given = None
        if self._records:
            self._offer_records(self.now + _KNOWN_AHEAD)
        n_periods = max(round(dt * self._rate), 1)
        correction = self.observer.step(self.now, late, n_periods)
        self._bound(correction)
        self._dragged.step(correction, n_periods, added)
        if self.members is not None:
            self.members.step(swing, late[:2], self._apart)
        eta += added[0]
        rate += added[1]
        if self.observer.is_active:
            self._explained.note(dt, self.observer.stiffness, self._corrected, correction[0])
        self._followed += dt
        if self._followed >= _FOLLOWED_EVERY:
            self._followed = 0.0
            if self.learns and self.observer.fit is not None:
                self._follow(self.observer.fit)
        return status

    def _follow(self, fit: TreeFit) -> None:
        """Let the model come nearer to the stiffness and damping of the real tree."""
        assert self._tuning is not None
        if self._tuning.is_moving:
            return
        wanted = np.log([fit.stiffness, fit.damping])
        most = _FOLLOWED_EVERY * _PACE
        followed = self._learned + np.clip(wanted - self._learned, -most, most)
        if not self._go_to(followed):
            return
        self._learned[:] = followed
        if self.members is not None:
            left = np.hypot(wanted - followed, [fit.stiffness_error, fit.damping_error])
            known = self.members.spreads
            self.members.spreads = known._replace(
                stiffness=min(float(left[0]), known.stiffness),
                damping=min(float(left[1]), known.damping),
            )

    def _go_to(self, factors: Floats) -> bool:
        """Let the next step take logarithms of factors; tell whether the tree allows them."""
        assert self._tuning is not None
        stiffness, damping = np.exp(factors).tolist()
        ratio = min(damping * self._as_made.damping_ratio, 1.0)
        try:
            goal = self.check_tuning(stiffness_factor=stiffness, damping_ratio=ratio)
        except ParameterError:  # a tree that would buckle stays as it is
            return False
        if goal != self._tuning.goal:
            # So small a change needs no transition, whose every step costs as much.
            self._tuning.go_to(goal, self.period)
        return True

    def tune(self, **changes: float) -> None:
        """Change the tree as `SwaySimulator.tune`; what is learned goes on from there."""
        super().tune(**changes)
        assert self._tuning is not None
        self._tuned = self._tuning.changes
        goal, made = self._tuning.goal, self._as_made
        self._learned[0] = math.log(goal.stiffness_factor)
        if min(goal.damping_ratio, made.damping_ratio) > 0.0:
            self._learned[1] = math.log(goal.damping_ratio / made.damping_ratio)

    @property
    def _tuning_of_state(self) -> tuple[Tuning, ...]:
        """Return what a person has tuned; what was learned is in the state itself."""
        return self._tuned

    def _bound(self, correction: Floats) -> None:
        """Scale a correction so that the tree does not move beyond its own storms, in place."""
        energy, own = self.observer.energies.tolist()
        if energy <= self._limit:
            return
        share = self._limit / energy
        self.observer.limit(share)
        # The wind alone may move it so far; sensors do not add to that.
        correction *= math.sqrt(share) if own < self._limit else 0.0

    def _memory(self) -> tuple[Floats, ...]:
        """Return views of the state, with the correction in it."""
        far = () if self._far_crown is None else self._far_crown.wind.memory()
        own = self.late_wind.memory(), self._crown.memory(), far, (self._added, self._learned)
        return tuple(chain(super()._memory(), *own))

    def set_state(self, state: TreeState) -> None:
        """Continue from a state as `SwaySimulator.set_state`, with what was learned then."""
        super().set_state(state)
        self._go_to(self._learned)

    def reset(self) -> None:
        """Return to rest, with no wind; what is known about the sensors stays."""
        super().reset()
        self.late_wind.reset()
        self._crown.reset()
        if self._far_crown is not None:
            self._far_crown.wind.reset()
        self._added[:] = 0.0
        self._dragged.reset()
        self.observer.reset()
        if self.members is not None:
            self.members.reset()
        self.now, self._given = 0.0, None
        self._held_wind = (0.0, 0.0, 0.0)
        for record in self._records.values():
            record.next = 0

    def _glide(self, dt: float) -> bool:
        """Continue a transition of `tune`, and observe the changed tree."""
        is_changed = super()._glide(dt)
        if is_changed:
            self.observer.refresh()
        return is_changed

    def band(self, branches: Sequence[int] | None = None) -> Floats:
        """
        Where the real tips are for 80 % of the time, beyond those of the corrected motion.

        Parameters
        ----------
        branches
            Branches whose tips are asked for; all if None.

        Returns
        -------
        Floats
            Lower and upper bound of each tip's displacement less that of this tree in [m],
            (2, k, 3).

        Raises
        ------
        ParameterError
            A tree made without a band.

        """
        chosen = self._tips if branches is None else self._tips[list(branches)]
        return most_of(self._members_with_band().differences(chosen))

    def sway_band(self) -> Floats:
        """
        Where the distance of the real tree's highest tip from rest is for 80 % of the time.

        Returns
        -------
        Floats
            Lower and upper bound less the distance of this tree in [m], (2,).

        Raises
        ------
        ParameterError
            A tree made without a band.

        """
        members = self._members_with_band()
        slopes = self._tips[self.tree.branch_of_segment[self._highest]]
        moved = slopes[:, : self.observer.count] @ self._corrected
        others = np.linalg.norm(moved[:, None] + members.differences(slopes), axis=0)
        return most_of(others - np.linalg.norm(moved))

    @cached_property
    def _tips(self) -> Floats:
        """Way of the tip of each branch per unit of each coordinate, (b, 3, m)."""
        return tip_slopes(self)

    def load_band(self, per_rotation: Floats) -> Floats:
        """
        Where the real load of the wood is for 80 % of the time, beyond that of this tree.

        Parameters
        ----------
        per_rotation
            Load per unit of the first key rotations, (k, ...), such as that of the base moment.

        Returns
        -------
        Floats
            Lower and upper bound less the load of this tree, in its unit, (2, ...).

        """
        members = self._members_with_band()
        shapes = self._bank.oscillators.shapes[: len(per_rotation), : self.observer.count]
        readout = np.tensordot(per_rotation, shapes, axes=(0, 0))
        # Stiffer wood bears more at the same bend.
        bent = readout @ (self._corrected[:, None] + members.errors)
        return most_of(members.differences(readout) + (members.stiffness - 1.0) * bent)

    def _members_with_band(self) -> Members:
        if self.members is None:
            cure = 'make it with has_band=True'
            raise ParameterError('a tree without a band', where=self.tree.name, cure=cure)
        return self.members

    @property
    def explained(self) -> float:
        """
        Share of the motion that the wind alone explains, 0 to 1.

        It is that of the last half minute in which a sensor was in use, 1 before any was.
        """
        return self._explained.share

    @property
    def sway_changes(self) -> list[SwayChange]:
        """How the sway has changed by each sensor that has a past."""
        found = [self.observer.sway_change(k) for k in range(len(self.sensors))]
        return [each for each in found if each is not None]

    @property
    def learned(self) -> LearnedTree | None:
        """What the sensors have told, in earlier runs too; None before the first fit of all."""
        fit = self.observer.fit
        if fit is None:
            return self.learned_before
        wood, weight = self._slowest
        # The slowest coordinate is nearly the first mode: Rayleigh's quotient, as in `LiveTuning`.
        ratio = (fit.stiffness * wood + weight) / (wood + weight)
        # A damping ratio may be given in place of that of the species.
        of_season = self.models[0].species.damping(bool(self.settings.in_leaf))
        given = self.models[0].damping_ratio / of_season if of_season else 1.0
        found = LearnedTree(
            frequency=float(self.frequencies(1)[0]) * math.sqrt(ratio),
            change=next((str(each) for each in self.sway_changes if each.is_change), ''),
            **fit._replace(damping=fit.damping * given)._asdict(),
        )
        return found.after(self.learned_before)

    @property
    def problems(self) -> list[str]:
        """Sensors that are not in use: why, and what to do, one sentence each."""
        return [each.problem for each in self.observer.tracks if each.problem]
