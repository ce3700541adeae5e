# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The default model: a tree as a few oscillators, driven by a table of all uniform winds.

It is the one whose name is a number of coordinates, such as ``60``. The cost of a step does not
depend on the size of the tree. The coordinates cover most of the motion in steady winds and gusts
(`setup.modes.leading_modes`); each has its inertia, so that none follows a wind at once. The load
is that of the state at the middle of the step. It comes from a table (`load_table`) and not from
the branches. The law is on the page doc/sway_model.md. A wind or a lean beyond the table is
clamped to its limit, and counted as ``outside``.
"""

from __future__ import annotations

from collections.abc import Callable
from copy import copy
from functools import cached_property, partial
import math
from typing import NamedTuple, TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats, Records, Singles
from tree_sway.core.kernel import entry_of, fused, part
from tree_sway.core.model.drag_law import drag_density, DragLaw
from tree_sway.core.model.records import (
    Instance,
    instance_layout,
    Instances,
    Table,
    table_layout,
    Tables,
    time_step_layout,
    TimeStep,
    TimeSteps,
    zeros_in_lines,
)
from tree_sway.core.run.modal_coordinates import ModalCoordinates
from tree_sway.core.run.placing import expand, room_for
from tree_sway.core.run.simd import shapes_together, TOGETHER
from tree_sway.core.run.table_load import UniformWind, wind_force

if TYPE_CHECKING:
    from tree_sway.core.setup.static_responses import WindMoments

STATE_FIELDS = ('eta', 'rate', 'force', 'wind', 'drag_density', 'outside', 'left_out')
"""Fields of an instance that are its state."""

_BOUND = '_step', '_expand'
"""Compiled calls that are bound to the memory of a bank."""

MOST_PASSES = 8
"""Largest number of passes in which the force of a step is found."""

STRIDE, MOMENTUM = 1.5, 0.1
"""
Change of the force in a pass over that of the first, and the share of the change before it: a
heavy ball (Polyak 1964, USSR Computational Mathematics and Mathematical Physics 4, 1-17). Passes
converge where the load changes by less than ``2 (1 + MOMENTUM) / STRIDE`` of the bound.
"""


class WindBasisBank:
    """
    Oscillators of a tree in uniform winds, loaded by a table.

    ``modal`` are its coordinates, ``table`` is a `table_record`, (1,).
    """

    is_plain = False

    loads: Records | None = None

    def __init__(self, modal: ModalCoordinates, table: Records) -> None:
        """Begin at rest."""
        self.modal = modal
        self.table = table
        self.branches = modal.branches
        self.shapes = modal.shapes
        self.compliance = modal.compliance
        self.limit = modal.limit
        self.tunable = modal.tunable
        self.air_damping = modal.air_damping
        # Rounded everywhere, as kernels read them in single precision.
        self.all_shapes = modal.shapes.T.astype(np.float32).astype(np.float64)
        self.lay_out(modal.shapes.shape[1])
        self._filled_x = self.room_for_rotations()
        self._x = self._filled_x[: len(modal.shapes)]
        self._n_dropped = np.zeros(1, dtype=np.int64)
        self.n_outside = 0
        """Steps whose wind was clamped to the limit of the table."""

    def with_state(self, instance: Records) -> WindBasisBank:
        """Return the oscillators of another tree of this kind, whose state is given, (1,)."""
        other = copy(self)
        for compiled in _BOUND:
            other.__dict__.pop(compiled, None)
        other.instance = instance
        return other

    def lay_out(self, n_modes: int) -> None:
        """Lay the table out for a number of coordinates, that of the largest tree of a stand."""
        for compiled in _BOUND:
            self.__dict__.pop(compiled, None)
        table_record = self.table
        self.record = zeros_in_lines(1, table_layout(n_modes))
        for name in table_record.dtype.names or ():
            values = table_record[name]
            self.record[name][tuple(map(slice, values.shape))] = values
        self.time_step = np.zeros(1, dtype=time_step_layout(n_modes))
        self.instance = np.zeros(1, dtype=instance_layout(n_modes))
        self.laid_shapes = shapes_together(self.all_shapes)

    def show(self, hidden: Floats, count: int) -> None:
        """Show and load the first coordinates only, without a hidden part of each, (m,)."""
        self.instance['hidden'][0, : len(hidden)] = hidden
        self.instance['left_out'] = len(hidden) - count

    @property
    def n_shown(self) -> int:
        """Return the number of coordinates that are shown."""
        return self.shapes.shape[1] - int(self.instance['left_out'][0])

    @property
    def n_solved(self) -> int:
        """Return the number of coordinates that are solved, shown or not."""
        return self.shapes.shape[1] - int(self._n_dropped[0])

    def keep_only(self, count: int) -> None:
        """Solve the first coordinates only, from rest on, until `reset`."""
        come_to_rest(self.instance)
        self._n_dropped[0] = self.shapes.shape[1] - count
        self.instance['left_out'] = self._n_dropped[0]
        drop(self.time_step[0], count)

    @property
    def is_bent_too_far(self) -> bool:
        """Whether the last step clamped the tree in a wind that cannot bend it so far."""
        return bool(bent_too_far(self.instance, self.record['most_pressure'])[0])

    def room_for_rotations(self) -> Floats:
        """Return zeros for `expand` to write key rotations to, (N,) and some more."""
        return room_for(len(self.laid_shapes) * TOGETHER)

    def set_step(self, dt: float) -> None:
        """Refill the coefficients for a time step [s]."""
        self.modal.set_time_step(dt)
        fill_time_step(self.time_step[0], propagators_of(self.modal), dt)
        if self._n_dropped[0]:
            drop(self.time_step[0], self.n_solved)

    def advance(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """
        Advance one step under a mean wind [m/s], with `drag_law.drag_density` in [kg/m^3].

        Returns 1 if the step was clamped to the limit of the table, -1 if the motion is not
        finite, else 0.
        """
        return self.step_outside() if self._step(wx, wy, wz, per_speed_squared) else 0

    def step_outside(self) -> int:
        """Count a step beyond the table, clamped to its limit; -1 if the motion is not finite."""
        self.n_outside += 1
        return 1 if np.isfinite(self.instance['eta']).all() else -1

    @property
    def swing(self) -> tuple[Floats, ...]:
        """Displacement, rate and force of each coordinate, (m,)."""
        count = self.modal.shapes.shape[1]
        return tuple(self.instance[name][0, :count] for name in STATE_FIELDS[:3])

    @property
    def whole(self) -> Floats:
        """Coefficients of a force that is added to a step, (m, 8), as in `fill_propagator`."""
        time_step = self.time_step[0]
        count = self.modal.shapes.shape[1]
        # The step was implicit in the damping of each coordinate.
        implicit = 1.0 - self.instance['diagonal'][0, :count] * time_step['half'][5, :count]
        return np.asarray((time_step['whole'][:, :count] / implicit).T)

    @cached_property
    def _step(self) -> Callable[..., int]:
        arrays = self.record, self.time_step, self.instance
        return partial(entry_of(_advance, *arrays, 0.0, 0.0, 0.0, 0.0), *arrays)

    def stepping(
        self, wind: Floats, max_wind: float, law: DragLaw
    ) -> Callable[[float, float, float], int]:
        """Return a step as one compiled call: `step_in_wind` of a wind's components in [m/s]."""
        arrays = self.record, self.time_step, self.instance, np.array([max_wind, *law]), wind
        return partial(entry_of(step_in_wind, *arrays, 0.0, 0.0, 0.0), *arrays)

    @property
    def to_place(self) -> tuple[Records, Singles, Floats]:
        """Return instance, shapes and memory of the key rotations for `place`."""
        return self.instance, self.laid_shapes, self._filled_x

    @cached_property
    def _expand(self) -> Callable[[], None]:
        return partial(entry_of(expand, *self.to_place), *self.to_place)

    def memory(self) -> tuple[Floats, ...]:
        """Return views of the state."""
        return *(self.instance[name] for name in STATE_FIELDS), self._n_dropped

    def rotations(self) -> Floats:
        """Key rotations in [rad], (N,)."""
        self._expand()
        return self._x

    def rotations_of(self, instances: Records) -> Floats:
        """Key rotations in [rad], (N,), of a tree of this kind; valid until the next call."""
        expand(instances, self.laid_shapes, self._filled_x)
        return self._x

    def forces(self) -> Floats:
        """Force of the last step's wind on each branch as it is and moves now in [N], (b, 3)."""
        instance = self.instance[0]
        per_wind = self._wind_moments.forces(*self.motion(), instance['wind'])
        return np.asarray(float(instance['drag_density']) * per_wind)

    @cached_property
    def _wind_moments(self) -> WindMoments:
        from tree_sway.core.setup.static_responses import WindMoments

        return WindMoments(self.branches, plain=self.is_plain)

    def motion(self) -> tuple[Floats, Floats]:
        """Key rotations in [rad] and their rates in [rad/s], both (N,)."""
        shapes = self.modal.shapes
        return self.rotations().copy(), shapes @ self.instance[0]['rate'][: shapes.shape[1]]

    def take_over(self, x: Floats, v: Floats) -> None:
        """Continue from key rotations and rates, (N,), projected on the modes."""
        self.reset()
        displacements, rates, _ = self.swing
        displacements[:], rates[:] = self.modal.projected(x, v)

    def reset(self) -> None:
        """Return to rest."""
        for array in self.memory():
            array[...] = 0.0


