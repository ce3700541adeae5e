# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Models against every segment solved, on one tree: tip errors, estimates, steady sway.

Truth is `ArticulatedTree` in four pieces per segment at eight steps per frame, with weight and
twist.

"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.fidelity.estimate import Estimate
from tree_sway_ros.core.fidelity.ladder import FidelityLadder
from tree_sway_ros.core.reference.articulated import ArticulatedTree
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.core.tree.species import Species
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.core.wind.climate import WindClimate
from tree_sway_ros.study.example_trees import EXAMPLE_DENSITY, EXAMPLE_MODULUS
from tree_sway_ros.study.tip_error import record_tips, tip_error
from tree_sway_ros.study.validation.winds import FRAME

DAMPING_RATIO = 0.05
WOOD = Species(
    'example',
    'example',
    EXAMPLE_MODULUS,
    EXAMPLE_DENSITY,
    damping_bare=DAMPING_RATIO,
    shear_ratio=1.0 / 14.0,
)
SETTINGS = Settings(twig_tolerance=-1.0)
PIECES, SUBSTEPS = 4, 8

SWAYS = (0.1, 0.2, 0.3)
"""Steady sways to measure at, over the height of the tree."""


@dataclass(frozen=True)
class Verdict:
    """
    One model on one tree in one wind.

    Parameters
    ----------
    tree, wind, model
        What was run.
    error
        Tip error over tip motion in [-].
    over_estimate
        True error over the ladder's estimate of it in [-].

    """

    tree: str
    wind: str
    model: str
    error: float
    over_estimate: float


class Judge:
    """
    One tree with its truth and its models.

    Parameters
    ----------
    tree
        The tree, of `WOOD`.
    pieces, substeps
        Of each segment and of each frame, for the truth.

    """

    def __init__(self, tree: Tree, *, pieces: int = PIECES, substeps: int = SUBSTEPS) -> None:
        """Build the truth and all models of the ladder."""
        self.tree, self.substeps = tree, substeps
        self.truth = ArticulatedTree(
            tree,
            WOOD.modulus,
            WOOD.density,
            DAMPING_RATIO,
            WOOD.bare_drag_coefficient,
            gravity=SETTINGS.gravity,
            subdivisions=pieces,
            twist_ratio=2.0 * WOOD.shear_ratio,
        )
        self.ladder = FidelityLadder(tree, WOOD, SETTINGS)
        self.first_frequency = float(self.model('coupled').frequencies(1)[0])

    def model(self, model: str, n_modes: int | None = None) -> SwaySimulator:
        """Make a simulator of one model."""
        whole = self.ladder.calibrated(self._whole[0])
        return SwaySimulator(
            self.tree, WOOD, SETTINGS, calibrated=whole, model=model, n_modes=n_modes
        )

    def verdicts(
        self, winds: Mapping[str, Floats], models: Iterable[str] | None = None
    ) -> list[Verdict]:
        """
        Run truth and models in each wind.

        Parameters
        ----------
        winds
            Mean of each frame in [m/s], (t, 3), by name.
        models
            Names of those to run, as the ladder calls them; all if None.

        """
        wanted = None if models is None else set(models)
        found = []
        for name, wind in winds.items():
            self.truth.reset()
            truth = record_tips(self.truth, self.tree, wind, FRAME, substeps=self.substeps)
            for estimate in self.ladder.estimates(WindClimate.of_samples(wind, 1.0 / FRAME)):
                if wanted is None or estimate.name in wanted:
                    tips = record_tips(self._built(estimate), self.tree, wind, FRAME)
                    metres = float(np.sqrt(np.square(tips - truth).sum(axis=2).mean()))
                    over = metres / estimate.error if estimate.error > 0.0 else np.inf
                    error = tip_error(self.tree, tips, truth)
                    found.append(Verdict(self.tree.name, name, estimate.name, error, over))
        return found

    def steady_sway(self, model: str = 'coupled', sways: Iterable[float] = SWAYS) -> list[float]:
        """
        Find how far a model's steady sway is from the truth's.

        The wind is raised until the truth's highest tip sways by each of these shares of the
        height.

        Returns
        -------
        list of float
            Sway of the highest tip over the truth's, less 1, in [-].

        """
        rest = self.tree.end[self.tree.branch_first[1:] - 1]
        highest = int(np.argmax(rest[:, 2]))
        height = float(rest[highest, 2] - self.tree.start[0, 2])
        sim, found = self.model(model), []
        for share in sways:
            speed, true_way = self._speed_for(share * height, highest, rest[highest])
            sim.reset()
            wind = np.tile(speed * _ALONG, (round(_SETTLE / FRAME), 1))
            tips = record_tips(sim, self.tree, wind, FRAME)[-_MEAN:, highest].mean(axis=0)
            found.append(float(np.linalg.norm(tips - rest[highest]) / true_way) - 1.0)
        return found

    def _speed_for(self, sway: float, tip: int, rest: Floats) -> tuple[float, float]:
        """Wind speed in [m/s] that holds the truth's tip about so far from rest, and how far."""
        speed, reached = 5.0, 0.0
        for _ in range(12):
            reached = self._true_displacement(speed, tip, rest)
            if abs(reached / sway - 1.0) < 0.03:
                break
            speed *= float(np.clip((sway / max(reached, 1e-6)) ** 0.55, 0.4, 2.5))
        return speed, reached

    def _true_displacement(self, speed: float, tip: int, rest: Floats) -> float:
        # From where it stood before: only the rest counts, so big steps will do.
        for _ in range(round(_SETTLE / FRAME)):
            self.truth.step(speed * _ALONG, FRAME)
        total = np.zeros(3)
        for _ in range(_MEAN):
            self.truth.step(speed * _ALONG, FRAME)
            total += self.truth.node_positions[self.tree.branch_first[1:] - 1][tip]
        return float(np.linalg.norm(total / _MEAN - rest))

    @property
    def _whole(self) -> list[Estimate]:
        calm = self.ladder.estimates(WindClimate.steady(1.0, 0.1))
        return [e for e in calm if e.n_frozen == 0]

    def _built(self, estimate: Estimate) -> SwaySimulator:
        return SwaySimulator(
            self.tree,
            WOOD,
            SETTINGS,
            model=estimate.model,
            n_modes=max(estimate.n_modes, 1),
            calibrated=self.ladder.calibrated(estimate),
        )


_ALONG = np.array([0.8, 0.6, 0.0])
_SETTLE, _MEAN = 10.0, 60
