# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A tree as rigid bodies on hinges, for engines of rigid bodies.

Each segment is a body, with two hinges across it where it begins and none along it: wood does not
twist here. The bending of a segment is divided between the hinges at its two ends by linear shape
functions; the part at a tip is lost. One factor on all springs then gives the first natural
frequency of the simulator, with weight and twist.
"""

from __future__ import annotations

from dataclasses import dataclass
import math
import re
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import eigsh, LinearOperator, splu
from scipy.spatial.transform import Rotation

from tree_sway.core.arrays import Floats
from tree_sway.core.model.drag_law import AIR_DENSITY, pressure, SHARED_AT
from tree_sway.core.run.simulator import SwaySimulator
from tree_sway.core.setup.reductions import TreeReductions
from tree_sway.core.tree.tree import Tree

_MARGIN, _FASTEST_TO = 0.95, 1e-3
"""Share of the time step at which the fastest motion becomes unstable; its tolerance."""


@dataclass(frozen=True)
class HingedTree:
    """
    Bodies of the segments, each in the frame of its segment: x along it.

    Parameters
    ----------
    names
        Names of the segments, of letters, digits and ``_``.
    poses
        Poses in the frames of the parent segments, the root's in the world: x y z [m], quaternion
        x y z w, (n, 7).
    mass, centre
        Mass [kg] and place of its centre along the segment [m], with leaves, (n,).
    inertia
        Inertia about the centre, along the segment and across it [kg m^2], (n, 2).
    stiffness
        Stiffness of each of the two hinges [N m/rad], (n,).
    drag_area
        Drag coefficient times area of the segment with its leaves, in wind of `SHARED_AT` across
        it [m^2], (n,).
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
    drag_area: Floats
    damping_time: float
    largest_step: float


def plain_name(name: str) -> str:
    """Return a name of letters, digits and ``_``, a letter first."""
    plain = re.sub(r'\W', '_', name, flags=re.ASCII)
    return plain if plain[:1].isalpha() else f's_{plain}'


def plain_names(tree: Tree) -> tuple[str, ...]:
    """Return unique names of the segments of letters, digits and ``_``."""
    names = [plain_name(name) for name in tree.segment_names]
    if len(set(names)) < len(names):
        names = [f'{name}_{i}' for i, name in enumerate(names)]
    return tuple(names)


def poses_on_parents(tree: Tree, poses: Floats) -> Floats:
    """Poses (n, 7) in the frames of the parent segments; that of the root is unchanged."""
    parent, turn = tree.segment_parent, Rotation.from_quat(poses[:, 3:])
    back = turn[parent].inv()
    turned, moved = (back * turn).as_quat(), back.apply(poses[:, :3] - poses[parent, :3])
    return np.where(parent[:, None] < 0, poses, np.hstack([moved, turned]))


def hinged_tree(simulator: SwaySimulator) -> HingedTree:
    """Divide the tree of a simulator into bodies on hinges."""
    tree, settings = simulator.tree, simulator.settings
    leaf_line = _spread(tree, settings.leaf_mass)
    mass, centre, inertia = _bodies(tree, simulator.models[0].species.density, leaf_line)
    compliance = _compliance(tree, simulator.models[0].species.modulus)
    compliance[0] += 1.0 / (settings.root_stiffness or simulator.models[0].species.root_stiffness)
    springs = sparse.diags(np.repeat(1.0 / compliance, 2)).tocsc()
    masses = _mass_matrix(tree, mass, centre, inertia)
    # Ordered by their pattern, the factors of the mass matrix of a tree stay sparse.
    solve = splu(
        masses, 'MMD_AT_PLUS_A', diag_pivot_thresh=0.0, options={'SymmetricMode': True}
    ).solve
    inverse = LinearOperator(masses.shape, solve, dtype=np.float64)
    slowest = _eigenvalue(springs, M=masses, sigma=0.0)
    fastest = _eigenvalue(springs, M=masses, Minv=inverse, tol=_FASTEST_TO)
    circular = 2.0 * math.pi * float(simulator.frequencies(1)[0])
    factor = circular**2 / slowest
    damping_time = 2.0 * simulator.check_tuning().damping_ratio / circular
    limit = damping_time + math.hypot(damping_time, 2.0 / math.sqrt(factor * fastest))
    return HingedTree(
        names=plain_names(tree), poses=poses_on_parents(tree, tree.rest_poses), mass=mass,
        centre=centre, inertia=inertia, stiffness=factor / compliance,
        drag_area=_drag_area(simulator), damping_time=damping_time,
        largest_step=_MARGIN * limit,
    )  # fmt: skip