def bent_too_far(instances: Records, most_pressure: Floats) -> NDArray[np.bool_]:
    """
    Whether the last step clamped each instance in a wind that cannot bend it so far, (t,).

    A table allows more energy than that of any of its winds: in half of their largest dynamic
    pressure [kg/m/s^2], (t,), a tree does not reach it but by growing motion, or by a pull.
    """
    wind = instances['wind']
    dynamic_pressure = instances['drag_density'] * np.einsum('ti,ti->t', wind, wind)
    return (instances['outside'] == 1) & (dynamic_pressure < 0.5 * most_pressure)


def come_to_rest(instances: Records) -> None:
    """Bring instances to rest: the motion and the force of a tree that is stuck are no state."""
    for name in ('eta', 'rate', 'force'):
        instances[name] = 0.0


def drop(time_step: np.void, count: int) -> None:
    """Write a step into a `time_step_layout` that puts all coordinates beyond a count to rest."""
    for name in ('whole', 'half'):
        time_step[name][:, count:] = 0.0


class Propagators(NamedTuple):
    """
    Damping [1/s] and stiffness [1/s^2] of coordinates, (m,), and their propagators.

    ``whole`` is over a step, ``half`` over half of it, (m, 8).
    """

    damping: Floats
    stiffness: Floats
    whole: Floats
    half: Floats


