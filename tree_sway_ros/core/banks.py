"""
From a tree to the oscillators that move it: one function a rung of the ladder.

"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from tree_sway_ros.core.beam import volume_rule_stiffness
from tree_sway_ros.core.branch_model import BranchModel, branch_models
from tree_sway_ros.core.carried_inertia import carried_inertia
from tree_sway_ros.core.kinematics import fill_branch_geometry, segment_records
from tree_sway_ros.core.layout import BRANCH, WORK
from tree_sway_ros.core.loads import even_wind_moments
from tree_sway_ros.core.modal import ModalBank
from tree_sway_ros.core.modes import Modes, most_driven, natural_modes, refuse_buckling
from tree_sway_ros.core.reduction import Reduction, reduce_tree
from tree_sway_ros.core.settings import SimulatorSettings
from tree_sway_ros.core.species import Species
from tree_sway_ros.core.tree import Floats, Tree
from tree_sway_ros.core.twigs import twig_sources
from tree_sway_ros.core.uncoupled import UncoupledBank
from tree_sway_ros.core.wind_load import fill_branch_loads


class Oscillators(Protocol):
    """What every rung gives: key rotations that a wind moves."""

    work: Any

    def set_step(self, dt: float) -> None:
        """Refill what depends on the time step [s]."""

    def advance(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """Advance one step under a mean wind [m/s]; returns how many loads were held."""

    def rotations(self) -> Floats:
        """Key rotations in [rad], (N,)."""

    def reset(self) -> None:
        """Go back to rest."""


class Frozen:
    """Rung 0: a tree that stands still, for one too far away to be seen moving."""

    def __init__(self, n_branches: int, n_coordinates: int) -> None:
        """Rest is all there is."""
        self.work = np.zeros(n_branches, dtype=WORK)
        self._x = np.zeros(n_coordinates)

    def set_step(self, dt: float) -> None:
        """Any step [s] will do."""

    def advance(self, wx: float, wy: float, wz: float, per_speed_squared: float) -> int:
        """Stand still."""
        return 0

    def rotations(self) -> Floats:
        """Zeros, (N,)."""
        return self._x

    def reset(self) -> None:
        """Stay at rest."""


@dataclass(frozen=True)
class Bank:
    """
    A tree ready to be stepped and placed.

    Parameters
    ----------
    oscillators
        What moves.
    branches, segments
        Records of `BRANCH` (b,) and `SEGMENT` (n,).
    frequencies
        Natural frequencies of the model without air in [Hz], rising.
    n_solved
        Branches that are solved and do not copy.
    mass
        Of wood and leaves in [kg].

    """

    oscillators: Oscillators
    branches: Any
    segments: Any
    frequencies: Floats
    n_solved: int
    mass: float


def build_bank(tree: Tree, species: Species, settings: SimulatorSettings) -> Bank:
    """
    Calibrate a tree for its rung.

    Raises
    ------
    TreeError
        A tree that buckles under its own weight, or a branch without mass.
    ParameterError
        More modes than there are.

    """
    middle = 0.5 * (tree.start[:, 2] + tree.end[:, 2])
    speed = settings.profile.over_anemometer(middle)
    coupled = settings.rung in ("modes", "coupled")
    carries = settings.rung != "branch"
    models = branch_models(
        tree,
        species.density,
        carries=carries,
        enriched=_enriched(tree, settings.enrich) if coupled else frozenset(),
        speed_profile=speed,
        leaf_mass=settings.leaf_mass,
        leaf_area=settings.leaf_area,
    )
    shear = species.shear_ratio * species.modulus
    reduction = reduce_tree(tree, models, species.modulus, shear, settings.gravity, carries=carries)
    branches = np.zeros(tree.n_branches, dtype=BRANCH)
    fill_branch_geometry(tree, models, branches)
    fill_branch_loads(tree, models, reduction, speed, branches)
    segments = segment_records(tree, models)
    damping = settings.damping_ratio
    if damping is None:
        damping = species.damping_in_leaf if settings.in_leaf else species.damping_bare
    oscillators: Oscillators
    if settings.rung == "frozen":
        oscillators, frequencies = Frozen(tree.n_branches, reduction.n_coordinates), np.zeros(0)
    elif coupled:
        modes = _modes(tree, reduction, branches, settings)
        oscillators, frequencies = ModalBank(branches, reduction, modes, damping), modes.frequencies
    else:
        refuse_buckling(tree, reduction)
        branches["source"] = twig_sources(tree, settings.twig_tolerance)
        _share_frames(branches)
        oscillators = _uncoupled(tree, models, reduction, branches, damping, settings)
        frequencies = np.sort(np.sqrt(oscillators.stiffness / oscillators.inertia)) / (2.0 * np.pi)
    solved = int((branches["source"] == np.arange(tree.n_branches)).sum())
    mass = float(sum(model.beam.integral(model.mass) for model in models))
    return Bank(oscillators, branches, segments, frequencies, solved, mass)


def _modes(
    tree: Tree, reduction: Reduction, branches: Any, settings: SimulatorSettings
) -> Modes:
    """All modes, or those of the slowest that the wind drives most."""
    if settings.rung == "coupled":
        return natural_modes(tree, reduction)
    n = reduction.n_coordinates
    if settings.n_modes > n:
        natural_modes(tree, reduction, settings.n_modes)
    slowest = natural_modes(tree, reduction, min(4 * settings.n_modes, n))
    return most_driven(slowest, even_wind_moments(branches, n), settings.n_modes)


def _enriched(tree: Tree, enrich: str) -> frozenset[int]:
    if enrich == "all":
        return frozenset(range(tree.n_branches))
    if enrich == "carriers":
        return frozenset([0, *tree.branch_parent[1:].tolist()])
    return frozenset([0]) if enrich == "stem" else frozenset()


def _share_frames(branches: Any) -> None:
    """Let a twig that copies turn about the axes of its source, so that it moves the same way."""
    for b in np.flatnonzero(branches["source"] != np.arange(len(branches))):
        branches["axis"][b] = branches["axis"][branches["source"][b]]
        branches["frame"][b] = branches["frame"][branches["source"][b]]


def _uncoupled(
    tree: Tree,
    models: list[BranchModel],
    reduction: Reduction,
    branches: Any,
    damping_ratio: float,
    settings: SimulatorSettings,
) -> UncoupledBank:
    """Each branch's own oscillator: the mean of its two axes."""
    carries = settings.rung == "subtree"
    inertia = carried_inertia(tree, reduction).reshape(-1, 2).mean(axis=1)
    stiffness = np.asarray(reduction.stiffness.diagonal()).reshape(-1, 2).mean(axis=1)
    if not carries:
        inertia = inertia * np.array([model.inertia_share for model in models])
    damping = 2.0 * damping_ratio * np.sqrt(stiffness * inertia)
    if settings.stiffness == "volume_rule":
        volume = np.add.reduceat(tree.volume, tree.branch_first[:-1])
        parent = volume[np.maximum(tree.branch_parent, 0)]
        rule = np.array(
            [volume_rule_stiffness(v, p, 1.0) for v, p in zip(volume, parent, strict=True)]
        )
        stiffness, damping = settings.volume_stiffness * rule, settings.volume_damping * rule
    return UncoupledBank(branches, inertia, damping, stiffness, carries)