def _spread(tree: Tree, leaves: Floats | None) -> Floats:
    """Leaves of the branches, (b,), per length of each segment, (n,)."""
    if leaves is None:
        return np.zeros(tree.n_segments)
    return np.asarray((leaves / tree.branch_length)[tree.branch_of_segment])


def _drag_area(simulator: SwaySimulator) -> Floats:
    tree = simulator.tree
    diameter = 0.5 * (tree.base_diameter + tree.tip_diameter)
    reductions = TreeReductions(tree, simulator.models[0].species, simulator.settings)
    area = (diameter + _spread(tree, reductions.leaf_load_area)) * tree.length
    return 2.0 / AIR_DENSITY * pressure(SHARED_AT, *simulator.models[0].drag_law) * area


def _eigenvalue(matrix: sparse.csc_matrix, **options: Any) -> float:
    return float(eigsh(matrix, 1, return_eigenvectors=False, **options)[0])


def _points(tree: Tree) -> tuple[Floats, Floats, Floats]:
    """Places along both halves of the segments, (2, 4); lengths and diameters [m], (n, 2, 4)."""
    point, weight = np.polynomial.legendre.leggauss(4)
    along = np.stack([0.25 + 0.25 * point, 0.75 + 0.25 * point])
    taper = tree.tip_diameter - tree.base_diameter
    diameter = tree.base_diameter[:, None, None] + taper[:, None, None] * along
    return along, tree.length[:, None, None] * 0.25 * weight, diameter


def _compliance(tree: Tree, modulus: float) -> Floats:
    """Rotation of each hinge per moment [rad/N/m], (n,)."""
    along, part, diameter = _points(tree)
    soft = part / (modulus * np.pi / 64.0 * diameter**4)
    carrier, branch = tree.segment_parent, tree.branch_of_segment
    carries = np.isin(np.arange(tree.n_segments), carrier)[:, None, None]
    # The moment is constant in a segment with children, and that of a uniform load in the last.
    own = ((1.0 - along) * np.where(carries, 1.0, (1.0 - along) ** 2) * soft).sum(axis=(1, 2))
    onward = (along * soft).sum(axis=(1, 2))
    ends = np.isin(carrier, tree.branch_first[1:] - 1)
    continues = (branch == branch[carrier]) | ends
    return own + np.where(continues & (carrier >= 0), onward[carrier], 0.0)


def _bodies(tree: Tree, density: float, leaf_line: Floats) -> tuple[Floats, Floats, Floats]:
    """Mass, centre and inertia as in `HingedTree`, with leaves [kg/m], (n,)."""
    along, part, diameter = _points(tree)
    wood = density * np.pi / 4.0 * diameter**2 * part
    line, away = wood + leaf_line[:, None, None] * part, tree.length[:, None, None] * along
    mass = line.sum(axis=(1, 2))
    centre = (line * away).sum(axis=(1, 2)) / mass
    disc = (wood * diameter**2).sum(axis=(1, 2)) / 16.0
    across = (line * away**2).sum(axis=(1, 2)) - mass * centre**2 + disc
    return mass, centre, np.stack([2.0 * disc, across], axis=1)


def _mass_matrix(tree: Tree, mass: Floats, centre: Floats, inertia: Floats) -> sparse.csc_matrix:
    """Mass matrix of the hinges at rest, (2 n, 2 n), two after two as the segments are."""
    axes = Rotation.from_quat(tree.rest_poses[:, 3:]).as_matrix()
    chains: list[list[int]] = []
    for i, parent in enumerate(tree.segment_parent.tolist()):
        chains.append([*(chains[parent] if parent >= 0 else ()), i])
    body = np.repeat(np.arange(tree.n_segments), [len(chain) for chain in chains])
    hinge = np.concatenate([np.array(chain) for chain in chains])
    # Speeds of a body's centre, and spins about its axes, by the rates of the hinges before it.
    turns = np.stack([axes[hinge, :, 1], axes[hinge, :, 2]], axis=1)
    lever = (tree.start + centre[:, None] * axes[:, :, 0])[body] - tree.start[hinge]
    speeds = np.cross(turns, lever[:, None])
    spins = np.einsum('kij,khi->khj', axes[body], turns)
    columns = (2 * hinge[:, None] + np.arange(2)).ravel()
    rows, shape = np.repeat(body, 2), (tree.n_segments, 2 * tree.n_segments)
    total = sparse.csc_matrix((shape[1], shape[1]))
    for k in range(3):
        for values, weight in ((speeds, mass), (spins, inertia[:, min(k, 1)])):
            moved = sparse.csc_matrix((values[:, :, k].ravel(), (rows, columns)), shape)
            total += moved.T @ sparse.diags(weight) @ moved
    return total