def propagators_of(modal: ModalCoordinates) -> Propagators:
    """Return the propagators of coordinates over their time step."""
    return Propagators(modal.damping, modal.stiffness, modal.whole, modal.half)


def fill_time_step(time_step: np.void, law: Propagators, dt: float) -> None:
    """
    Write the coefficients of a step of dt [s] and of half a step into a `time_step_layout`.

    A step moves each coordinate exactly. The load is taken from the state of `middle_of_step`.
    """
    m = len(law.stiffness)
    time_step['whole'] = 0.0
    time_step['half'] = 0.0
    time_step['whole'][:, :m] = law.whole.T
    time_step['half'][:, :m] = middle_of_step(law, dt)


def middle_of_step(law: Propagators, dt: float) -> Floats:
    """
    Return displacement and rate at the middle of a step by displacement, rate and force, (6, m).

    The load is taken from there, where the rate of a coordinate that swings nearly once a step or
    more may be opposite to its force. Strong drag, whose implicit part needs a rate that follows
    the force, would then feed the motion. The middle state of such coordinates is that of an
    implicit Euler step, whose rate always follows the force.
    """
    half = law.half.T[[0, 1, 2, 4, 5, 6]]
    half[[2, 5]] += law.half.T[[3, 7]]
    euler = _implicit_euler(law.damping, law.stiffness, 0.5 * dt)
    return np.where(half[5] < euler[5], euler, half)


