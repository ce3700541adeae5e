# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Step of a limp tree: one whose twigs turn so far that neither load nor inertia is that of a table.

Its coordinates are those of the model with a table. Their load is that of every segment
(`segment_drag`), and their inertia and weight are those of the pose (`pose_inertia`):

    M(q) q'' + C q' + K q = F(wind, q, q') - centrifugal force + weight beyond the linear.

`coupled_step` solves it. **The table takes over** in storms, in long steps, of trees of which
coordinates are hidden, and for a second after a step that would have turned a branch too far: its
step is stable in any wind. Trees of a stand are stepped by the table too. The laboratory's model
`full` takes this step on all coordinates, and in place of a table the load on every branch.
"""

from __future__ import annotations

from collections.abc import Callable
import math
from typing import Any, NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.kernel import entry_of, fused, part, WHY_PLAIN
from tree_sway.core.model.drag_law import drag_density
from tree_sway.core.model.sway_model import SwayModel
from tree_sway.core.run.bank import Bank
from tree_sway.core.run.coupled_step import coupled_step, CoupledStep, find_force, move
from tree_sway.core.run.dense import copy, largest, multiply, multiply_rows
from tree_sway.core.run.middles import Middles
from tree_sway.core.run.modal_coordinates import FARTHEST, ModalCoordinates
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
from tree_sway.core.run.table_model import middle_of_step, TableOscillators
from tree_sway.core.vector import Vector
from tree_sway.core.wind.crown_wind import CrownWind

STRONG = 20.0, 25.0
"""
Winds [m/s] between which the step goes over to that of the table: in storms twigs stream along the
wind, and this step was not tried there.
"""

LONGEST_STEP, MOST_TURN = 0.04, 1.0
"""Longest step [s] at the pose, and the largest rotation of a branch in it [rad]."""

MOST_TURN_BY_TABLE = 0.5
"""
The same of a step of the table, to which it is bounded: in a storm that comes at once light shapes
of twigs would outrun the wind. In 80 m/s whips are then 0.50 from the truth in 6 s, formerly 0.56,
and birch 0.52 in the 3 frames that have a truth, formerly 0.36.
"""

PAUSE = 1.0
"""Time [s] that the table steps after a step that would have turned a branch too far."""

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
    """
    What a limp tree does in place of another step; a base of a bank of that step.

    The bank gives the step its coordinates (`take_step`), and makes the other one.
    """

    is_plain = bool(WHY_PLAIN)
    branches: Records
    leading = LEADING
    """Largest number of coordinates whose inertia is that of the pose."""
    most_energy = math.inf
    """Twice the energy [J] that no step gives; the work of the wind bounds it as well."""

    def step_otherwise(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """Make the other step; returns a number above 0 where it was clamped to its limit."""
        raise NotImplementedError

    def note_wind(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> None:
        """Note the wind of a step at the pose that is taken alone."""

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
        self._law: CoupledStep | None = None
        self._entries: dict[Callable[..., Any], Callable[..., Any]] = {}
        self.begin_anew()

    def begin_anew(self) -> None:
        """Return to rest; what the bank has of the state is its own."""
        self._pause = 0.0
        self._next_column = 0
        self.limp_motion.last_eta[:] = 0.0
        self.limp_motion.last_rate[:] = 0.0
        return_to_rest(self.pose)
        self._forget()

    def _forget(self) -> None:
        """Bound the energy from the next step on: something else than the wind has changed it."""
        self._allowed = math.inf

    def take_step(
        self, modal: ModalCoordinates, half: Floats, swing: tuple[Floats, ...], wanted: Floats,
        dt: float,
    ) -> None:  # fmt: skip
        """
        Take the coefficients of a time step [s].

        Parameters
        ----------
        modal
            Coordinates, with the propagators of this step.
        half
            Coefficients of half a step, (6, m).
        swing
            Memory of coordinates, rates and forces, (m,).
        wanted
            Memory for the force of wind and weight, (m,).
        dt
            Length of the step [s].

        """
        if not np.array_equal(modal.stiffness, self.limp_motion.stiffness):
            self.limp_motion.stiffness[:] = modal.stiffness
            self._forget()
        self._law = coupled_step(modal, half, self._drag, len(self.pose.change), dt)
        eta, rate, force = swing
        self.limp_motion = self.limp_motion._replace(
            eta=eta, rate=rate, force=force, wanted=wanted
        )

    def step_once(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """Step in a wind [m/s]; returns what the other step does, 0 where it was not made."""
        speed = math.sqrt(wx * wx + wy * wy + wz * wz)
        share = self.share_of_other(speed)
        law = self._law
        if share == 1.0 or law is None:
            self._forget()
            return self.step_otherwise(wx, wy, wz, per_speed_squared)
        if not self._step_at_pose(law, (wx, wy, wz), speed, per_speed_squared):
            self._pause = PAUSE
            self._forget()
            return self.step_otherwise(wx, wy, wz, per_speed_squared)
        outside = 0
        if share > 0.0:
            self._forget()
            outside = self.step_otherwise(wx, wy, wz, per_speed_squared)
        else:
            self.note_wind(wx, wy, wz, per_speed_squared)
        self._take(share)
        return outside

    def _take(self, share: float) -> None:
        """Take the step at the pose, but for the share of the other step."""
        motion = self.limp_motion
        state = (motion.eta, motion.rate, motion.force)
        new = (*motion.new, motion.new_force)
        for now, own in zip(state, new, strict=True):
            now[:] = own if share == 0.0 else own + share * (now - own)
        motion.last_eta[:], motion.last_rate[:] = motion.eta, motion.rate

    def share_of_other(self, speed: float) -> float:
        """Weight of the other step in a wind [m/s], 0 to 1."""
        if self._law is None or self._law.length > LONGEST_STEP:
            return 1.0
        self._pause = max(0.0, self._pause - self._law.length)
        by_wind = (speed - STRONG[0]) / (STRONG[1] - STRONG[0])
        return min(max(by_wind, self._pause / PAUSE, 0.0), 1.0)

    def _step_at_pose(
        self, law: CoupledStep, wind: Vector, speed: float, per_speed_squared: float
    ) -> bool:
        """
        Find coordinates, rates and force after a step with the inertia and the loads of the pose.

        Returns False where the step gives more energy than any wind does, or turns a branch too
        far.
        """
        pose = self.pose
        motion = self.limp_motion
        first = self._next_column
        count, ahead, is_disturbed = self._run(_turn_to_middle, law, pose, motion, first)
        if is_disturbed:
            self._forget()
        self._next_column = (first + count) % len(pose.columns)
        self.middles.fill(pose.turned, pose.placed, COLUMNS + count)
        load = per_speed_squared, per_speed_squared * speed
        is_possible: bool = self._run(
            _step_from_middle, law, pose, motion, self.segments, first, count, ahead, *wind,
            *load, self.most_energy,
        )  # fmt: skip
        if is_possible:
            self.middles.fill(pose.turned, pose.placed, 1)
            self._allowed = self._run(_bound_energy, pose, motion, self._allowed)
        return is_possible

    def _run(self, kernel: Any, *arguments: Any) -> Any:
        """Run a kernel, as plain Python on a tree in numpy."""
        entry = self._entries.get(kernel)
        if entry is None:
            entry = kernel.py_func if self.is_plain else entry_of(kernel, *arguments)
            self._entries[kernel] = entry
        return entry(*arguments)


class LimpOscillators(LimpStep, TableOscillators):
    """A limp tree whose other step is that of a table."""

    def begin(self, model: SwayModel, bank: Bank) -> None:
        """Prepare the law of a model, by a bank that places it."""
        super().begin(model, bank)
        self.most_energy = model.most_energy
        self._drag_law = model.drag_law
        self._crown: CrownWind | None = None
        if model.has_limbs:
            self._crown = CrownWind(float(model.limb_spread[0]), model.settings.crown_coherence)
            self._delay = model.limb_delay

    def set_step(self, dt: float) -> None:
        """Refill the coefficients for a time step [s]."""
        super().set_step(dt)
        half = middle_of_step(self.modal, dt)
        # Gusts that reach the limbs one after another are added by the force of the step.
        wanted = self._state.wanted[self.number, : len(self.modal.stiffness)]
        self.take_step(self.modal, half, self.swing, wanted, dt)

    def advance(self, wx: float, wy: float, wz: float) -> int:
        """Advance one step, as `TableOscillators.advance`."""
        speed = math.sqrt(wx * wx + wy * wy + wz * wz)
        if self._crown is not None and self._law is not None:
            apart = self._crown.push(wx, wy, wz, self._law.length)
            self._take_gusts(apart[self._delay], speed)
        return self.step_once(wx, wy, wz, drag_density(speed, *self._drag_law))

    def reset(self) -> None:
        """Return to rest."""
        super().reset()
        self.begin_anew()
        if self._crown is not None:
            self._crown.reset()

    def memory(self) -> tuple[Floats, ...]:
        """Return views of the state."""
        return *super().memory(), *(() if self._crown is None else self._crown.memory())

    def share_of_other(self, speed: float) -> float:
        """Weight of the table's step in a wind [m/s], 0 to 1."""
        return 1.0 if self._state.left_out[self.number] else super().share_of_other(speed)

    def _take_gusts(self, gusts: Floats, speed: float) -> None:
        """
        Take the wind of each branch beside the mean wind [m/s], (b, 3), for the next step.

        Where a part of this step is by the table, the native core adds them.
        """
        is_by_table = self._state.left_out[self.number] or self._pause > 0.0 or speed > STRONG[0]
        is_long = self._law is None or self._law.length > LONGEST_STEP
        is_at_pose = not (is_by_table or is_long)
        self.segments.gust[:] = gusts[self.segments.branch] if is_at_pose else 0.0

    def step_otherwise(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """Make the step of the table, as `TableOscillators.advance`."""
        eta, rate, _ = self.swing
        before = eta.copy()
        rotations = self.rotations().copy()
        outside = TableOscillators.advance(self, wx, wy, wz)
        turned = largest(self.rotations() - rotations)
        if turned > MOST_TURN_BY_TABLE:
            share = MOST_TURN_BY_TABLE / turned
            eta[:] = before + share * (eta - before)
            rate *= share
        return outside

    def note_wind(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> None:
        """Note the wind of a step at the pose that is taken alone."""
        state = self._state
        state.wind[self.number] = wx, wy, wz
        state.drag_density[self.number] = per_speed_squared
        state.is_clamped[self.number] = 0.0
        state.diagonal[self.number] = 0.0


@part
def _strain_energy(motion: LimpMotion, eta: Floats) -> float:
    """Return twice the energy of strain [J] at coordinates (m,)."""
    energy = 0.0
    for i in range(len(eta)):
        energy += motion.stiffness[i] * eta[i] * eta[i]
    return energy


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
    drag: float, most_energy: float,
) -> bool:  # fmt: skip
    """
    Step under the load of the middle, where the tree is placed.

    Returns whether the step gives no more energy than any wind [J], and turns no branch too far.
    """
    eta = motion.eta
    rate = motion.rate
    new_eta = motion.new[0]
    new_rate = motion.new[1]
    strain = _strain_energy(motion, eta)
    copy(rate, new_rate)
    per_time = 0.5 / ahead if ahead > 0.0 else 0.0
    fill_drag(segments, pose.placed[AHEAD], pose.placed[BEHIND], per_time, wx, wy, wz)
    kinetic = renew_columns(pose, first, count, motion.middle[0], new_rate)

    wanted = motion.wanted
    by_wind = motion.by_wind
    load_of_forces(pose, segments.force, by_wind)
    by_wind *= per_speed_squared
    copy(by_wind, wanted)
    leading = wanted[: len(pose.weight)]
    leading += pose.weight
    centrifugal_force(pose, motion.middle[1], ahead, motion.across, motion.momentum)
    find_force(
        law, wanted, eta, new_rate, motion.force, pose.change, drag, motion.across,
        motion.momentum, motion.new_force,
    )  # fmt: skip
    move(law.whole, eta, new_rate, motion.new_force, new_eta, new_rate)

    energy = _strain_energy(motion, new_eta) + twice_kinetic_energy(pose, new_rate, pose.momentum)
    multiply_rows(motion.new, motion.by_key, motion.rotations)
    copy(motion.rotations[0], pose.turned[HERE])
    has_turned = law.length * largest(motion.rotations[1])
    is_bounded = energy <= max(strain + kinetic, most_energy)
    return is_bounded and has_turned <= MOST_TURN and largest(motion.rotations[0]) <= FARTHEST


@fused
def _bound_energy(pose: PoseInertia, motion: LimpMotion, allowed: float) -> float:
    """
    Scale the rates after a step so that it gains no more energy than the work of the wind [J].

    The tree is placed where the step ends. Returns how much energy it may have before the work of
    the next step: what it has, or has lost before, up to `SLACK`.
    """
    eta = motion.new[0]
    rate = motion.new[1]
    kinetic = 0.5 * twice_kinetic_energy(pose, rate, pose.momentum)
    moving = kinetic + 0.5 * _strain_energy(motion, eta)
    energy = moving + weight_potential(pose, eta)
    for i in range(len(eta)):
        allowed += motion.by_wind[i] * (eta[i] - motion.eta[i])
    if energy > allowed:
        left = max(kinetic - (energy - allowed), 0.0)
        if kinetic > 0.0:
            rate *= math.sqrt(left / kinetic)
        energy += left - kinetic
    return min(allowed, energy + SLACK * moving)
