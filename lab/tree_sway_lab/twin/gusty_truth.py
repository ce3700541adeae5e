# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The tree outside the window: every segment a rigid body, in a field of gusts, beside a mast.

Nothing of it is the model's: its solver is that of `segments`, the gusts of its limbs are drawn
from cross spectra (`gust_field`), the mast measures at its own place, and wood, damping and drag
are drawn from what is published of trees of one species.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
import math
from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.drag import DragLaw
from tree_sway.core.rotation import about_up
from tree_sway.core.run import SwaySimulator
from tree_sway.core.scene import make_simulator
from tree_sway.core.settings import Settings
from tree_sway.core.setup import prepare, TreeReductions
from tree_sway.core.species import Species
from tree_sway.core.tree import tips_of_poses, Tree
from tree_sway.twin import place_on
from tree_sway_lab.segments.articulated import ArticulatedTree
from tree_sway_lab.twin.gust_field import GustField, nearest_of, OtherField, spread_points
from tree_sway_lab.twin.true_tree import DT, pose_at, TrueMotion

POINTS = 144
"""
Places of the crown that have gusts of their own, at most.

With 12, 48 and 144 of them the second difference of the tips of a crooked tree of 234 segments is
1.4, 1.2 and 1 times that with the most: fewer places shake a crown too much as one.
"""

_WOOD, _BRANCH, _DAMPING, _DRAG = 0.22, 0.15, 0.5, 0.25
"""Log-deviations of wood among trees, and of branches within one, of damping and of drag."""

SUBSTEPS = 4
_TWIST = 1.0 / 7.0

KINDS = ('limbs2', 'poplar 10', 'crooked', 'crooked', 'leaning', 'oak 9')
"""Two stems, a poplar, crooked trees of two habits, a tree that leans, and an oak."""


def kinds_of(seed: int) -> list[str]:
    """Return the six kinds of trees of a seed, as `tree_called` knows them."""
    seeds = (seed, seed, 3 * seed, 3 * seed + 1, seed, seed)
    return [f'{kind} {each}' for kind, each in zip(KINDS, seeds, strict=True)]


@dataclass(frozen=True)
class Outside:
    """
    What the model does not know of the tree outside.

    Parameters
    ----------
    wood, branches, damping, drag
        Modulus over the model's, also of each branch (b,), damping ratio and drag area [-].
    mast
        Place of the anemometer from the highest tip in [m], x along the wind, (3,).
    speed, intensity, seconds
        Mean wind in [m/s], deviation of u over it [-] and length of the record in [s].
    seed
        Seed of the gusts.
    is_uniform
        Whether the wind is the mast's everywhere.
    points
        Places of the crown that have gusts of their own.
    heading
        Direction that the wind goes to, from east to north [rad].
    is_other
        Whether the gusts follow another law than the model's (`OtherField`).

    """

    wood: float = 1.0
    branches: Floats | float = 1.0
    damping: float = 1.0
    drag: float = 1.0
    mast: tuple[float, float, float] = (-12.0, 4.0, 0.0)
    speed: float = 7.0
    intensity: float = 0.3
    seconds: float = 120.0
    seed: int = 101
    is_uniform: bool = False
    points: int = POINTS
    heading: float = 0.0
    is_other: bool = False

    def drawn(self, tree: Tree) -> Outside:
        """Draw the tree by the seed."""
        rng = np.random.default_rng([self.seed, tree.n_segments])
        wood, damping, drag = np.exp(np.array([_WOOD, _DAMPING, _DRAG]) * rng.normal(size=3))
        branches = np.exp(_BRANCH * rng.normal(size=tree.n_branches))
        return replace(
            self, wood=float(wood), branches=branches, damping=float(damping), drag=float(drag)
        )

    def field(self, tree: Tree) -> tuple[GustField, Ints]:
        """Return the gusts of mast, the first place, and crown; and the place of each segment."""
        middle = 0.5 * (tree.start + tree.end)
        area = tree.length * (tree.base_diameter + tree.tip_diameter)
        points = spread_points(middle, area, self.points)
        near = nearest_of(middle, points) + 1
        mast = about_up(self.heading) @ self.mast
        places = np.vstack([top_of(tree) + mast, points])
        kind = OtherField if self.is_other else GustField
        return kind(places, self.speed, self.intensity, heading=self.heading), near


def mast_of(outside: Outside) -> tuple[float, float]:
    """Return distance [m], 0.1 on top of the tree, and bearing [rad] of the mast."""
    east, north, _ = (about_up(outside.heading) @ outside.mast).tolist()
    return max(math.hypot(east, north), 0.1), math.atan2(east, north)


