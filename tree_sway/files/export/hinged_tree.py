# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A tree as rigid bodies on hinges, for engines of rigid bodies.

Each segment is a body, with two hinges across it where it begins. A hinge has the bending of the
wood from the middle of the segment before to the middle of its own; that of a branch of one
segment gives its tip the sway of the beam. What such lumps are too soft or too stiff is made up
for by one factor on all springs, which gives the first natural frequency of the simulator.
"""

from __future__ import annotations

from dataclasses import dataclass
import math
import re

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import eigsh
from scipy.spatial.transform import Rotation

from tree_sway.core.arrays import Floats
from tree_sway.core.simulator.simulator import SwaySimulator
from tree_sway.core.tree.tree import Tree


_MARGIN = 0.95
"""Of the time step at which the fastest motion at rest begins to grow."""


@dataclass(frozen=True)
class HingedTree:
    """
    Bodies of the segments, each in the frame of its segment: x along it.

    Parameters
    ----------
    names
        One per segment, of letters, digits and ``_``.
    poses
        In the frame of the segment each sits on, the root's in the world: x y z [m], quaternion
        x y z w, (n, 7).
    mass, centre
        Mass [kg] and how far along the segment its centre is [m], with leaves, (n,).
    inertia
        About the centre, along the segment and across it [kg m^2], (n, 2).
    stiffness
        Of each of the two hinges [N m/rad], (n,).
    damping_time
        Damping of the hinges over their stiffness [s]: the first mode has the damping ratio of the
        simulator, faster ones more.
    largest_step
        Time step [s] up to which Euler's semi-implicit method is stable, damping taken implicitly.

    """

    names: tuple[str, ...]
    poses: Floats
    mass: Floats
    centre: Floats
    inertia: Floats
    stiffness: Floats
    damping_time: float
    largest_step: float


def plain_names(tree: Tree) -> tuple[str, ...]:
    """Return names of the segments of letters, digits and ``_`` alone, each once."""
    names = [re.sub(r'\W', '_', name, flags=re.ASCII) for name in tree.segment_names]
    names = [name if name[0].isalpha() else f's_{name}' for name in names]
    if len(set(names)) < len(names):
        names = [f'{name}_{i}' for i, name in enumerate(names)]
    return tuple(names)


def poses_on_parents(tree: Tree, poses: Floats) -> Floats:
    """Poses (n, 7) in the frames of the segments that carry them; the root's as it is."""
    parent, turn = tree.segment_parent, Rotation.from_quat(poses[:, 3:])
    back = turn[parent].inv()
    turned, moved = (back * turn).as_quat(), back.apply(poses[:, :3] - poses[parent, :3])
    return np.where(parent[:, None] < 0, poses, np.hstack([moved, turned]))


def hinged_tree(simulator: SwaySimulator) -> HingedTree:
    """Part the tree of a simulator into bodies on hinges."""
    tree, species, settings = simulator.tree, simulator.species, simulator.settings
    point, weight = np.polynomial.legendre.leggauss(4)
    along = np.stack([0.25 + 0.25 * point, 0.75 + 0.25 * point])  # in both halves of a segment
    taper = tree.tip_diameter - tree.base_diameter
    diameter = tree.base_diameter[:, None, None] + taper[:, None, None] * along
    part = tree.length[:, None, None] * 0.25 * weight
    soft = part / (species.modulus * np.pi / 64.0 * diameter**4)
    first, second = soft.sum(axis=2).T
    counts = np.diff(tree.branch_first)[tree.branch_of_segment]
    begins = np.isin(np.arange(tree.n_segments), tree.branch_first[:-1])
    compliance = np.where(begins, first, first + np.roll(second, 1))
    alone = ((1.0 - along) ** 3 * soft).sum(axis=(1, 2))
    compliance = np.where(counts == 1, alone, compliance)
    root_stiffness = settings.root_stiffness or species.root_stiffness
    compliance[0] += 1.0 / root_stiffness

    wood = species.density * np.pi / 4.0 * diameter**2 * part
    leaves = np.zeros(tree.n_branches) if settings.leaf_mass is None else settings.leaf_mass
    line = wood + (leaves / tree.branch_length)[tree.branch_of_segment, None, None] * part
    mass, away = line.sum(axis=(1, 2)), tree.length[:, None, None] * along
    centre = (line * away).sum(axis=(1, 2)) / mass
    disc = (wood * diameter**2).sum(axis=(1, 2)) / 16.0
    across = (line * away**2).sum(axis=(1, 2)) - mass * centre**2 + disc
    inertia = np.stack([2.0 * disc, across], axis=1)

    masses = _mass_matrix(tree, mass, centre, inertia)
    springs = sparse.diags(np.repeat(1.0 / compliance, 2)).tocsc()
    slowest, fastest = (
        float(eigsh(springs, 1, M=masses, sigma=sigma, return_eigenvectors=False)[0])
        for sigma in (0.0, None)
    )
    circular = 2.0 * math.pi * float(simulator.frequencies(1)[0])
    factor = circular**2 / slowest
    damping_time = 2.0 * simulator.check_tuning().damping_ratio / circular
    limit = damping_time + math.hypot(damping_time, 2.0 / math.sqrt(factor * fastest))
    return HingedTree(
        names=plain_names(tree),
        poses=poses_on_parents(tree, tree.rest_poses),
        mass=mass,
        centre=centre,
        inertia=inertia,
        stiffness=factor / compliance,
        damping_time=damping_time,
        largest_step=_MARGIN * limit,
    )


def _mass_matrix(tree: Tree, mass: Floats, centre: Floats, inertia: Floats) -> sparse.csc_matrix:
    """Mass matrix of the hinges at rest, (2 n, 2 n), two after two as the segments are."""
    axes = Rotation.from_quat(tree.rest_poses[:, 3:]).as_matrix()
    at = tree.start + centre[:, None] * axes[:, :, 0]
    chains: list[list[int]] = []
    for i, parent in enumerate(tree.segment_parent.tolist()):
        chains.append([*(chains[parent] if parent >= 0 else ()), i])
    body = np.repeat(np.arange(tree.n_segments), [len(chain) for chain in chains])
    hinge = np.concatenate([np.array(chain) for chain in chains])
    total: sparse.csc_matrix = 0.0
    lever = at[body] - tree.start[hinge]
    # Velocities of the centre, and of the turn in the axes of the body, by the rates of the hinges.
    turns = np.stack([axes[hinge, :, 1], axes[hinge, :, 2]], axis=1)
    speeds = np.cross(turns, lever[:, None])
    spins = np.einsum('kij,khi->khj', axes[body], turns)
    weights = np.stack([inertia[:, 0], inertia[:, 1], inertia[:, 1]], axis=1)
    columns = (2 * hinge[:, None] + np.arange(2)).ravel()
    rows, shape = np.repeat(body, 2), (tree.n_segments, 2 * tree.n_segments)
    for k in range(3):
        for values, weight in ((speeds, mass), (spins, weights[:, k])):
            moved = sparse.csc_matrix((values[:, :, k].ravel(), (rows, columns)), shape)
            total = total + moved.T @ sparse.diags(weight) @ moved
    return total.tocsc()
