"""
Model 5, `segments`: every segment solved, the conventional method, behind the same face as the
reduced tree.

It is there to compare with, and for a scene that has the time: its steps are many times as dear
(`tree-sway chart cost`).

"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.reference.articulated import ArticulatedTree
from tree_sway_ros.core.reference.measure import tips_of_poses
from tree_sway_ros.core.simulator.season import in_season
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.core.simulator.simulator import OK, WIND_REFUSED, Counts
from tree_sway_ros.core.tree.species import Species
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.errors import ParameterError

LONGEST_STEP = 1.0 / 60.0
"""Longest step of the implicit springs in [s]; longer ones are cut."""


class SegmentsSimulator:
    """
    A tree of rigid segments on springs that sways; otherwise as `SwaySimulator`.

    Parameters
    ----------
    tree, species, settings
        As for `SwaySimulator`; what concerns the reduction does not matter.

    Raises
    ------
    ParameterError
        The volume rule, which this model does not know.

    """

    model = "segments"

    def __init__(self, tree: Tree, species: Species, settings: Settings) -> None:
        """Set the springs of every joint."""
        if settings.stiffness != "beam":
            raise ParameterError(
                f"stiffness '{settings.stiffness}' on model 'segments'", cure="use 'beam'"
            )
        settings = in_season(tree, species, settings)
        self.tree, self.species, self.settings = tree, species, settings
        self.counts = Counts()
        damping = settings.damping_ratio
        if damping is None:
            damping = species.damping(bool(settings.in_leaf))
        coefficient, exponent = species.drag_law(bool(settings.in_leaf))
        middle = 0.5 * (tree.start[:, 2] + tree.end[:, 2])
        self._model = ArticulatedTree(
            tree,
            species.modulus,
            species.density,
            damping,
            coefficient,
            drag_exponent=exponent,
            gravity=settings.gravity,
            twist_ratio=2.0 * species.shear_ratio,
            wind_factor=settings.profile.over_anemometer(middle),
            leaf_mass=settings.leaf_mass,
            leaf_area=settings.leaf_area,
        )
        self.wind = np.zeros(3)
        self.n_solved, self.n_copied, self.n_frozen = tree.n_branches, 0, 0
        self._poses = np.zeros((tree.n_segments, 7))
        self._highest = int(np.argmax(tree.end[tree.branch_first[1:] - 1, 2]))
        self.place()

    def step(self, wind_mean: ArrayLike, dt: float) -> int:
        """Advance one step, as `SwaySimulator.step`; what is longer than `LONGEST_STEP` is cut."""
        if not (math.isfinite(dt) and dt > 0.0):
            raise ParameterError(
                f"time step of {dt} s", where="step", cure="give a finite one above 0"
            )
        wind = np.asarray(wind_mean, dtype=np.float64)
        status = OK
        if np.abs(wind).max() < 1e9 and np.linalg.norm(wind) <= self.settings.max_wind:
            self.wind[:] = wind
        else:
            status = WIND_REFUSED
            self.counts.refused += 1
        pieces = math.ceil(dt / LONGEST_STEP - 1e-9)
        for _ in range(pieces):
            self._model.step(self.wind, dt / pieces)
        self.counts.steps += 1
        return status

    def place(self, out: Floats | None = None) -> Floats:
        """Place every segment, as `SwaySimulator.place`."""
        poses = self._model.place(self._poses if out is None else out)
        if out is not None:
            self._poses[:] = out
        return poses

    @property
    def tip_displacement(self) -> Floats:
        """Way of the highest branch's tip from rest in [m], (3,), as last placed."""
        rest = self.tree.end[self.tree.branch_first[self._highest + 1] - 1]
        displacement: Floats = tips_of_poses(self.tree, self._poses)[self._highest] - rest
        return displacement

    def frequencies(self, count: int = 10) -> Floats:
        """Lowest natural frequencies in [Hz], without air, (count,)."""
        return self._model.linear_modes(count)[0]

    def reset(self) -> None:
        """Go back to rest, with no wind; the counts stay."""
        self._model.reset()
        self.wind[:] = 0.0
        self.place()
