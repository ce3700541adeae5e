# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Our simulator against MuJoCo, on the same tree and in the same wind, in one run: error and cost.

The truth is MuJoCo at a step that has converged, which its error at twice that step shows. Its
springs are set to the beam model's static sway (`mujoco_tree`), its dampers and modal forces give
every mode the same damping ratio as ours. Costs are CPU time at 1/60 s, ours with the wind force
and the poses, MuJoCo's without the wind force, which is no part of the engine; at such a step
it is only stable with dampers that over-damp its higher modes, which costs it nothing.

"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from tree_sway.commands import bar, waiting
from tree_sway.core.arrays import Floats
from tree_sway.core.settings import Settings
from tree_sway.core.species import Species
from tree_sway.core.tree import Tree
from tree_sway_lab.bench.frame_time import frame_times
from tree_sway_lab.compare.engines import run_engines
from tree_sway_lab.compare.mujoco_tree import FRAME, MujocoTree, NO_TWIST
from tree_sway_lab.model_names import simulator_called
from tree_sway_lab.tip_error import record_tips, tip_error

DAMPING_RATIO = 0.05


@dataclass(frozen=True)
class Comparison:
    """
    What came out.

    Parameters
    ----------
    n_branches, n_segments
        Size of the tree.
    model
        Our model.
    first_frequency, static_sway
        MuJoCo's over the beam model's in [-].
    tip_motion
        Largest way of a tip from rest in [m].
    error
        Ours, tip error over tip motion in [-].
    step_error
        MuJoCo's at the truth's doubled step, how far the truth itself has converged.
    error_at_60
        MuJoCo's at 1/60 s.
    cost, mujoco_cost
        CPU time per simulated second at 60 Hz in [s].

    """

    n_branches: int
    n_segments: int
    model: str
    first_frequency: float
    static_sway: float
    tip_motion: float
    error: float
    step_error: float
    error_at_60: float
    cost: float
    mujoco_cost: float

    @property
    def speed_up(self) -> float:
        """CPU time of MuJoCo over ours."""
        return self.mujoco_cost / self.cost

    def __str__(self) -> str:
        """Say it in a few lines."""
        return '\n'.join(
            (
                f'{self.n_branches} branches, {self.n_segments} segments, tips move up to '
                f'{self.tip_motion:.3f} m',
                f"MuJoCo's f1 / the beam's {self.first_frequency:.4f}, static sway / the beam's "
                f"{self.static_sway:.4f}, error at twice the truth's step {self.step_error:.4f}",
                f'tip error over tip motion: {self.model} {self.error:.4f}, MuJoCo at 1/60 s '
                f'{self.error_at_60:.4f}',
                f'CPU time per simulated second at 60 Hz: {self.model} {1e3 * self.cost:.3f} ms, '
                f'MuJoCo '
                f'{1e3 * self.mujoco_cost:.1f} ms, {self.speed_up:.0f} times as much',
            )
        )


def compare_with_mujoco(
    tree: Tree,
    species: Species,
    wind: Floats,
    *,
    model: str = 'default',
    damping_ratio: float = DAMPING_RATIO,
    steps: int = 32,
) -> Comparison:
    """
    Run both.

    Parameters
    ----------
    tree, species
        The tree and its wood; both models are without twist and without gravity, as MuJoCo's
        hinges are.
    wind
        Mean of each frame of 1/60 s in [m/s], (t, 3).
    model
        Our model, as in `simulator_called`.
    damping_ratio
        In [-].
    steps
        MuJoCo's steps per frame, for the truth.

    Raises
    ------
    MissingDependencyError
        If MuJoCo is not installed.

    """
    wood = without_twist(species)
    with waiting("building MuJoCo's model"):
        truth_model = MujocoTree(tree, wood, damping_ratio)
    first_frequency, static_sway = truth_model.agreement()
    truth = mujoco_tips(truth_model, wind, steps)
    coarse = mujoco_tips(truth_model, wind, steps // 2)
    settings = Settings(damping_ratio=damping_ratio, gravity=0.0, in_leaf=False)
    ours = simulator_called(model, tree, wood, settings)
    tips = record_tips(ours, tree, wind, FRAME)
    ours.reset()
    cost = sum(frame_times({model: ours}, tree, wind, FRAME)[model]) * 1e-9
    engine = run_engines(tree, wood, damping_ratio, wind, names=('MuJoCo',))['MuJoCo']
    rest = tree.end[tree.branch_first[1:] - 1]
    return Comparison(
        n_branches=tree.n_branches,
        n_segments=tree.n_segments,
        model=model,
        first_frequency=first_frequency,
        static_sway=static_sway,
        tip_motion=float(np.linalg.norm(truth - rest, axis=2).max()),
        error=tip_error(tree, tips, truth),
        step_error=tip_error(tree, coarse, truth),
        error_at_60=tip_error(tree, engine.tips, truth),
        cost=cost / FRAME,
        mujoco_cost=engine.cost / FRAME,
    )


def mujoco_tips(model: MujocoTree, wind: Floats, steps: int) -> Floats:
    """Tips at each frame in [m], (t, b, 3), with a number of steps per frame."""
    model.reset()
    tips = np.empty((len(wind), model.tree.n_branches, 3))
    for frame, blowing in enumerate(bar(wind, f'MuJoCo, {steps} steps per frame')):
        for _ in range(steps):
            model.step(blowing, FRAME / steps)
        tips[frame] = model.tips()
    return tips


def without_twist(species: Species) -> Species:
    """Return wood that does not twist, as the engines' hinges do not."""
    return replace(species, shear_ratio=NO_TWIST)
