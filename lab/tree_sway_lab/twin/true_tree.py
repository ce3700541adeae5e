# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A tree that the model does not know: other wood, other damping, and gusts of its own.

Its motion in a wind, and the poses of the places at which sensors sit.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.special import ndtri

from tree_sway.core.arrays import Floats
from tree_sway.core.drag import DragLaw
from tree_sway.core.run import SwaySimulator
from tree_sway.core.scene import make_simulator
from tree_sway.core.setup import prepare
from tree_sway.core.species import Species, species_keys, species_named
from tree_sway.core.tree import ends_of_poses, tips_of_poses, Tree
from tree_sway.core.wind import simulate_turbulence
from tree_sway.growth import grow
from tree_sway.twin import place_on, SensorPlace, uncertainty_of, uncorrelated_draws
from tree_sway_lab.kinds.kinds import kind_called

DT = 1.0 / 60.0


@dataclass(frozen=True)
class Circumstances:
    """
    What the model does not know.

    Parameters
    ----------
    wood, damping
        Modulus of the true tree over the model's, and its damping ratio over the model's [-].
    drag
        Drag area of the true tree over the model's [-].
    coherence
        Share of a gust that reaches the whole crown at once [-].
    upwind
        Distance of the anemometer upwind of the tree in [m].
    speed, seconds
        Mean wind in [m/s] and length of the record in [s].
    seed
        Seed of wind and sensors.

    """

    wood: float = 0.8
    damping: float = 1.5
    drag: float = 1.0
    coherence: float = 0.3
    upwind: float = 0.0
    speed: float = 7.0
    seconds: float = 120.0
    seed: int = 101


def drawn(around: Circumstances, count: int, *, in_leaf: bool) -> list[Circumstances]:
    """
    Draw wood, damping and drag of a number of true trees from their spreads, each in its own wind.

    Each takes one value from every stratum of each spread, from anywhere in it: the middles of few
    strata are all within the band that they are to judge.
    """
    rng = np.random.default_rng(around.seed)
    spreads = np.array(uncertainty_of(in_leaf=in_leaf))
    strata = uncorrelated_draws(count, len(spreads), rng).argsort(axis=1).argsort(axis=1)
    drawn_values = ndtri((strata + rng.random(strata.shape)) / count)
    factors = np.exp(spreads[:, None] * drawn_values).T.tolist()
    return [
        replace(around, wood=wood, damping=damping, drag=drag, seed=around.seed + k)
        for k, (wood, damping, drag) in enumerate(factors)
    ]


class TrueMotion(NamedTuple):
    """Wind at the anemometer (n, 3), tips (n, b, 3), and poses of places by name, (n, 7)."""

    wind: Floats
    tips: Floats
    poses: dict[str, Floats]


def tree_called(name: str) -> tuple[Tree, Species]:
    """
    Return a kind of the laboratory, or a species of a height, as ``spruce 12``, and its wood.

    A third word is the seed of a grown tree.
    """
    words = name.split()
    if words[0] in species_keys() and len(words) > 1:
        rng = np.random.default_rng(int(words[2]) if len(words) > 2 else 1)
        return grow(words[0], float(words[1]), rng=rng), species_named(words[0])
    return kind_called(name), replace(species_named('oak'), modulus=8.0e9, density=900.0)


def sensor_places(tree: Tree, count: int) -> list[str]:
    """Return places of sensors: the stem at 0.6 of its length, then the stoutest limbs."""
    first = tree.branch_first
    limbs = np.flatnonzero(tree.branch_parent == 0)
    sizes = [
        float(tree.length[first[b] : first[b + 1]].sum() * tree.base_diameter[first[b]] ** 2)
        for b in limbs
    ]
    order = limbs[np.argsort(sizes)[::-1]].tolist()
    names = tree.branch_names
    return [f'{names[0]}:0.6', *(f'{names[b]}:0.5' for b in order)][:count]


def true_simulator(
    tree: Tree,
    species: Species,
    around: Circumstances,
    *,
    in_leaf: bool,
    model: int | str = 'full',
) -> SwaySimulator:
    """Return a simulator of the true tree."""
    known = prepare(tree, species, model=0, in_leaf=in_leaf)
    model_of_true = prepare(
        tree,
        replace(species, modulus=around.wood * species.modulus),
        model=model,
        in_leaf=in_leaf,
        crown_coherence=around.coherence,
        damping_ratio=min(around.damping * known.damping_ratio, 1.0),
    )
    leaves, exponent, wood = model_of_true.drag_law
    law = DragLaw(around.drag * leaves, exponent, around.drag * wood)
    return make_simulator(replace(model_of_true, drag_law=law))


def winds(around: Circumstances) -> tuple[Floats, Floats]:
    """Return the wind of every step at the tree and at the anemometer in [m/s], (n, 3) each."""
    late = round(around.upwind / around.speed / DT)
    wind = simulate_turbulence(
        around.speed,
        rate=1.0 / DT,
        duration=around.seconds + late * DT,
        rng=np.random.default_rng(around.seed),
    )
    return wind[: len(wind) - late], wind[late:]


def true_motion(
    tree: Tree,
    species: Species,
    places: Sequence[str],
    around: Circumstances,
    *,
    in_leaf: bool,
    model: int | str = 'full',
) -> TrueMotion:
    """Sway the true tree in its wind."""
    true = true_simulator(tree, species, around, in_leaf=in_leaf, model=model)
    felt, measured = winds(around)
    found = {name: place_on(tree, name) for name in places}
    poses = {name: np.empty((len(felt), 7)) for name in places}
    tips = np.empty((len(felt), tree.n_branches, 3))
    block = np.empty((tree.n_segments, 7))
    for k, each in enumerate(felt):
        true.step(each, DT)
        true.place(block)
        tips[k] = tips_of_poses(tree, block)
        for name, place in found.items():
            poses[name][k] = pose_at(tree, block, place)
    return TrueMotion(measured, tips, poses)


def pose_at(tree: Tree, block: Floats, place: SensorPlace) -> Floats:
    """Pose of a place (7,) in a pose block (n, 7): that of its segment, moved along it."""
    pose = block[place.segment].copy()
    away = place.along * float(tree.length[place.segment])
    pose[:3] = ends_of_poses(block[place.segment : place.segment + 1], [away])[1][0]
    return pose
