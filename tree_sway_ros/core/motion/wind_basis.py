"""
Model `wind_basis`: a tree as a dozen oscillators, driven by a table of all even winds.

What a step costs does not depend on the tree's size. The oscillators and the static rest are those
of `modes`, and so is the order of work: the load is that of the state half a step on. Only the load
comes from a table (`wind_basis_table`) and not from the branches. Where a wind or a lean leaves the
table, the step is one of `modes`, told by `outside`.

"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.kernel import fused
from tree_sway_ros.core.motion.harmonics import COUNT, fill_harmonics
from tree_sway_ros.core.motion.modal import ModalBank
from tree_sway_ros.core.motion.wind_basis_table import (
    N_AZIMUTHS,
    N_LEVELS,
    N_REST,
    STEEPEST,
    WindBasisTable,
    table_layout,
)


def instance_layout(n_modes: int, n_harmonics: int) -> np.dtype[np.void]:
    """State of one tree on a table, and room to work in."""
    m = table_layout(n_modes, n_harmonics)["stiffness"].shape[0]
    return np.dtype(
        [
            ("table", "i8"),  # its row among the tables
            ("outside", "i8"),  # whether the last wind was outside of the table
            ("eta", "f8", (m,)),
            ("rate", "f8", (m,)),
            ("force", "f8", (m,)),
            ("rest", "f8", (N_REST,)),
            ("wind", "f8", (3,)),  # [m/s]
            ("pressure", "f8"),  # drag per area and speed squared [kg/m^3]
            ("middle", "f8", (m,)),
            ("middle_rate", "f8", (m,)),
            ("wanted", "f8", (m,)),
            ("room", "f8", (3, m)),
            ("values", "f8", (n_harmonics,)),
        ]
    )


class WindBasisBank:
    """
    Oscillators of natural modes in even winds.

    Parameters
    ----------
    modal
        The same modes on the loads of all branches.
    table
        What the wind does to them.

    """

    carries = True

    def __init__(self, modal: ModalBank, table: WindBasisTable) -> None:
        """Stand at rest."""
        self.modal, self.table = modal, table
        self.branches, self.work, self.shapes = modal.branches, modal.work, modal.shapes
        n, m = modal.shapes.shape
        self._record = table.record
        layout = instance_layout(m, COUNT[int(table.record["degree"][0])])
        self.instance = np.zeros(1, dtype=layout)
        self._shapes = np.vstack([modal.shapes.T, table.rest_shapes])
        self._x = np.zeros(n)
        self.n_outside = 0
        """Steps whose wind or lean was outside of the table."""

    def set_step(self, dt: float) -> None:
        """Refill what depends on the time step [s]."""
        self.modal.set_step(dt)
        set_table_step(self._record[0], self.modal)

    def advance(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """Advance one step, as `ModalBank.advance`."""
        if not _advance(self._record, self.instance, wx, wy, wz, per_speed_squared):
            return 0
        self.n_outside += 1
        return step_outside(self.instance[0], self.modal, self.rotations())

    def response(self, moments: Floats, circular: Floats) -> NDArray[np.complex128]:
        """As `ModalBank.response`."""
        return self.modal.response(moments, circular)

    def memory(self) -> tuple[Floats, ...]:
        """Views of what is carried from one step to the next."""
        return tuple(self.instance[name] for name in ("eta", "rate", "force", "rest"))

    def rotations(self) -> Floats:
        """Key rotations in [rad], (N,)."""
        expand(self._shapes, self.modal.shapes.shape[1], self.instance[0], self._x)
        return self._x

    def reset(self) -> None:
        """Go back to rest."""
        for array in self.memory():
            array[...] = 0.0
        self.modal.reset()


def set_table_step(table: Any, modal: ModalBank) -> None:
    """Take the coefficients of a time step over into a record of `table_layout`."""
    m = int(table["n_modes"])
    table["whole"], table["half"] = 0.0, 0.0
    table["whole"][:, :m] = modal.whole.T
    half = modal.half
    table["half"][:, :m] = np.stack(
        [half[:, 0], half[:, 1], half[:, 2] + half[:, 3],
         half[:, 4], half[:, 5], half[:, 6] + half[:, 7]]
    )  # fmt: skip


def step_outside(instance: Any, modal: ModalBank, rotations: Floats) -> int:
    """
    Step a tree that is outside of its table on the loads of its branches.

    Returns
    -------
    int
        How many loads were held at their limit.

    """
    m = modal.shapes.shape[1]
    wx, wy, wz = instance["wind"].tolist()
    load = float(instance["pressure"])
    modal.take(instance["eta"][:m], instance["rate"][:m], instance["force"][:m], rotations)
    held = modal.advance(wx, wy, wz, load)
    for row, name in enumerate(("eta", "rate")):
        instance[name][:m] = modal.modal[row]
    instance["force"][:m] = modal.modal[3]
    return held


@fused
def expand(shapes: Floats, n_modes: int, instance: Any, x: Floats) -> None:
    """
    Key rotations of an instance: by its modes and by its static rest.

    Parameters
    ----------
    shapes
        Of the modes, then of the rest, (m + r, N).
    n_modes
        m.
    instance
        Record of `instance_layout`.
    x
        Written, (N,).

    """
    x[:] = 0.0
    for k in range(n_modes):
        amount = instance.eta[k]
        for i in range(len(x)):
            x[i] += shapes[k, i] * amount
    for k in range(N_REST):
        amount = instance.rest[k]
        for i in range(len(x)):
            x[i] += shapes[n_modes + k, i] * amount


@fused
def table_force(
    tables: Any, x: float, y: float, z: float, push: float, drag: float,
    eta: Floats, rate: Floats, values: Floats, room: Floats, force: Floats, rest: Floats,
) -> None:  # fmt: skip
    """As `_force`, of the first table, for those who try it."""
    _force(tables[0], x, y, z, push, drag, eta, rate, values, room, force, rest)


@fused
def _force(
    table: Any, x: float, y: float, z: float, push: float, drag: float,
    eta: Floats, rate: Floats, values: Floats, room: Floats, force: Floats, rest: Floats,
) -> None:  # fmt: skip
    """
    Find the modal forces of an even wind.

    Parameters
    ----------
    table
        Record of `table_layout`.
    x, y, z
        Where the wind goes, a unit vector.
    push, drag
        Dynamic pressure ``p U^2`` in [kg/m/s^2] and ``p U`` in [kg/m^2/s].
    eta, rate
        Modes and their rates, (m,).
    values, room
        To work in, (h,) and (3, m); the last of these gets the diagonal of the damping.
    force, rest
        Modal forces (m,) and amounts of the shapes of the static rest, (r,), written.

    """
    m = len(eta)
    fill_harmonics(x, y, z, table.degree, values)
    turn = math.atan2(y, x) * (0.5 / math.pi) * N_AZIMUTHS
    whole = math.floor(turn)
    share = turn - whole
    first = int(whole) % N_AZIMUTHS
    second = (first + 1) % N_AZIMUTHS
    lean = 0.0
    for i in range(m):
        weight = (1.0 - share) * table.amount[first, i] + share * table.amount[second, i]
        lean += weight * eta[i]
    j = 0
    while j < N_LEVELS - 2 and lean > table.levels[j + 1]:
        j += 1
    up = (lean - table.levels[j]) / (table.levels[j + 1] - table.levels[j])
    a, b, c, d = (1.0 - share) * (1.0 - up), (1.0 - share) * up, share * (1.0 - up), share * up
    off, damp, diagonal = room[0], room[1], room[2]
    for i in range(m):
        static = (1.0 - share) * table.static[first, i] + share * table.static[second, i]
        off[i] = eta[i] - lean * static
        excess = (1.0 - share) * table.excess[first, i] + share * table.excess[second, i]
        force[i] = (
            a * table.load[first, j, i] + b * table.load[first, j + 1, i]
            + c * table.load[second, j, i] + d * table.load[second, j + 1, i]
            + (push - lean) * excess
        )  # fmt: skip
        damp[i] = 0.0
    for k in range(len(values)):
        for i in range(m):
            force[i] += values[k] * table.harmonics[k, i]
    for k in range(m):
        moved, slant, pace = off[k], z * eta[k], rate[k]
        for i in range(m):
            force[i] += moved * (
                a * table.turning[first, j, k, i] + b * table.turning[first, j + 1, k, i]
                + c * table.turning[second, j, k, i] + d * table.turning[second, j + 1, k, i]
            ) + slant * (
                (1.0 - share) * table.lean[first, k, i] + share * table.lean[second, k, i]
            )  # fmt: skip
            damp[i] += pace * (
                a * table.damping[first, j, k, i] + b * table.damping[first, j + 1, k, i]
                + c * table.damping[second, j, k, i] + d * table.damping[second, j + 1, k, i]
            )  # fmt: skip
    for i in range(m):
        force[i] = push * force[i] + drag * damp[i]
        diagonal[i] = drag * (
            a * table.damping[first, j, i, i] + b * table.damping[first, j + 1, i, i]
            + c * table.damping[second, j, i, i] + d * table.damping[second, j + 1, i, i]
        )  # fmt: skip
    for r in range(N_REST):
        amount = (
            a * table.rest[first, j, r] + b * table.rest[first, j + 1, r]
            + c * table.rest[second, j, r] + d * table.rest[second, j + 1, r]
        )  # fmt: skip
        for k in range(len(values)):
            amount += values[k] * table.rest_harmonics[k, r]
        rest[r] = push * amount


@fused
def step_instance(
    table: Any, instance: Any, wx: float, wy: float, wz: float, per_speed_squared: float
) -> int:
    """
    Step one tree on its table.

    Parameters
    ----------
    table, instance
        Records of `table_layout` and `instance_layout`.
    wx, wy, wz
        Mean wind over the step in [m/s].
    per_speed_squared
        `drag.pressure` in [kg/m^3].

    Returns
    -------
    int
        1 where wind or lean is outside of the table: then only wind and rest are written.

    """
    speed = math.sqrt(wx * wx + wy * wy + wz * wz)
    x, y, z = 1.0, 0.0, 0.0
    if speed > 0.0:
        x, y, z = wx / speed, wy / speed, wz / speed
    push, drag = per_speed_squared * speed * speed, per_speed_squared * speed
    eta, rate, force, half, whole = (
        instance.eta, instance.rate, instance.force, table.half, table.whole,
    )  # fmt: skip
    middle, middle_rate, wanted = instance.middle, instance.middle_rate, instance.wanted
    energy = 0.0
    for i in range(len(eta)):
        q, v, f = eta[i], rate[i], force[i]
        middle[i] = half[0, i] * q + half[1, i] * v + half[2, i] * f
        middle_rate[i] = half[3, i] * q + half[4, i] * v + half[5, i] * f
        energy += table.stiffness[i] * middle[i] * middle[i]
    _force(
        table, x, y, z, push, drag, middle, middle_rate, instance.values, instance.room,
        wanted, instance.rest,
    )  # fmt: skip
    instance.wind[0], instance.wind[1], instance.wind[2] = wx, wy, wz
    instance.pressure = per_speed_squared
    inside = push <= table.most_pressure and energy <= table.most_energy
    instance.outside = 0 if inside and abs(z) * push <= STEEPEST * push else 1
    if instance.outside:
        return 1
    diagonal = instance.room[2]
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
    tables: Any, instances: Any, wx: float, wy: float, wz: float, per_speed_squared: float
) -> int:
    return step_instance(tables[0], instances[0], wx, wy, wz, per_speed_squared)
