# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree ready to be stepped and placed: its oscillators, its branches and its native stand."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol

import numpy as np

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.model import SwayModel
from tree_sway.core.native import contiguous, NativeStand


class Tunable(NamedTuple):
    """
    Arrays that a tuning writes, one number per oscillator, and their parts.

    ``weight`` is the part of the stiffness by gravity, negative where it softens; ``inertia`` is 1
    of modes; ``unknown`` is the damping ratio that stands for wood which is not known
    (`unknown_wood`); ``others`` are proportional to a power of the stiffness of the wood;
    ``loss`` is the damping ratio of each over that of the tree.
    """

    stiffness: Floats
    damping: Floats
    inertia: Floats | float
    weight: Floats
    unknown: Floats
    others: tuple[tuple[Floats, float], ...] = ()
    loss: Floats | float = 1.0

    @property
    def critical(self) -> Floats:
        """Critical damping of each oscillator."""
        return np.asarray(2.0 * np.sqrt(self.stiffness * self.inertia))

    @property
    def of_wood(self) -> Floats:
        """Damping of each oscillator by its wood alone."""
        return np.asarray(self.damping - self.unknown * self.critical)

    def spread_wood(self, deviation: float) -> None:
        """Let the coordinates sway as the mean over trees whose wood has a log-deviation."""
        from tree_sway.core.run.unknown_wood import mean_damping

        own = self.of_wood / self.critical
        # The weight is known, and what stiffness is by it.
        share = np.abs(1.0 - self.weight / self.stiffness)
        mean = mean_damping(own, 0.5 * deviation * share)
        self.unknown[:] = mean - own
        self.damping[:] = mean * self.critical


class Oscillators(Protocol):
    """Protocol of all models: key rotations moved by a wind."""

    n_outside: int
    """Steps outside of its table, if it has one."""
    shapes: Floats
    """Key rotations per unit of each coordinate, (N, m)."""

    @property
    def loads(self) -> Records | None:
        """Return the records of `load_layout`; None for a model on a table."""

    @property
    def tunable(self) -> Tunable:
        """Return the arrays that change with stiffness, damping and gravity."""

    def set_step(self, dt: float) -> None:
        """Refill the coefficients for a time step [s]."""

    def advance(self, wx: float, wy: float, wz: float) -> int:
        """
        Advance one step under a mean wind [m/s].

        Returns how many loads were clamped; -1 if the motion was not finite.
        """

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
    A tree ready to be stepped and placed.

    ``stand`` is the native stand whose first tree it is.
    """

    oscillators: Oscillators
    model: SwayModel
    stand: NativeStand
    doubt: str = ''
    """What makes its motion doubtful, a sentence."""

    @property
    def branches(self) -> Records:
        """Records of the branches, (b,)."""
        return self.model.branches

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

    def place(self, rotations: Floats, out: Floats) -> None:
        """
        Place every segment by key rotations (N,) in [rad], (n, 7).

        Arrays are not checked: they must be contiguous, of float64 and of these shapes.
        """
        self.stand.place_keys(0, rotations, out)

    def place_now(self, out: Floats) -> None:
        """Place every segment by the present state, as `place`."""
        if self.oscillators.loads is None:
            self.stand.place_first(out)
        else:
            rotations = np.ascontiguousarray(self.oscillators.rotations(), dtype=np.float64)
            contiguous(rotations, (self.stand.models[0].sizes.keys,))
            self.place(rotations, out)
