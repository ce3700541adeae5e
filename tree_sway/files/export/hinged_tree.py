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
from typing import Any, NamedTuple

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import eigsh, LinearOperator, splu
from scipy.spatial.transform import Rotation

from tree_sway.core.arrays import Floats
from tree_sway.core.model.drag_law import AIR_DENSITY, drag_density, SHARED_AT
from tree_sway.core.run.simulator import SwaySimulator
from tree_sway.core.setup.reductions import TreeReductions
from tree_sway.core.tree.tree import Tree

_MARGIN = 0.95
"""Largest step, as a share of the step at which the fastest motion becomes unstable."""
_FASTEST_TO = 1e-3
"""Relative tolerance of the fastest eigenvalue."""
_N_POINTS = 4
"""Points of integration by Gauss and Legendre on each half of a segment."""


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
    parent = tree.segment_parent
    rotation = Rotation.from_quat(poses[:, 3:])
    to_parent = rotation[parent].inv()
    position = to_parent.apply(poses[:, :3] - poses[parent, :3])
    orientation = (to_parent * rotation).as_quat()
    return np.where(parent[:, None] < 0, poses, np.hstack([position, orientation]))


def hinged_tree(simulator: SwaySimulator) -> HingedTree:
    """Divide the tree of a simulator into bodies on hinges."""
    tree = simulator.tree
    settings = simulator.settings
    species = simulator.models[0].species
    bodies = _bodies(tree, species.density, _spread(tree, settings.leaf_mass))
    compliance = _compliance(tree, species.modulus)
    compliance[0] += 1.0 / (settings.root_stiffness or species.root_stiffness)
    slowest, fastest = _extreme_eigenvalues(1.0 / compliance, _mass_matrix(tree, bodies))
    circular_frequency = 2.0 * math.pi * float(simulator.frequencies(1)[0])
    factor = circular_frequency**2 / slowest
    damping_time = 2.0 * simulator.check_tuning().damping_ratio / circular_frequency
    limit = damping_time + math.hypot(damping_time, 2.0 / math.sqrt(factor * fastest))
    return HingedTree(
        names=plain_names(tree),
        poses=poses_on_parents(tree, tree.rest_poses),
        mass=bodies.mass,
        centre=bodies.centre,
        inertia=bodies.inertia,
        stiffness=factor / compliance,
        drag_area=_drag_area(simulator),
        damping_time=damping_time,
        largest_step=_MARGIN * limit,
    )


def _extreme_eigenvalues(stiffness: Floats, mass_matrix: sparse.csc_matrix) -> tuple[float, float]:
    """Lowest and highest squared circular frequency [1/s^2] of hinges of a stiffness (n,)."""
    springs = sparse.diags(np.repeat(stiffness, 2)).tocsc()
    # Ordered by their pattern, the factors of the mass matrix of a tree stay sparse.
    factors = splu(
        mass_matrix, 'MMD_AT_PLUS_A', diag_pivot_thresh=0.0, options={'SymmetricMode': True}
    )
    inverse = LinearOperator(mass_matrix.shape, factors.solve, dtype=np.float64)
    slowest = _eigenvalue(springs, M=mass_matrix, sigma=0.0)
    fastest = _eigenvalue(springs, M=mass_matrix, Minv=inverse, tol=_FASTEST_TO)
    return slowest, fastest


def _eigenvalue(matrix: sparse.csc_matrix, **options: Any) -> float:
    return float(eigsh(matrix, 1, return_eigenvectors=False, **options)[0])


def _spread(tree: Tree, leaves: Floats | None) -> Floats:
    """Leaves of the branches, (b,), per length of each segment, (n,)."""
    if leaves is None:
        return np.zeros(tree.n_segments)
    return np.asarray((leaves / tree.branch_length)[tree.branch_of_segment])


def _drag_area(simulator: SwaySimulator) -> Floats:
    """Drag area [m^2] of each segment, as in `HingedTree`."""
    tree = simulator.tree
    model = simulator.models[0]
    reductions = TreeReductions(tree, model.species, simulator.settings)
    mean_diameter = 0.5 * (tree.base_diameter + tree.tip_diameter)
    area = (mean_diameter + _spread(tree, reductions.leaf_load_area)) * tree.length
    return 2.0 / AIR_DENSITY * drag_density(SHARED_AT, *model.drag_law) * area


