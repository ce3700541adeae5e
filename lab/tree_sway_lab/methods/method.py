# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
What a method is: a name, a declared order, notes on stability, and one step.

A step takes the loads at the fractions of the step that the method names as its `nodes`, so that
the same method runs on samples of a smooth wind, on means over the step, or on a wind record.

"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from tree_sway_lab.methods import minimal_form, multiplier_form
from tree_sway_lab.methods.chain import PlanarChain

Array = NDArray[Any]


@dataclass(frozen=True)
class Method(ABC):
    """
    One time integrator; its subclasses hold one step each.

    The class attributes are the declaration: `name`; `form`, "minimal" (angles) or "multiplier"
    (the paper's coordinates); `order`, the one that a test measures; `nodes`, fractions of the
    step at which it wants the load; `limit`, the largest w h [-] that is stable without damping,
    infinite where it has no limit; `notes` and `source` on its stability.

    """

    name: ClassVar[str]
    form: ClassVar[str]
    order: ClassVar[int]
    nodes: ClassVar[tuple[float, ...]]
    limit: ClassVar[float] = np.inf
    notes: ClassVar[str]
    source: ClassVar[str]
    kernel: ClassVar[Callable[..., int]]

    def options(self, chain: PlanarChain, dt: float) -> Array:
        """Return the numbers that the kernel takes beside the state: constants of the method."""
        return np.zeros(1)

    @abstractmethod
    def start(
        self, chain: PlanarChain, theta: Array, omega: Array, load: Array, dt: float
    ) -> Array:
        """
        State to start from.

        Parameters
        ----------
        chain
            The mechanism.
        theta, omega
            Angles [rad] and rates [rad/s], (n,).
        load
            Loads at the start in [N], (n, 2).
        dt
            Step in [s], which a method with a memory needs.

        """

    @abstractmethod
    def angles(self, state: Array) -> Array:
        """Angles in [rad], (n,), a view of the state."""

    @abstractmethod
    def rates(self, state: Array) -> Array:
        """Angular velocities in [rad/s], (n,), a view of the state."""

    def reactions(self, chain: PlanarChain, state: Array, load: Array) -> Array:
        """Force that each joint carries in [N], (n, 2), at a state under a load."""
        return minimal_form.reactions(chain.table, self.angles(state), self.rates(state), load)


@dataclass(frozen=True)
class MinimalMethod(Method):
    """State: rows of angles, rates, angles and rates one step ago, (4, n)."""

    form: ClassVar[str] = 'minimal'

    def start(
        self, chain: PlanarChain, theta: Array, omega: Array, load: Array, dt: float
    ) -> Array:
        """State with a past that fits the equation to second order."""
        accel = minimal_form.acceleration(chain.table, theta, omega, load)
        before = theta - dt * omega + 0.5 * dt * dt * accel
        return np.stack([theta, omega, before, omega - dt * accel])

    def angles(self, state: Array) -> Array:
        """Return the first row."""
        return state[0]  # type: ignore[no-any-return]

    def rates(self, state: Array) -> Array:
        """Return the second row."""
        return state[1]  # type: ignore[no-any-return]


@dataclass(frozen=True)
class MultiplierMethod(Method):
    """Keeps rows q, v, accelerations, multipliers (2n used), and q, v a step ago, (6, 3n)."""

    form: ClassVar[str] = 'multiplier'

    def start(
        self, chain: PlanarChain, theta: Array, omega: Array, load: Array, dt: float
    ) -> Array:
        """State on the constraint, with the multipliers and a past that fit the equation."""
        q, v = multiplier_form.place(chain.table, theta, omega)
        accel, lam = multiplier_form.index1(chain.table, q, v, load, 0.0, 0.0)
        past = minimal_form.acceleration(chain.table, theta, omega, load)
        q0, v0 = multiplier_form.place(
            chain.table, theta - dt * omega + 0.5 * dt * dt * past, omega - dt * past
        )
        return np.stack([q, v, accel, np.concatenate([lam, 0 * q[: len(q) - len(lam)]]), q0, v0])

    def angles(self, state: Array) -> Array:
        """Return every third coordinate."""
        return state[0, 2::3]

    def rates(self, state: Array) -> Array:
        """Return every third velocity."""
        return state[1, 2::3]

    def gap(self, chain: PlanarChain, state: Array) -> float:
        """Return the largest violation of the constraints in [m]."""
        return float(np.max(np.abs(multiplier_form.constraint(chain.table, state[0]))))
