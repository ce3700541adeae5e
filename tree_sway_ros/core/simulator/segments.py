# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Model 5, `segments`: every segment solved, the conventional method, with the reduced tree's face.

It is there to compare with, and for a scene that has the time: its steps cost many times as much
(`tree-sway chart cost`).
"""

from __future__ import annotations

from functools import cached_property
import math

import numpy as np
from numpy.typing import ArrayLike

from tree_sway_ros.core.arrays import Floats, Records
from tree_sway_ros.core.checks import array_to_fill, array_to_read
from tree_sway_ros.core.motion.rotation_fit import RotationFit
from tree_sway_ros.core.reference.articulated import ArticulatedTree
from tree_sway_ros.core.reference.measure import tips_of_poses
from tree_sway_ros.core.simulator.assembly import Bank, CalibratedTree
from tree_sway_ros.core.simulator.live_tuning import Tuning
from tree_sway_ros.core.simulator.one_tree import OneTree
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.core.simulator.simulator import (
    Counts,
    OK,
    refuse_time_step,
    RESTARTED,
    WIND_REFUSED,
)
from tree_sway_ros.core.state.tree_state import digest_of, KeepsState
from tree_sway_ros.core.tree.species import Species
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.core.wind.crown_wind import CrownWind
from tree_sway_ros.core.wind.limits import take_wind
from tree_sway_ros.errors import ParameterError

LONGEST_STEP = 1.0 / 60.0
"""Longest step of the implicit springs in [s]; longer ones are cut."""


class SegmentsSimulator(OneTree, KeepsState):
    """
    A tree of rigid segments on springs that sways; otherwise as `SwaySimulator`.

    A `ParameterError` tells of the volume rule, which this model does not know.
    """

    @property
    def model(self) -> str:
        """``segments``."""
        return 'segments'

    def __init__(self, tree: Tree, species: Species, settings: Settings) -> None:
        """Set the springs of every joint."""
        if settings.stiffness != 'beam':
            raise ParameterError(
                f"stiffness '{settings.stiffness}' on model 'segments'", cure="use 'beam'"
            )
        calibrated = CalibratedTree(tree, species, settings)
        species, settings = calibrated.species, calibrated.settings
        self.tree, self.species, self.settings = tree, species, settings
        self.counts = Counts()
        damping = settings.damping_ratio
        if damping is None:
            damping = species.damping(bool(settings.in_leaf))
        self._tuning = Tuning.of(settings, damping)
        law = calibrated.drag_law
        middle = 0.5 * (tree.start[:, 2] + tree.end[:, 2])
        self._model = ArticulatedTree(
            tree,
            species.modulus,
            species.density,
            damping,
            law.coefficient,
            drag_exponent=law.exponent,
            steady_drag=law.steady,
            gravity=settings.gravity,
            twist_ratio=2.0 * species.shear_ratio,
            wind_factor=settings.profile.over_anemometer(middle),
            leaf_mass=settings.leaf_mass,
            leaf_area=calibrated.leaf_load_area,
            root_stiffness=species.root_stiffness,
        )
        self.wind, self._air = np.zeros(3), np.zeros((tree.n_segments, 3))
        self._crown: CrownWind | None = None
        if settings.crown_coherence < 1.0:
            delays = calibrated.crown_delays
            self._crown = CrownWind(delays.spread, settings.crown_coherence)
            self._delay_of_segment = delays.of_branch[tree.branch_of_segment]
        self.n_solved, self.n_copied, self.n_frozen = tree.n_branches, 0, 0
        self._highest = int(np.argmax(tree.end[tree.branch_first[1:] - 1, 2]))

    def step(self, wind_mean: ArrayLike, dt: float) -> int:
        """Advance one step, as `SwaySimulator.step`; what is longer than `LONGEST_STEP` is cut."""
        refuse_time_step(dt)
        status = OK
        if not take_wind(self.wind, wind_mean, self.settings.max_wind):
            status = WIND_REFUSED
            self.counts.refused += 1
        self._blow(dt)
        pieces = math.ceil(dt / LONGEST_STEP - 1e-9)
        for _ in range(pieces):
            if not self._model.step(self._air, dt / pieces):
                self.counts.restarted += 1
                status |= RESTARTED
        self.counts.steps += 1
        return status

    def check_tuning(self, **changes: float) -> Tuning:
        """Refuse what `tune` would refuse; returns all values as they would be."""
        goal = self._tuning.changed(**changes)
        if (goal.volume_stiffness, goal.volume_damping) != (
            self._tuning.volume_stiffness,
            self._tuning.volume_damping,
        ):
            raise ParameterError("the volume rule on model 'segments'", where='tune')
        if goal.gravity > 0.0 and not self._tuning.gravity > 0.0:
            raise ParameterError(
                f'gravity {goal.gravity:g} m/s^2 on a tree without weight', where='gravity'
            )
        return goal

    def tune(self, **changes: float) -> None:
        """Change the tree while it sways, as `SwaySimulator.tune`."""
        goal, now = self.check_tuning(**changes), self._tuning
        weight = goal.gravity / now.gravity if now.gravity > 0.0 else 1.0
        self._model.tune(goal.stiffness_factor / now.stiffness_factor, goal.damping_ratio, weight)
        self._tuning = goal

    def _blow(self, dt: float) -> None:
        """Give every segment the wind of its limb."""
        self._air[:] = self.wind
        if self._crown is not None:
            x, y, z = self.wind.tolist()
            self._air += self._crown.push(x, y, z, dt)[self._delay_of_segment]

    @cached_property
    def _joined(self) -> tuple[Bank, RotationFit]:
        """Make what places key rotations, and what fits them."""
        bank = CalibratedTree(self.tree, self.species, self.settings).at_rest('coupled')
        return bank, RotationFit(self.tree, bank.branches, bank.segments)

    @property
    def bank(self) -> Bank:
        """Return what places key rotations: branches and segments of the coupled tree."""
        return self._joined[0]

    @property
    def joints(self) -> Records:
        """Return the records of `BRANCH` by which the key rotations are told, (b,)."""
        return self.bank.branches

    def digest(self) -> str:
        """Digest of tree, species and settings."""
        return digest_of(self.tree, self.species, self.settings)

    def memory(self) -> tuple[Floats, ...]:
        """Return views of what is carried between steps, the wind of the last step first."""
        crown = () if self._crown is None else self._crown.memory()
        return self.wind, self._model.state.turn, self._model.state.rate, *crown

    def rotations(self) -> Floats:
        """Key rotations in [rad] that fit the segments best, (N,); the same array each time."""
        return self._joined[1].of(self._model.place())

    def place_rotations(self, rotations: Floats, out: Floats | None = None) -> Floats:
        """Place every segment by key rotations (N,), (n, 7); a new array if out is None."""
        shape = (self.tree.n_segments, 7)
        poses = np.empty(shape) if out is None else array_to_fill('out', out, shape)
        bank = self._joined[0]
        expected = bank.oscillators.rotations().shape
        rotations = array_to_read('rotations', rotations, expected)
        bank.place(rotations, self.tree.start[0], poses)
        return poses

    def place(self, out: Floats | None = None) -> Floats:
        """Place every segment, as `SwaySimulator.place`."""
        return self._model.place(out)

    @property
    def tip_displacement(self) -> Floats:
        """Displacement of the highest branch's tip from rest in [m], (3,)."""
        rest = self.tree.end[self.tree.branch_first[self._highest + 1] - 1]
        displacement: Floats = tips_of_poses(self.tree, self.place())[self._highest] - rest
        return displacement

    def frequencies(self, count: int = 10) -> Floats:
        """Lowest natural frequencies in [Hz], without air, (count,)."""
        return self._model.linear_modes(count)[0]

    def reset(self) -> None:
        """Go back to rest, with no wind; the counts stay."""
        self._model.reset()
        if self._crown is not None:
            self._crown.reset()
        self.wind[:] = 0.0