class _Points(NamedTuple):
    """
    Points of integration on both halves of the segments, (n, 2, `_N_POINTS`).

    ``share``: place along the segment as a share of its length; ``part``: length that the point
    stands for [m]; ``diameter`` [m].
    """

    share: Floats
    part: Floats
    diameter: Floats

    @classmethod
    def of(cls, tree: Tree) -> _Points:
        """Return the points of a tree."""
        point, weight = np.polynomial.legendre.leggauss(_N_POINTS)
        share = np.stack([0.25 + 0.25 * point, 0.75 + 0.25 * point])[None]
        part = tree.length[:, None, None] * 0.25 * weight
        taper = tree.tip_diameter - tree.base_diameter
        diameter = tree.base_diameter[:, None, None] + taper[:, None, None] * share
        return cls(share, part, diameter)


def _compliance(tree: Tree, modulus: float) -> Floats:
    """Rotation of each hinge per moment [rad/N/m], (n,)."""
    points = _Points.of(tree)
    second_moment = np.pi / 64.0 * points.diameter**4
    bend = points.part / (modulus * second_moment)
    parent = tree.segment_parent
    branch = tree.branch_of_segment
    # The moment is constant in a segment with children, and that of a uniform load in the last.
    to_end = 1.0 - points.share
    has_children = np.isin(np.arange(tree.n_segments), parent)[:, None, None]
    moment = np.where(has_children, 1.0, to_end**2)
    at_start = (to_end * moment * bend).sum(axis=(1, 2))
    at_end = (points.share * bend).sum(axis=(1, 2))
    is_last_of_branch = np.isin(parent, tree.branch_first[1:] - 1)
    continues = (branch == branch[parent]) | is_last_of_branch
    return at_start + np.where(continues & (parent >= 0), at_end[parent], 0.0)


class _Bodies(NamedTuple):
    """Mass, centre and inertia as in `HingedTree`."""

    mass: Floats
    centre: Floats
    inertia: Floats


def _bodies(tree: Tree, density: float, leaf_line: Floats) -> _Bodies:
    """Bodies of the segments with leaves of a mass per length [kg/m], (n,)."""
    points = _Points.of(tree)
    along = tree.length[:, None, None] * points.share
    wood = density * np.pi / 4.0 * points.diameter**2 * points.part
    total = wood + leaf_line[:, None, None] * points.part
    mass = total.sum(axis=(1, 2))
    centre = (total * along).sum(axis=(1, 2)) / mass
    disc = (wood * points.diameter**2).sum(axis=(1, 2)) / 16.0
    across = (total * along**2).sum(axis=(1, 2)) - mass * centre**2 + disc
    return _Bodies(mass, centre, np.stack([2.0 * disc, across], axis=1))


def _mass_matrix(tree: Tree, bodies: _Bodies) -> sparse.csc_matrix:
    """
    Mass matrix of the hinges at rest, (2 n, 2 n), two after two as the segments are.

    It is J^T M J, with the Jacobian J of the bodies' motions by the rates of the hinges from the
    root to each body.
    """
    n = tree.n_segments
    axes = Rotation.from_quat(tree.rest_poses[:, 3:]).as_matrix()
    chains: list[list[int]] = []
    for segment, parent in enumerate(tree.segment_parent.tolist()):
        chains.append([*(chains[parent] if parent >= 0 else ()), segment])
    body = np.repeat(np.arange(n), [len(chain) for chain in chains])
    hinge = np.concatenate([np.array(chain) for chain in chains])
    centre = tree.start + bodies.centre[:, None] * axes[:, :, 0]
    hinge_axes = np.stack([axes[hinge, :, 1], axes[hinge, :, 2]], axis=1)
    lever = centre[body] - tree.start[hinge]
    speed = np.cross(hinge_axes, lever[:, None])
    spin = np.einsum('kij,khi->khj', axes[body], hinge_axes)  # about the body's own axes
    column = (2 * hinge[:, None] + np.arange(2)).ravel()
    row = np.repeat(body, 2)
    along, across = bodies.inertia.T
    total = sparse.csc_matrix((2 * n, 2 * n))
    for axis, inertia in enumerate((along, across, across)):
        for rate, weight in ((speed, bodies.mass), (spin, inertia)):
            jacobian = sparse.csc_matrix((rate[:, :, axis].ravel(), (row, column)), (n, 2 * n))
            total += jacobian.T @ sparse.diags(weight) @ jacobian
    return total
