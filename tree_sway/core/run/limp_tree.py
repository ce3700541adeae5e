# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Step of a limp tree: one whose twigs turn so far that neither load nor inertia is that of a table.

Its coordinates are those of the model with a table. Their load is that of every segment
(`segment_drag`), and their inertia and weight are those of the pose (`pose_inertia`):

    M(q) q'' + C q' + K q = F(wind, q, q') - centrifugal force + weight beyond the linear.

`coupled_step` solves it, in any wind. A longer step is taken in parts. A part that would turn a
branch too fast is bounded and counted as clamped. Trees of which coordinates are hidden, and those
of a stand, are stepped by their table. The laboratory's model `full` takes this step on all
coordinates.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
import math
from typing import Any, NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.kernel import entry_of, fused
from tree_sway.core.model.drag_law import drag_density, DragLaw
from tree_sway.core.model.sway_model import SwayModel
from tree_sway.core.run.bank import Bank
from tree_sway.core.run.coupled_step import coupled_step, CoupledStep, find_force, move
from tree_sway.core.run.dense import copy, largest, multiply, multiply_rows
from tree_sway.core.run.middles import Middles
from tree_sway.core.run.modal_coordinates import ModalCoordinates
from tree_sway.core.run.numpy_table import NumpyTableBank
from tree_sway.core.run.pose_inertia import (
    AHEAD,
    BEHIND,
    centrifugal_force,
    COLUMNS,
    columns_due,
    HERE,
    inertia_at_rest,
    LEADING,
    load_of_forces,
    PoseInertia,
    renew_columns,
    return_to_rest,
    turn_along,
    turn_for_columns,
    twice_kinetic_energy,
    weight_potential,
)
from tree_sway.core.run.segment_drag import (
    damping_at_rest,
    fill_drag,
    segment_drag,
    SegmentDrag,
)
from tree_sway.core.run.table_model import Propagators, WindBasisBank

LONGEST_PART, SHORTEST_PART, PART_IN_STORM = 0.04, 1.0 / 240.0, 5.0
"""
Longest part of a step [s]; in strong wind it is the last [m^2/s] over the square of the speed, but
no shorter than the second. In longer ones whips rattle, for the drag of a step is found at the
motion that the last step's force predicts.
"""

MOST_PARTS = 1000
"""Largest number of parts of a step."""

FASTEST_TURN = 40.0
"""
Largest rate of the rotation of a branch [rad/s]: without it twigs outrun a storm of 80 m/s that
comes at once. Turbulence up to 30 m/s does not reach it.
"""

NOT_FINITE = -1
"""Result of a step after which the motion is not finite."""

SLACK = 0.05
"""
Share of the energy that the tree may gain of what it has lost: that of a motion without damping
rises and falls by the error of a step.
"""


class LimpMotion(NamedTuple):
    """
    Shapes of a limp tree, its state, and memory that the parts of a step share.

    Arrays are of coordinates, (m,), where no other shape is given; N is the number of key
    rotations.
    """

    stiffness: Floats
    by_key: Floats
    """Shapes, (N, m)."""
    eta: Floats
    """Coordinates, of the state."""
    rate: Floats
    """Their rates, of the state."""
    force: Floats
    """Force of the last step, of the state."""
    last_eta: Floats
    """Coordinates as the last step left them."""
    last_rate: Floats
    """Rates as the last step left them."""
    middle: Floats
    """Coordinates and rates at the middle of the step, (2, m)."""
    rotations: Floats
    """Key rotations there and their rates, then those at the end of the step, (2, N)."""
    by_wind: Floats
    """Force of the wind."""
    wanted: Floats
    """Force of wind and weight, of the instance."""
    across: Floats
    """Centrifugal force on the leading coordinates, (q,)."""
    momentum: Floats
    """Momentum of the leading coordinates over twice the kinetic energy, (q,)."""
    new: Floats
    """Coordinates and rates after the step, (2, m)."""
    new_force: Floats
    """Force of the step."""


