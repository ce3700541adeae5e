# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Model `wind_basis`: a tree as a dozen oscillators, driven by a table of all even winds.

What a step costs does not depend on the tree's size. The oscillators and the static rest are those
of `modes`, and so is the order of work: the load is that of the state half a step on. Only the
load comes from a table (`wind_basis_table`) and not from the branches. Where a wind or a lean
leaves the table, the step is one of `modes`, told by `outside`.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, partial
import math

import numpy as np
from numpy.typing import NDArray

from tree_sway_ros.core.arrays import Floats, Record, Records
from tree_sway_ros.core.kernel import entry_of, fused, inlined
from tree_sway_ros.core.motion.drag import DragLaw, pressure
from tree_sway_ros.core.motion.harmonics import COUNT, fill_harmonics
from tree_sway_ros.core.motion.lanes import add_shapes, shapes_together, TOGETHER, upper_halves
from tree_sway_ros.core.motion.modal import ModalBank
from tree_sway_ros.core.motion.placing import place
from tree_sway_ros.core.motion.wind_basis_force import (
    N_REST,
    pace_layout,
    table_layout,
    wind_force,
    wind_rest,
)
from tree_sway_ros.core.motion.wind_basis_table import GENTLE, STEEPEST, WindBasisTable


def instance_layout(n_modes: int, n_harmonics: int) -> np.dtype[np.void]:
    """State of one tree on a table, and scratch."""
    m = table_layout(n_modes, n_harmonics)['stiffness'].shape[0]
    return np.dtype(
        [
            ('outside', 'i8'),  # whether the last wind was outside of the table
            ('eta', 'f8', (m,)),
            ('rate', 'f8', (m,)),
            ('force', 'f8', (m,)),
            ('rest', 'f8', (N_REST,)),
            ('wind', 'f8', (3,)),  # [m/s]
            ('pressure', 'f8'),  # drag per area and speed squared [kg/m^3]
            ('middle', 'f8', (m,)),
            ('middle_rate', 'f8', (m,)),
            ('wanted', 'f8', (m,)),
            ('scratch', 'f8', (3, m)),
            ('values', 'f8', (n_harmonics,)),
            ('amounts', 'f8', (m + N_REST,)),  # of the modes and of the rest
        ]
    )


_pressure = inlined(pressure)

CARRIED = ('eta', 'rate', 'force', 'rest', 'middle', 'middle_rate', 'wind', 'pressure', 'outside')
"""Fields of an instance that a state holds."""