def _implicit_euler(damping: Floats, stiffness: Floats, h: float) -> Floats:
    """Return displacement, then rate, after h [s] by displacement, rate and force, (6, m)."""
    share = 1.0 / (1.0 + h * damping + h * h * stiffness)
    rate = np.stack([-h * stiffness * share, share, h * share])
    displacement = h * rate
    displacement[0] += 1.0
    return np.concatenate([displacement, rate])


@part
def step_instance(
    table: Table, time_step: TimeStep, instance: Instance, is_clamped: bool,
    wx: float, wy: float, wz: float, per_speed_squared: float,
) -> int:  # fmt: skip
    """
    Step one tree on its table.

    Parameters
    ----------
    table, time_step, instance
        Records of `table_layout`, `time_step_layout` and `instance_layout`.
    is_clamped
        Whether the wind was clamped to the limit of the table before.
    wx, wy, wz
        Mean wind over the step in [m/s].
    per_speed_squared
        `drag_law.drag_density` in [kg/m^3].

    Returns
    -------
    int
        1 where the wind or the lean was clamped to the limit of the table, 0 elsewhere; a wind
        that was clamped before does not count.

    """
    speed = math.sqrt(wx * wx + wy * wy + wz * wz)
    ahead = 1.0
    aside = 0.0
    upwards = 0.0
    if speed > 0.0:
        ahead = wx / speed
        aside = wy / speed
        upwards = wz / speed
    dynamic_pressure = per_speed_squared * speed * speed
    instance.outside = 0 if is_clamped or dynamic_pressure <= table.most_pressure else 1
    dynamic_pressure = min(dynamic_pressure, table.most_pressure)
    energy_before = _to_middle(table, time_step, instance)
    wind = UniformWind(ahead, aside, upwards, dynamic_pressure, per_speed_squared)
    n_coupled = table.n_modes - instance.left_out
    wind_force(table, instance, wind, n_coupled)
    if _find_force(time_step, instance) > 0:
        for _ in range(_more_passes(time_step, instance)):
            _to_middle(table, time_step, instance)
            wind_force(table, instance, wind, n_coupled)
            _change_force(time_step, instance)
    instance.wind[0] = wx
    instance.wind[1] = wy
    instance.wind[2] = wz
    instance.drag_density = per_speed_squared
    energy = _step_coordinates(table, time_step, instance)
    # A pull may bend it more than any wind; no wind adds to that.
    most_energy = max(energy_before, table.most_energy)
    if not energy <= most_energy:
        _scale_motion(instance, math.sqrt(most_energy / energy))
        instance.outside = 1
    return int(instance.outside)


@part
def _to_middle(table: Table, time_step: TimeStep, instance: Instance) -> float:
    """Write the state at the middle of the step; return twice the energy before the step."""
    half = time_step.half
    middle = instance.middle
    middle_rate = instance.middle_rate
    energy = 0.0
    for mode in range(len(instance.eta)):
        eta = instance.eta[mode]
        rate = instance.rate[mode]
        force = instance.force[mode]
        energy += table.stiffness[mode] * eta * eta + rate * rate
        middle[mode] = half[0, mode] * eta + half[1, mode] * rate + half[2, mode] * force
        middle_rate[mode] = half[3, mode] * eta + half[4, mode] * rate + half[5, mode] * force
    return energy


@part
def _find_force(time_step: TimeStep, instance: Instance) -> int:
    """
    Find the force by that of the wind; return how many coordinates drag stops in half a step.

    The force is implicit in all damping, with equal rates of the other coordinates: stable for any
    wind and length of the step.
    """
    half = time_step.half
    n_stopped = 0
    for mode in range(len(instance.eta)):
        before = instance.force[mode]
        own = instance.diagonal[mode] * half[5, mode]
        force = (instance.wanted[mode] - own * before) / (1.0 - own)
        instance.force[mode] = force
        instance.change[mode] = force - before
        n_stopped += own < -1.0
    return n_stopped