def known_tree(
    tree: Tree, species: Species, outside: Outside, *, in_leaf: bool, **changes: Any
) -> SwaySimulator:
    """Make the model that has the wood, the damping and the drag of the tree outside."""
    usual = prepare(tree, species, model=0, in_leaf=in_leaf).damping_ratio
    model = prepare(
        tree,
        replace(species, modulus=outside.wood * species.modulus),
        in_leaf=in_leaf,
        damping_ratio=min(outside.damping * usual, 1.0),
        **changes,
    )
    leaves, exponent, wood = model.drag_law
    law = DragLaw(outside.drag * leaves, exponent, outside.drag * wood)
    simulator = make_simulator(replace(model, drag_law=law))
    simulator.banks[0].oscillators.tunable.spread_wood(0.0)
    return simulator


def told_wind(tree: Tree, outside: Outside, measured: Floats) -> Floats:
    """
    Crown's wind as all of a mast's record (n, 3) tells it by the true law, (n, 3).

    No estimate from the mast's wind alone has less error but one of a better tree: it is the
    smoother of Wiener, which knows the later wind too.
    """
    field, near = outside.field(tree)
    area = tree.length * (tree.base_diameter + tree.tip_diameter)
    share = np.bincount(near, area, len(field.places)) / area.sum()
    frequency = np.fft.rfftfreq(2 * len(measured), DT)
    apart, along = field.apart()[0], field.along[:, 0]
    late = (along - along[0]) / field.speed
    told = np.exp(-frequency[:, None] * (apart + 2j * np.pi * late)) @ share
    mean = measured.mean(axis=0)
    lines = np.fft.rfft(measured - mean, 2 * len(measured), axis=0)
    back = np.fft.irfft(told[:, None] * lines, 2 * len(measured), axis=0)
    return np.asarray(mean + back[: len(measured)])


def top_of(tree: Tree) -> Floats:
    """Highest tip in [m], (3,)."""
    return np.asarray(tree.end[np.argmax(tree.end[:, 2])])


def outside_tree(
    tree: Tree, species: Species, outside: Outside, *, in_leaf: bool, water: float = 0.0
) -> ArticulatedTree:
    """Make the tree outside, at rest; with water on its leaves, over their mass [-]."""
    known = TreeReductions(tree, species, Settings(in_leaf=in_leaf))
    law, leaves = known.drag_law, known.settings
    heavy = None if leaves.leaf_mass is None else (1.0 + water) * leaves.leaf_mass
    moduli = outside.wood * species.modulus * np.broadcast_to(outside.branches, tree.n_branches)
    return ArticulatedTree(
        tree,
        moduli[tree.branch_of_segment],
        species.density,
        min(outside.damping * known.damping_ratio, 1.0),
        outside.drag * law.coefficient,
        drag_exponent=law.exponent,
        steady_drag=outside.drag * law.steady,
        gravity=leaves.gravity,
        twist_ratio=_TWIST,
        leaf_mass=heavy,
        leaf_area=known.leaf_load_area,
    )


def swayed_outside(
    tree: Tree, species: Species, outside: Outside, *, in_leaf: bool
) -> Iterator[tuple[Floats, Floats]]:
    """
    Sway the tree outside: yield the mast's wind [m/s] and the poses of each step.

    Both are (3,) and (n, 7), and written again by the next step.
    """
    true = outside_tree(tree, species, outside, in_leaf=in_leaf)
    field, near = outside.field(tree)
    gusts = field.record(outside.seconds, 1.0 / DT, np.random.default_rng(outside.seed + 1))
    block = np.empty((tree.n_segments, 7))
    felt = np.zeros_like(near) if outside.is_uniform else near
    for wind in gusts:
        for _ in range(SUBSTEPS):
            true.step(wind[felt], DT / SUBSTEPS)
        yield wind[0], true.place(block)


def gusty_motion(
    tree: Tree, species: Species, places: Sequence[str], outside: Outside, *, in_leaf: bool
) -> TrueMotion:
    """Sway the tree outside: the mast's wind, its tips, and poses of places of sensors."""
    found = {name: place_on(tree, name) for name in places}
    winds, tips = [], []
    poses: dict[str, list[Floats]] = {name: [] for name in places}
    for wind, block in swayed_outside(tree, species, outside, in_leaf=in_leaf):
        winds.append(wind.copy())
        tips.append(tips_of_poses(tree, block))
        for name, place in found.items():
            poses[name].append(pose_at(tree, block, place))
    at = {name: np.array(each) for name, each in poses.items()}
    return TrueMotion(np.array(winds), np.array(tips), at)