class WindBasisBank:
    """
    Oscillators of natural modes in even winds: a table of what the wind does to them.

    ``modal`` are the same modes on the loads of all branches.
    """

    carries = True
    is_tabled = True
    loads: Records | None = None

    def __init__(self, modal: ModalBank, table: WindBasisTable) -> None:
        """Stand at rest."""
        self.modal, self.table, self.table_error = modal, table, table.error
        self.branches, self.work, self.shapes = modal.branches, modal.work, modal.shapes
        n, m = modal.shapes.shape
        self.record, self.pace = table.record, np.zeros(1, dtype=pace_layout(m))
        layout = instance_layout(m, COUNT[int(table.record['degree'][0])])
        self.instance = np.zeros(1, dtype=layout)
        # Rounded where they are read most, and so everywhere.
        self.all_shapes = upper_halves(np.vstack([modal.shapes.T, table.rest_shapes]))
        filled = np.zeros((len(table.record['stiffness'][0]) - m, n))
        laid = [self.all_shapes[:m], filled, self.all_shapes[m:]]
        self.laid_shapes = shapes_together(np.vstack(laid))
        self._filled_x = self.room_for_rotations()
        self._x = self._filled_x[:n]
        self.n_outside = 0
        """Steps whose wind or lean was outside of the table."""

    def room_for_rotations(self) -> Floats:
        """Zeros for `expand` to write key rotations to, (N,) and some more."""
        return np.zeros(len(self.laid_shapes) * TOGETHER)

    def set_step(self, dt: float) -> None:
        """Refill what depends on the time step [s]."""
        self.modal.set_step(dt)
        fill_pace(self.pace[0], self.modal)

    def advance(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """Advance one step, as `ModalBank.advance`."""
        return self.step_outside() if self._step(wx, wy, wz, per_speed_squared) else 0

    def step_outside(self) -> int:
        """Step on the loads of the branches, in the wind that was last; returns as `advance`."""
        self.n_outside += 1
        return step_outside(self.instance[0], self.modal, self.all_shapes, self._x)

    @cached_property
    def _step(self) -> Callable[..., int]:
        arrays = self.record, self.pace, self.instance
        return partial(entry_of(_advance, *arrays, 0.0, 0.0, 0.0, 0.0), *arrays)

    def stepping(
        self, wind: Floats, max_wind: float, law: DragLaw
    ) -> Callable[[float, float, float], int]:
        """Return a step as one compiled call: `step_in_wind` of a wind's components in [m/s]."""
        arrays = self.record, self.pace, self.instance, np.array([max_wind, *law]), wind
        return partial(entry_of(step_in_wind, *arrays, 0.0, 0.0, 0.0), *arrays)

    def placing(
        self, segments: Records, heads: Records, bases: Floats
    ) -> Callable[[Floats, Floats], None]:
        """Return the placing of the state, a compiled call of a root node and a pose block."""
        arrays = (
            self.record, self.instance, self.laid_shapes, self._filled_x,
            self.branches, segments, heads, bases,
        )  # fmt: skip
        return partial(entry_of(place_one, *arrays, np.zeros(3), np.zeros((1, 7))), *arrays)

    @cached_property
    def _expand(self) -> Callable[[], None]:
        arrays = self.record, self.instance, self.laid_shapes, self._filled_x
        return partial(entry_of(expand_one, *arrays), *arrays)

    def response(self, moments: Floats, circular: Floats) -> NDArray[np.complex128]:
        """As `ModalBank.response`."""
        return self.modal.response(moments, circular)

    def memory(self) -> tuple[Floats, ...]:
        """Return views of what is carried from one step to the next."""
        return tuple(self.instance[name] for name in CARRIED)

    def rotations(self) -> Floats:
        """Key rotations in [rad], (N,)."""
        self._expand()
        return self._x

    def forces(self) -> Floats:
        """Force of the last step's wind on each branch [N], (b, 3); a pass over all branches."""
        m, now = self.modal.shapes.shape[1], self.instance[0]
        self.modal.take(now['eta'][:m], now['rate'][:m], now['force'][:m], self.rotations())
        wx, wy, wz = now['wind'].tolist()
        self.modal.advance(wx, wy, wz, float(now['pressure']))
        return self.modal.forces()

    def motion(self) -> tuple[Floats, Floats]:
        """Key rotations in [rad] and their rates in [rad/s], both (N,)."""
        m = self.modal.shapes.shape[1]
        return self.rotations().copy(), self.modal.shapes @ self.instance[0]['rate'][:m]

    def take_over(self, x: Floats, v: Floats) -> None:
        """Go on from key rotations and rates, (N,), as far as the modes can follow them."""
        self.reset()
        self.modal.take_over(x, v)
        m = self.modal.shapes.shape[1]
        self.instance['eta'][0, :m], self.instance['rate'][0, :m] = self.modal.modal[:2]

    def reset(self) -> None:
        """Go back to rest."""
        for array in self.memory():
            array[...] = 0.0
        self.modal.reset()


def fill_pace(pace: np.void, modal: ModalBank) -> None:
    """Take the coefficients of a time step over into a record of `pace_layout`."""
    m = modal.shapes.shape[1]
    pace['whole'], pace['half'] = 0.0, 0.0
    pace['whole'][:, :m] = modal.whole.T
    half = modal.half
    pace['half'][:, :m] = np.stack(
        [half[:, 0], half[:, 1], half[:, 2] + half[:, 3],
         half[:, 4], half[:, 5], half[:, 6] + half[:, 7]]
    )  # fmt: skip


def step_outside(instance: Record, modal: ModalBank, shapes: Floats, rotations: Floats) -> int:
    """
    Step a tree that is outside of its table on the loads of its branches, and write its rotations.

    Returns how many loads were held at their limit.
    """
    m = modal.shapes.shape[1]
    rotations[:] = instance['eta'][:m] @ shapes[:m] + instance['rest'] @ shapes[m:]
    wx, wy, wz = instance['wind'].tolist()
    load = float(instance['pressure'])
    modal.take(instance['eta'][:m], instance['rate'][:m], instance['force'][:m], rotations)
    held = modal.advance(wx, wy, wz, load)
    for row, name in enumerate(('eta', 'rate')):
        instance[name][:m] = modal.modal[row]
    instance['force'][:m] = modal.modal[3]
    rest = modal.rotations() - instance['eta'][:m] @ shapes[:m]
    instance['rest'] = np.linalg.lstsq(shapes[m:].T, rest, rcond=1e-10)[0]
    return held


@fused
def find_rest(table: Record, instance: Record) -> None:
    """Write the static rest of an instance, as of `expand`, in the wind of its last step."""
    if not instance.outside:
        wx, wy, wz = instance.wind[0], instance.wind[1], instance.wind[2]
        speed = math.sqrt(wx * wx + wy * wy + wz * wz)
        drag = instance.pressure * speed
        if speed > 0.0:
            fill_harmonics(wx / speed, wy / speed, wz / speed, table.degree, instance.values)
        wind_rest(
            table, wx, wy, drag * speed, drag, instance.middle, instance.middle_rate,
            instance.values, instance.rest,
        )  # fmt: skip


@fused
def expand(table: Record, instance: Record, shapes: Floats, x: Floats) -> None:
    """
    Key rotations (N,) of an instance: by its modes and by its static rest, which is written too.

    Shapes are those of the modes, then of the rest, as of `shapes_together`.
    """
    find_rest(table, instance)
    eta, rest, amounts = instance.eta, instance.rest, instance.amounts
    for k in range(len(eta)):
        amounts[k] = eta[k]
    for k in range(N_REST):
        amounts[len(eta) + k] = rest[k]
    for block in range(len(shapes)):
        add_shapes(shapes, block, amounts, x)


@fused
def place_one(
    tables: Records, instances: Records, shapes: Floats, x: Floats,
    branches: Records, segments: Records, heads: Records, bases: Floats,
    origin: Floats, out: Floats,
) -> None:  # fmt: skip
    """Do what `expand` does for the first record of each array, then what `place` does."""
    expand(tables[0], instances[0], shapes, x)
    place(branches, segments, heads, bases, x, origin, out)


@fused
def expand_one(tables: Records, instances: Records, shapes: Floats, x: Floats) -> None:
    """Do what `expand` does, for the first record of each array."""
    expand(tables[0], instances[0], shapes, x)


@fused
def step_instance(
    table: Record, pace: Record, instance: Record, is_held: bool,
    wx: float, wy: float, wz: float, per_speed_squared: float,
) -> int:  # fmt: skip
    """
    Step one tree on its table.

    Parameters
    ----------
    table, pace, instance
        Records of `table_layout`, `pace_layout` and `instance_layout`.
    is_held
        Whether the table is followed beyond what it was made for.
    wx, wy, wz
        Mean wind over the step in [m/s].
    per_speed_squared
        `drag.pressure` in [kg/m^3].

    Returns
    -------
    int
        1 where wind or lean is outside of the table: then the modes stay as they are.

    """
    speed = math.sqrt(wx * wx + wy * wy + wz * wz)
    x, y, z = 1.0, 0.0, 0.0
    if speed > 0.0:
        x, y, z = wx / speed, wy / speed, wz / speed
    push, drag = per_speed_squared * speed * speed, per_speed_squared * speed
    eta, rate, force, half, whole = (
        instance.eta, instance.rate, instance.force, pace.half, pace.whole,
    )  # fmt: skip
    middle, middle_rate, wanted = instance.middle, instance.middle_rate, instance.wanted
    energy = 0.0
    for i in range(len(eta)):
        q, v, f = eta[i], rate[i], force[i]
        middle[i] = half[0, i] * q + half[1, i] * v + half[2, i] * f
        middle_rate[i] = half[3, i] * q + half[4, i] * v + half[5, i] * f
        energy += table.stiffness[i] * middle[i] * middle[i]
    wind_force(
        table, x, y, z, push, drag, middle, middle_rate, instance.values, instance.scratch, wanted
    )
    instance.wind[0], instance.wind[1], instance.wind[2] = wx, wy, wz
    instance.pressure = per_speed_squared
    inside = push <= table.most_pressure and energy <= table.most_energy
    is_steep = abs(z) > STEEPEST and push > GENTLE * table.levels[1]
    instance.outside = 0 if is_held or (inside and not is_steep) else 1
    if instance.outside:
        return 1
    diagonal = instance.scratch[2]
    for i in range(len(eta)):
        # Implicit in the mode's own damping: stable for any wind and step.
        own = diagonal[i] * half[5, i]
        f = (wanted[i] - own * force[i]) / (1.0 - own)
        q, v = eta[i], rate[i]
        eta[i] = whole[0, i] * q + whole[1, i] * v + (whole[2, i] + whole[3, i]) * f
        rate[i] = whole[4, i] * q + whole[5, i] * v + (whole[6, i] + whole[7, i]) * f
        force[i] = f
    return 0


@fused
def _advance(
    tables: Records, paces: Records, instances: Records,
    wx: float, wy: float, wz: float, per_speed_squared: float,
) -> int:  # fmt: skip
    return step_instance(tables[0], paces[0], instances[0], False, wx, wy, wz, per_speed_squared)


@fused
def step_in_wind(
    tables: Records, paces: Records, instances: Records, limits: Floats, kept: Floats,
    x: float, y: float, z: float,
) -> int:  # fmt: skip
    """
    Take a wind and step the first record of each array.

    Parameters
    ----------
    tables, paces, instances
        As of `step_instance`.
    limits
        Speed above which a wind is refused in [m/s], then C, N and C0 of a `DragLaw`, (4,).
    kept
        The wind of the last step in [m/s], (3,); written unless the new one is refused.
    x, y, z
        The wind in [m/s].

    Returns
    -------
    int
        1 if the wind was refused, and 2 more where wind or lean is outside of the table.

    """
    refused = 1
    if math.sqrt(x * x + y * y + z * z) <= limits[0]:
        refused, kept[0], kept[1], kept[2] = 0, x, y, z
    x, y, z = kept[0], kept[1], kept[2]
    load = _pressure(math.sqrt(x * x + y * y + z * z), limits[1], limits[2], limits[3])
    return refused + 2 * step_instance(tables[0], paces[0], instances[0], False, x, y, z, load)
