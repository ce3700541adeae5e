# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree ready to be stepped and placed: its oscillators and its records."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any, NamedTuple, Protocol

import numpy as np

from tree_sway.core.arrays import Floats, Records, Singles
from tree_sway.core.kernel import entry_of, WHY_PLAIN
from tree_sway.core.model.drag_law import DragLaw


class Tunable(NamedTuple):
    """
    Arrays that a tuning writes, one number per oscillator, and their parts.

    ``weight`` is the part of the stiffness by gravity, negative where it softens; ``inertia`` is 1
    of modes; ``others`` are proportional to a power of the stiffness of the wood; ``loss`` is the
    damping ratio of each over that of the tree.
    """

    stiffness: Floats
    damping: Floats
    inertia: Floats | float
    weight: Floats
    others: tuple[tuple[Floats, float], ...] = ()
    loss: Floats | float = 1.0


class Oscillators(Protocol):
    """Protocol of all models: key rotations moved by a wind."""

    n_outside: int
    """Steps outside of its table, if it has one."""
    branches: Records
    shapes: Floats
    """Key rotations per unit of each coordinate, (N, m)."""

    @property
    def loads(self) -> Records | None:
        """Return the records of `load_layout`; None for a model of uniform winds."""

    @property
    def tunable(self) -> Tunable:
        """Return the arrays that change with stiffness, damping and gravity."""

    def set_step(self, dt: float) -> None:
        """Refill the coefficients for a time step [s]."""

    def advance(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """Advance one step under a mean wind [m/s]; returns how many loads were clamped."""

    def stepping(
        self, wind: Floats, max_wind: float, law: DragLaw
    ) -> Callable[[float, float, float], int] | None:
        """Return a step as one compiled call of a wind's components [m/s], if there is one."""

    def step_outside(self) -> int:
        """Make the step that such a call could not make; returns the same as `advance`."""

    @property
    def to_place(self) -> tuple[Records, Singles, Floats] | None:
        """Return the arguments by which `place` finds key rotations, if it does."""

    def memory(self) -> tuple[Floats, ...]:
        """Return views of the state."""

    def rotations(self) -> Floats:
        """Key rotations in [rad], (N,)."""

    def motion(self) -> tuple[Floats, Floats]:
        """Key rotations in [rad] and their rates in [rad/s], both (N,)."""

    def take_over(self, x: Floats, v: Floats) -> None:
        """Continue from key rotations and rates, (N,)."""

    def forces(self) -> Floats:
        """Force of the last step's wind on each branch in [N], (b, 3)."""

    def reset(self) -> None:
        """Return to rest."""


@dataclass(frozen=True)
class Bank:
    """
    A tree ready to be stepped and placed: oscillators, and records of branches, segments, blocks.

    ``mass`` is that of wood and leaves in [kg]; with ``plain`` nothing is compiled.
    """

    oscillators: Oscillators
    branches: Records
    segments: Records
    blocks: Records
    mass: float
    plain: bool = bool(WHY_PLAIN)
    doubt: str = ''
    """What makes its motion doubtful, a sentence."""

    @property
    def n_shown(self) -> int:
        """Number of coordinates that move; on a model without a table all."""
        oscillators: Any = self.oscillators
        return int(getattr(oscillators, 'n_shown', oscillators.shapes.shape[1]))

    def wind_moment(self) -> Floats:
        """Moment of the last step's wind on the tree at rest about its root node, [N m], (3,)."""
        coupling = self.branches['coupling']
        force = self.oscillators.forces()
        return np.asarray(np.einsum('bij,bj->i', coupling, force))

    @cached_property
    def bases(self) -> Floats:
        """Return memory for the bases of `place`, (b, 8)."""
        return np.zeros((len(self.branches), 8))

    @cached_property
    def place(self) -> Callable[[Floats, Floats, Floats], None]:
        """
        Place every segment by key rotations (N,) in [rad], from a root node (3,) on, (n, 7).

        Arrays are not checked: they must be contiguous, of float64 and of these shapes.
        """
        if self.plain:
            from tree_sway.core.run.numpy_placing import NumpyPlacing

            return NumpyPlacing(self.branches, self.segments).place
        from tree_sway.core.run.placing import GIVEN, room_for

        instance = (self.oscillators.to_place or GIVEN)[0]
        shapes = GIVEN[1]
        return self._placing(instance, shapes, room_for(int(self.branches['n_coordinates'].sum())))

    def _placing(self, instance: Records, shapes: Singles, x: Floats) -> Callable[..., None]:
        from tree_sway.core.run.placing import place

        arrays = instance, shapes, self.segments, self.blocks, self.bases
        first = *arrays, 1.0, 0.0, 1.0, x
        given = np.zeros(1), np.zeros(3), np.zeros((1, 7))
        return partial(entry_of(place, *first, *given), *first)

    @cached_property
    def place_now(self) -> Callable[[Floats, Floats], None]:
        """Place every segment by the present state, from a root node (3,) on, as `place`."""
        from tree_sway.core.run.placing import NONE

        oscillators = self.oscillators
        if oscillators.to_place is not None and not self.plain:
            return partial(self._placing(*oscillators.to_place), NONE)
        return lambda origin, out: self.place(oscillators.rotations(), origin, out)