def motion_of(model: SwayModel, leading: int) -> LimpMotion:
    """Make room for the motion of a limp tree with a number of leading coordinates."""
    n_rotations, m = model.shapes.shape
    room = {name: np.zeros(m) for name in LimpMotion._fields}
    room |= {name: np.zeros((2, m)) for name in ('middle', 'new')}
    room['rotations'] = np.zeros((2, n_rotations))
    room |= {name: np.zeros(leading) for name in ('across', 'momentum')}
    room['by_key'] = np.ascontiguousarray(model.shapes)
    return LimpMotion(**room)


class LimpStep:
    """The step of a limp tree, a base of the bank that has its coordinates."""

    is_plain: bool
    branches: Records
    leading = LEADING
    """Largest number of coordinates whose inertia is that of the pose."""
    longest_part = LONGEST_PART
    """Longest part of a step [s]."""

    def begin(self, model: SwayModel, bank: Bank) -> None:
        """Prepare the law of a model, by a bank that places it."""
        mass = model.segment_mass
        down = np.multiply.outer(np.sqrt(mass), [0.0, 0.0, -model.settings.gravity]).ravel()
        self.middles = Middles(bank, mass, model.tree.length)
        q = min(self.leading, len(model.stiffness))
        self.pose = inertia_at_rest(self.middles, model.shapes, down, model.weight_slopes, q)
        self.limp_motion = motion_of(model, len(self.pose.change))
        self.segments = segment_drag(model, self.branches, self.middles.tangent)
        self._drag = damping_at_rest(self.segments, self.pose.columns_at_rest)
        """Damping of each coordinate by still air, per drag and speed, (m,)."""
        self._laws: dict[int, CoupledStep] = {}
        """Coefficients by the number of parts of a step."""
        self._entries: dict[Callable[..., Any], Callable[..., Any]] = {}
        self.begin_anew()

    def begin_anew(self) -> None:
        """Return to rest; what the bank has of the state is its own."""
        self._next_column = 0
        self.limp_motion.last_eta[:] = 0.0
        self.limp_motion.last_rate[:] = 0.0
        return_to_rest(self.pose)
        self._forget()

    def _forget(self) -> None:
        """Bound the energy from the next step on: something else than the wind has changed it."""
        self._allowed = math.inf

    def take_step(self, modal: ModalCoordinates, swing: tuple[Floats, ...], dt: float) -> None:
        """
        Take a time step.

        Parameters
        ----------
        modal
            Coordinates.
        swing
            Memory of coordinates, rates and forces, (m,).
        dt
            Length of the step [s].

        """
        if not np.array_equal(modal.stiffness, self.limp_motion.stiffness):
            self.limp_motion.stiffness[:] = modal.stiffness
            self._forget()
        self._modal = modal
        self._dt = dt
        self._laws.clear()
        eta, rate, force = swing
        self.limp_motion = self.limp_motion._replace(eta=eta, rate=rate, force=force)

    def n_parts(self, speed: float) -> int:
        """Return in how many parts a step is taken in a wind [m/s]."""
        in_storm = PART_IN_STORM / max(speed * speed, 1.0)
        longest = min(self.longest_part, max(in_storm, SHORTEST_PART))
        return math.ceil(min(max(self._dt / longest - 1e-9, 1.0), MOST_PARTS))

    def _law_of(self, n_parts: int) -> CoupledStep:
        """Return the coefficients of a part of a step."""
        law = self._laws.get(n_parts)
        if law is None:
            part = self._dt / n_parts
            modal = self._modal
            over = Propagators(modal.damping, modal.stiffness, *modal.propagators(part))
            law = coupled_step(over, self._drag, len(self.pose.change), part)
            self._laws[n_parts] = law
        return law

    def step_at_pose(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """
        Step with the inertia and the loads of the pose in a wind [m/s].

        Returns how many of its parts were bounded, or `NOT_FINITE`.
        """
        speed = math.sqrt(wx * wx + wy * wy + wz * wz)
        n_parts = self.n_parts(speed)
        law = self._law_of(n_parts)
        pose = self.pose
        motion = self.limp_motion
        air = wx, wy, wz, per_speed_squared, speed
        n_bounded = 0
        for _ in range(n_parts):
            first = self._next_column
            count, ahead, is_disturbed = self._run(_turn_to_middle, law, pose, motion, first)
            if is_disturbed:
                self._forget()
            self._next_column = (first + count) % len(pose.columns)
            self.middles.fill(pose.turned, pose.placed, COLUMNS + count)
            n_bounded += self._run(
                _step_from_middle, law, pose, motion, self.segments, first, count, ahead, *air
            )
            self.middles.fill(pose.turned, pose.placed, 1)
            self._allowed = self._run(_end_step, pose, motion, self._allowed)
            if math.isnan(self._allowed):
                return NOT_FINITE
        return n_bounded

    def _run(self, kernel: Any, *arguments: Any) -> Any:
        """Run a kernel, as plain Python on a tree in numpy."""
        entry = self._entries.get(kernel)
        if entry is None:
            entry = kernel.py_func if self.is_plain else entry_of(kernel, *arguments)
            self._entries[kernel] = entry
        return entry(*arguments)


class LimpBank(LimpStep, WindBasisBank):
    """A limp tree that has a table, by which it is stepped where coordinates are hidden."""

    def set_step(self, dt: float) -> None:
        """Refill the coefficients for a time step [s]."""
        self.take_step(self.modal, self.swing, dt)
        super().set_step(dt)

    def advance(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """Advance one step, as `WindBasisBank.advance`."""
        return self.step_outside() if self._step_once(wx, wy, wz, per_speed_squared) else 0

    def stepping(
        self, wind: Floats, max_wind: float, law: DragLaw
    ) -> Callable[[float, float, float], int]:
        """Return a step as one call, as `WindBasisBank.stepping`."""
        return partial(self._step_in_wind, wind, max_wind, law)

    def reset(self) -> None:
        """Return to rest."""
        super().reset()
        self.begin_anew()

    def _step_in_wind(
        self, stored: Floats, max_wind: float, law: DragLaw, x: float, y: float, z: float
    ) -> int:
        """Check a wind [m/s] and step, as `table_model.step_in_wind`."""
        is_refused = not math.sqrt(x * x + y * y + z * z) <= max_wind
        if not is_refused:
            stored[:] = x, y, z
        wx, wy, wz = stored.tolist()
        load = drag_density(math.sqrt(wx * wx + wy * wy + wz * wz), *law)
        return int(is_refused) + 2 * self._step_once(wx, wy, wz, load)

    def _step_once(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> bool:
        """Step in a wind [m/s]; returns whether the step was clamped, or is not finite."""
        if self.instance['left_out'][0]:
            return bool(self._step(wx, wy, wz, per_speed_squared))
        is_clamped = self.step_at_pose(wx, wy, wz, per_speed_squared) != 0
        instance = self.instance[0]
        instance['wind'] = (wx, wy, wz)
        instance['drag_density'] = per_speed_squared
        instance['outside'] = is_clamped
        instance['diagonal'] = 0.0
        return is_clamped

    def takes_gusts(self, gusts: Floats) -> bool:
        """
        Take the wind of each branch beside the mean wind [m/s], (b, 3), for the next step.

        Returns False where this step is by the table, which has uniform winds only.
        """
        if self.instance['left_out'][0]:
            return False
        self.segments.gust[:] = gusts[self.segments.branch]
        return True


class NumpyLimpBank(LimpBank, NumpyTableBank):
    """A limp tree in numpy."""


@fused
def _turn_to_middle(
    law: CoupledStep, pose: PoseInertia, motion: LimpMotion, first: int
) -> tuple[int, float, bool]:
    """
    Go to the middle of the step, and turn the tree there as `pose_inertia` needs it placed.

    Returns
    -------
    tuple
        How many columns to renew, from a first one on, the time [s] to the place ahead, and
        whether something else has changed the state since the last step.

    """
    apart = motion.new[0]
    rotations = motion.rotations
    is_disturbed = False
    turned = 0.0
    for i in range(len(apart)):
        apart[i] = motion.eta[i] - motion.last_eta[i]
        if apart[i] != 0.0 or motion.rate[i] != motion.last_rate[i]:
            is_disturbed = True
    if is_disturbed:
        multiply(motion.by_key, apart, rotations[0])
        turned = largest(rotations[0])
    move(law.half, motion.eta, motion.rate, motion.force, motion.middle[0], motion.middle[1])
    multiply_rows(motion.middle, motion.by_key, rotations)
    copy(rotations[0], pose.turned[HERE])
    fastest = largest(rotations[1])
    count = columns_due(pose, turned + law.length * fastest)
    ahead = turn_along(pose, rotations[1], fastest)
    turn_for_columns(pose, first, count)
    return count, ahead, is_disturbed


@fused
def _step_from_middle(
    law: CoupledStep, pose: PoseInertia, motion: LimpMotion, segments: SegmentDrag, first: int,
    count: int, ahead: float, wx: float, wy: float, wz: float, per_speed_squared: float,
    speed: float,
) -> bool:  # fmt: skip
    """
    Step under the load of the middle, where the tree is placed.

    Returns whether it would turn a branch too fast: then it goes a share of the way.
    """
    eta = motion.eta
    new_eta = motion.new[0]
    new_rate = motion.new[1]
    copy(motion.rate, new_rate)
    per_time = 0.5 / ahead if ahead > 0.0 else 0.0
    fill_drag(segments, pose.placed[AHEAD], pose.placed[BEHIND], per_time, wx, wy, wz)
    renew_columns(pose, first, count, motion.middle[0], new_rate)

    wanted = motion.wanted
    by_wind = motion.by_wind
    load_of_forces(pose, segments.force, by_wind)
    by_wind *= per_speed_squared
    copy(by_wind, wanted)
    leading = wanted[: len(pose.weight)]
    leading += pose.weight
    centrifugal_force(pose, motion.middle[1], ahead, motion.across, motion.momentum)
    find_force(
        law, wanted, eta, new_rate, motion.force, pose.change, per_speed_squared * speed,
        motion.across, motion.momentum, motion.new_force,
    )  # fmt: skip
    move(law.whole, eta, new_rate, motion.new_force, new_eta, new_rate)

    multiply_rows(motion.new, motion.by_key, motion.rotations)
    fastest = largest(motion.rotations[1])
    is_bounded = fastest > FASTEST_TURN
    if is_bounded:
        share = FASTEST_TURN / fastest
        for i in range(len(eta)):
            new_eta[i] = eta[i] + share * (new_eta[i] - eta[i])
        new_rate *= share
        multiply_rows(motion.new, motion.by_key, motion.rotations)
    copy(motion.rotations[0], pose.turned[HERE])
    return is_bounded


@fused
def _end_step(pose: PoseInertia, motion: LimpMotion, allowed: float) -> float:
    """
    Take the state after a step, where the tree is placed.

    The rates are scaled so that the tree gains no more energy than the work of the wind [J].
    Returns how much energy it may have before the work of the next step: what it has, or has lost
    before, up to `SLACK`; nan where the motion is not finite.
    """
    eta = motion.new[0]
    rate = motion.new[1]
    kinetic = 0.5 * twice_kinetic_energy(pose, rate, pose.momentum)
    moving = kinetic
    for i in range(len(eta)):
        moving += 0.5 * motion.stiffness[i] * eta[i] * eta[i]
        allowed += motion.by_wind[i] * (eta[i] - motion.eta[i])
    energy = moving + weight_potential(pose, eta)
    if energy > allowed:
        left = max(kinetic - (energy - allowed), 0.0)
        if kinetic > 0.0:
            rate *= math.sqrt(left / kinetic)
        energy += left - kinetic
    for i in range(len(eta)):
        motion.eta[i] = motion.last_eta[i] = eta[i]
        motion.rate[i] = motion.last_rate[i] = rate[i]
        motion.force[i] = motion.new_force[i]
    if not math.isfinite(energy):
        return math.nan
    return min(allowed, energy + SLACK * moving)