@part
def _more_passes(time_step: TimeStep, instance: Instance) -> int:
    """
    Return how many more passes the force of a step takes.

    Bounded by the damping of all coordinates, the force lags behind the wind where drag stops a
    coordinate within half a step: light leaves on thin petioles. Twice the drag takes one more.
    """
    passes = 0
    stiffest = 0.0
    for mode in range(len(instance.eta)):
        stiffest = max(stiffest, -instance.diagonal[mode] * time_step.half[5, mode])
    while stiffest > 1.0 and passes < MOST_PASSES - 1:
        stiffest *= 0.5
        passes += 1
    return passes


@part
def _change_force(time_step: TimeStep, instance: Instance) -> None:
    """Change the force towards that of the wind in the motion which it makes itself."""
    half = time_step.half
    change = instance.change
    for mode in range(len(instance.eta)):
        bound = 1.0 - instance.diagonal[mode] * half[5, mode]
        lacking = (instance.wanted[mode] - instance.force[mode]) / bound
        change[mode] = STRIDE * lacking + MOMENTUM * change[mode]
        instance.force[mode] += change[mode]


@part
def _step_coordinates(table: Table, time_step: TimeStep, instance: Instance) -> float:
    """Step the coordinates under their forces; return twice the energy after the step."""
    whole = time_step.whole
    energy = 0.0
    for mode in range(len(instance.eta)):
        force = instance.force[mode]
        eta = instance.eta[mode]
        rate = instance.rate[mode]
        by_force = whole[2, mode] + whole[3, mode]
        rate_by_force = whole[6, mode] + whole[7, mode]
        new_eta = whole[0, mode] * eta + whole[1, mode] * rate + by_force * force
        new_rate = whole[4, mode] * eta + whole[5, mode] * rate + rate_by_force * force
        instance.eta[mode] = new_eta
        instance.rate[mode] = new_rate
        energy += table.stiffness[mode] * new_eta * new_eta + new_rate * new_rate
    return energy


@part
def _scale_motion(instance: Instance, scale: float) -> None:
    for mode in range(len(instance.eta)):
        instance.eta[mode] *= scale
        instance.rate[mode] *= scale


@fused
def _advance(
    tables: Tables, time_steps: TimeSteps, instances: Instances,
    wx: float, wy: float, wz: float, per_speed_squared: float,
) -> int:  # fmt: skip
    return step_instance(
        tables[0], time_steps[0], instances[0], False, wx, wy, wz, per_speed_squared
    )


@fused
def step_in_wind(
    tables: Tables, time_steps: TimeSteps, instances: Instances, limits: Floats, stored: Floats,
    x: float, y: float, z: float,
) -> int:  # fmt: skip
    """
    Check a wind and step the first record of each array.

    Parameters
    ----------
    tables, time_steps, instances
        Records, as in `step_instance`.
    limits
        Speed above which a wind is refused in [m/s], then C, N and C0 of a `DragLaw`, (4,).
    stored
        The wind of the last step in [m/s], (3,); written unless the new one is refused.
    x, y, z
        Components of the wind in [m/s].

    Returns
    -------
    int
        Sum of 1 if the wind was refused, and 2 if it was clamped to the limit of the table.

    """
    is_refused = not math.sqrt(x * x + y * y + z * z) <= limits[0]
    if not is_refused:
        stored[0] = x
        stored[1] = y
        stored[2] = z
    used_x = stored[0]
    used_y = stored[1]
    used_z = stored[2]
    speed = math.sqrt(used_x * used_x + used_y * used_y + used_z * used_z)
    load = drag_density(speed, limits[1], limits[2], limits[3])
    is_outside = step_instance(
        tables[0], time_steps[0], instances[0], False, used_x, used_y, used_z, load
    )
    return int(is_refused) + 2 * is_outside
