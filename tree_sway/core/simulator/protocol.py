# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What every simulator is used by, whatever its model, and whether of one tree or of a forest."""

from __future__ import annotations

from typing import Protocol

from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats, Records
from tree_sway.core.simulator.bank import Bank
from tree_sway.core.simulator.live_tuning import Tuning
from tree_sway.core.simulator.settings import Settings
from tree_sway.core.simulator.simulator import Counts
from tree_sway.core.state.tree_state import TreeState
from tree_sway.core.tree.species import Species
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
    def n_copied(self) -> int:
        """Branches that copy the motion of another."""

    @property
    def wind(self) -> Floats:
        """Wind of the last step in [m/s], (3,)."""

    @property
    def tip_displacement(self) -> Floats:
        """Displacement of the highest tip from rest in [m], (3,)."""

    @property
    def simulators(self) -> tuple[TreeSimulator, ...]:
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


class TreeSimulator(Simulator, Protocol):
    """A simulator of one tree: its state can be read, kept and set."""

    species: Species

    @property
    def bank(self) -> Bank:
        """Return the records of the tree and the oscillators, as `Bank`."""

    @property
    def joints(self) -> Records:
        """Return the records of `BRANCH` in the order of the rotations, (b,)."""

    def digest(self) -> str:
        """Return a name of all that a state must agree with."""

    def rotations(self) -> Floats:
        """Key rotations in [rad], (N,)."""

    def place_rotations(self, rotations: Floats, out: Floats | None = None) -> Floats:
        """Place every segment by key rotations (N,), (n, 7)."""

    def state(self) -> TreeState:
        """Return all that is carried from one step to the next."""

    def set_state(self, state: TreeState) -> None:
        """Go on from a state."""

    def expand(self, state: TreeState, out: Floats | None = None) -> Floats:
        """Place every segment as in a state, (n, 7)."""
