# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The default model: a tree as a few oscillators, driven by a table of all uniform winds.

It is the one whose name is a number of coordinates, such as ``60``. The cost of a step does not
depend on the size of the tree. The coordinates cover most of the motion in steady winds and gusts
(`setup.modes.leading_modes`); each has its inertia, so that none follows a wind at once. The load
is that of the state at the middle of the step. It comes from a table (`load_table`) and not from
the branches. The law is on the page doc/sway_model.md, and in ``native/table.h``. A wind or a lean
beyond the table is clamped to its limit, and counted as ``outside``.
"""

from __future__ import annotations

from copy import copy
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.model import SwayModel
from tree_sway.core.native import NativeStand, States
from tree_sway.core.run.modal_coordinates import ModalCoordinates
from tree_sway.core.run.outcome import Outcome

if TYPE_CHECKING:
    from tree_sway.core.setup import WindMoments

STATE_FIELDS = ('eta', 'rate', 'force', 'wind', 'drag_density', 'is_clamped', 'left_out')
"""Fields of a tree that are its state."""


class TableOscillators:
    """
    Oscillators of a tree in uniform winds, loaded by a table.

    Parameters
    ----------
    model
        Prepared model of the tree.
    stand
        Stand of the native core whose first tree it is.

    """

    loads: Records | None = None

    def __init__(self, model: SwayModel, stand: NativeStand) -> None:
        self.modal = modal = ModalCoordinates(model)
        """The coordinates, of all trees of a kind."""
        self.stand = stand
        self.number = 0
        self.shapes = modal.shapes
        self._count = modal.shapes.shape[1]
        self.compliance = modal.compliance
        self.limit = modal.limit
        self.tunable = modal.tunable
        self._x = np.zeros(len(modal.shapes))
        self.n_outside = 0
        """Steps whose wind was clamped to the limit of the table."""

    def of_tree(self, stand: NativeStand, number: int) -> TableOscillators:
        """Return the oscillators of another tree of this kind."""
        other = copy(self)
        other.__dict__.pop('swing', None)
        other.stand = stand
        other.number = number
        return other

    @property
    def branches(self) -> Records:
        """Records of the branches, (b,)."""
        return self.modal.branches

    @property
    def most_pressure(self) -> float:
        """Largest dynamic pressure of the table [kg/m/s^2]."""
        return self.modal.model.most_pressure

    @property
    def all_shapes(self) -> Floats:
        """Shapes by coordinate, (m, N), rounded to single precision as in the native core."""
        return self.shapes.T.astype(np.float32).astype(np.float64)

    @property
    def _state(self) -> States:
        return self.stand.states

    def show(self, hidden: Floats, count: int) -> None:
        """Show and load the first coordinates only, without a hidden part of each, (m,)."""
        self._state.hidden[self.number, : len(hidden)] = hidden
        self._state.left_out[self.number] = len(hidden) - count

    @property
    def n_shown(self) -> int:
        """Return the number of coordinates that are shown."""
        return self._count - int(self._state.left_out[self.number])

    @property
    def n_solved(self) -> int:
        """Return the number of coordinates that are solved, shown or not."""
        return self._count - int(self._state.at_rest[self.number])

    def keep_only(self, count: int) -> None:
        """Solve the first coordinates only, from rest on, until `reset`."""
        come_to_rest(self._state, self.number)
        n_dropped = self._count - count
        self._state.at_rest[self.number] = n_dropped
        self._state.left_out[self.number] = n_dropped

    @property
    def is_bent_too_far(self) -> bool:
        """Whether the last step clamped the tree in a wind that cannot bend it so far."""
        found = bent_too_far(self._state, np.full(len(self._state.eta), self.most_pressure))
        return bool(found[self.number])

    def set_step(self, dt: float) -> None:
        """Refill the coefficients for a time step [s]."""
        self.modal.dt = dt
        self.stand.tune(0, self.modal.stiffness, self.modal.damping)
        self.stand.set_step(dt)

    def advance(self, wx: float, wy: float, wz: float) -> int:
        """
        Advance one step under a mean wind [m/s].

        Returns 1 if the step was clamped to the limit of the table, -1 if the motion was not
        finite and the tree came to rest, else 0.
        """
        stand = self.stand
        wind = stand.wind
        wind[0] = wx
        wind[1] = wy
        wind[2] = wz
        outcome = stand.step_first()
        if outcome == 0:
            return 0
        self.n_outside += 1
        return -1 if outcome & Outcome.RESTARTED else 1

    @cached_property
    def swing(self) -> tuple[Floats, ...]:
        """Displacement, rate and force of each coordinate, (m,)."""
        return tuple(
            getattr(self._state, name)[self.number, : self._count] for name in STATE_FIELDS[:3]
        )

    def per_force(self) -> Floats:
        """Displacement and rate by a force that is added to a step, (2, m)."""
        return self.modal.per_force(self._state.diagonal[self.number, : self._count])

    def memory(self) -> tuple[Floats, ...]:
        """Return views of the state."""
        own = slice(self.number, self.number + 1)
        names = (*STATE_FIELDS, 'at_rest', 'history')
        views = (getattr(self._state, name)[own] for name in names)
        return tuple(view for view in views if view.size)

    def rotations(self) -> Floats:
        """Key rotations in [rad], (N,); valid until the next call."""
        self.stand.keys(self.number, self._x)
        return self._x

    def forces(self) -> Floats:
        """Force of the last step's wind on each branch as it is and moves now in [N], (b, 3)."""
        wind = self._state.wind[self.number]
        per_wind = self._wind_moments.forces(*self.motion(), wind)
        return np.asarray(float(self._state.drag_density[self.number]) * per_wind)

    @cached_property
    def _wind_moments(self) -> WindMoments:
        from tree_sway.core.setup import WindMoments

        return WindMoments(self.branches)

    def motion(self) -> tuple[Floats, Floats]:
        """Key rotations in [rad] and their rates in [rad/s], both (N,)."""
        return self.rotations().copy(), self.shapes @ self.swing[1]

    def take_over(self, x: Floats, v: Floats) -> None:
        """Continue from key rotations and rates, (N,), projected on the modes."""
        self.reset()
        displacements, rates, _ = self.swing
        displacements[:], rates[:] = self.modal.projected(x, v)

    def reset(self) -> None:
        """Return to rest."""
        for array in self.memory():
            array[...] = 0.0


def bent_too_far(states: States, most_pressure: Floats) -> NDArray[np.bool_]:
    """
    Whether the last step clamped each tree in a wind that cannot bend it so far, (t,).

    A table allows more energy than that of any of its winds: in half of their largest dynamic
    pressure [kg/m/s^2], (t,), a tree does not reach it but by growing motion, or by a pull.
    """
    dynamic_pressure = states.drag_density * np.einsum('ti,ti->t', states.wind, states.wind)
    return (states.is_clamped == 1.0) & (dynamic_pressure < 0.5 * most_pressure)


def come_to_rest(states: States, number: int) -> None:
    """Bring a tree to rest: the motion and the force of a tree that is stuck are no state."""
    for rows in (states.eta, states.rate, states.force):
        rows[number] = 0.0
