# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What every simulator is used by, whatever its model, and whether of one tree or of a forest."""

from __future__ import annotations

from typing import Protocol

from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.simulator.live_tuning import Tuning
from tree_sway.core.simulator.settings import Settings
from tree_sway.core.simulator.simulator import Counts, SwaySimulator
from tree_sway.core.tree.tree import Tree
from tree_sway.core.wind.gust_travel import GustHistory


class Simulator(Protocol):
    """A tree that sways, whatever the model; or a forest."""

    @property
    def tree(self) -> Tree:
        """The tree, or all of them as one record."""

    @property
    def settings(self) -> Settings:
        """How it is modelled."""

    @property
    def model(self) -> str:
        """Model in use."""

    @property
    def counts(self) -> Counts:
        """Return what was refused or held since the start."""

    @property
    def n_solved(self) -> int:
        """Branches that are solved."""

    @property
    def wind(self) -> Floats:
        """Wind of the last step in [m/s], (3,)."""

    @property
    def tip_displacement(self) -> Floats:
        """Displacement of the highest tip from rest in [m], (3,)."""

    @property
    def simulators(self) -> tuple[SwaySimulator, ...]:
        """Return the simulator of each tree."""

    @property
    def gusts(self) -> GustHistory | None:
        """How gusts reach the trees of a forest; None for a tree."""

    def step(self, wind_mean: ArrayLike, dt: float) -> int:
        """Advance one step of dt [s] in a wind [m/s]."""

    def place(self, out: Floats | None = None) -> Floats:
        """Place every segment, (n, 7); a new array if out is None."""

    def check_tuning(self, **changes: float) -> Tuning:
        """Refuse what `tune` would refuse; returns all values as they would be."""

    def tune(self, **changes: float) -> None:
        """Change damping, stiffness or gravity between steps; see `SwaySimulator.tune`."""

    def reset(self) -> None:
        """Go back to rest."""
