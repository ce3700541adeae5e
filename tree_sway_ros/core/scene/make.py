"""
One way to every model of a tree: by the name of its fidelity.

"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Protocol

from numpy.typing import ArrayLike

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.fidelity.adaptive import AdaptiveSimulator
from tree_sway_ros.core.simulator.segments import SegmentsSimulator
from tree_sway_ros.core.simulator.settings import FIDELITIES, Settings
from tree_sway_ros.core.simulator.simulator import Counts, SwaySimulator
from tree_sway_ros.core.tree.species import Species
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.errors import ParameterError


class Simulator(Protocol):
    """A tree that sways, whatever the model; or a forest."""

    tree: Tree
    settings: Settings

    @property
    def model(self) -> str:
        """Model in use."""

    @property
    def counts(self) -> Counts:
        """What was refused or held."""

    @property
    def n_solved(self) -> int:
        """Branches that are solved."""

    @property
    def n_copied(self) -> int:
        """Branches that copy the motion of another."""

    @property
    def n_frozen(self) -> int:
        """Branches that move with their parent as one body."""

    @property
    def tip_displacement(self) -> Floats:
        """Way of the highest tip from rest in [m], (3,)."""

    def step(self, wind_mean: ArrayLike, dt: float) -> int:
        """Advance one step of dt [s] in a wind [m/s]."""

    def place(self, out: Floats | None = None) -> Floats:
        """Place every segment, (n, 7)."""

    def reset(self) -> None:
        """Go back to rest."""


def make_simulator(
    tree: Tree,
    species: Species,
    settings: Settings | None = None,
    *,
    fidelity: str = "auto",
    tolerance: float = 0.005,
    budget: float = 0.0,
    **changes: Any,
) -> Simulator:
    """
    Make a simulator of a tree.

    Parameters
    ----------
    tree, species, settings
        As for `SwaySimulator`.
    fidelity
        One of `FIDELITIES`.
    tolerance
        Largest error of the tips in [m] that ``auto`` may allow itself.
    budget
        Largest cost of a frame in [us] that ``auto`` may allow itself, which comes before the
        tolerance; 0 for none.
    **changes
        Fields of the settings.

    Raises
    ------
    ParameterError
        An unknown fidelity, or a setting out of its range.
    TreeError
        A tree that buckles under its own weight.

    """
    if fidelity not in FIDELITIES:
        raise ParameterError(
            f"unknown fidelity '{fidelity}'", cure=f"use one of: {', '.join(FIDELITIES)}"
        )
    model = replace(settings or Settings(), **changes)
    if fidelity == "auto":
        return AdaptiveSimulator(tree, species, model, tolerance=tolerance, budget=budget)
    if fidelity == "segments":
        return SegmentsSimulator(tree, species, model)
    return SwaySimulator(tree, species, replace(model, model=fidelity))


def simulators_of(simulator: Any) -> tuple[Any, ...]:
    """Return the simulator of each tree: of a `Forest` all of them, of a tree its own."""
    return tuple(getattr(simulator, "simulators", (simulator,)))
