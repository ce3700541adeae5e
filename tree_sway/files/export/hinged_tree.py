# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A tree as rigid bodies on hinges, for engines of rigid bodies.

Each segment is a body on hinges where it begins: two across it, and one along it, about which wood
twists. The bending of a segment is divided between the hinges at its two ends by linear shape
functions; the part at a tip is lost. Springs hold the tree in its rest shape under weight, which
pulls it further over as it leans. One factor on all springs then gives the first natural frequency
of the simulator; it is near 1. Engines whose joints have two axes get neither twist nor weight,
and the factor makes up for both.
"""

from __future__ import annotations

import math
import re
from typing import NamedTuple

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import eigsh, LinearOperator, splu
from scipy.spatial.transform import Rotation

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.drag import AIR_DENSITY, drag_density, SHARED_AT
from tree_sway.core.run import SwaySimulator
from tree_sway.core.setup import round_section, TreeReductions
from tree_sway.core.species import Species
from tree_sway.core.tree import Tree
from tree_sway.errors import TreeError

_MARGIN = 0.95
"""Largest step, as a share of the step at which the fastest motion becomes unstable."""
_FASTEST_TO = 1e-3
"""Relative tolerance of the fastest eigenvalue."""
_FREQUENCY_TO = 1e-6
"""Relative tolerance of the slowest eigenvalue."""
_MOST_TRIALS = 8
_GRAVITY = 9.81
_N_POINTS = 4
"""Points of integration by Gauss and Legendre on each half of a segment."""


class HingedTree(NamedTuple):
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
        Stiffness of the hinges about the axes y and z and, of three, x of the segment [N m/rad],
        (n, 2) or (n, 3).
    reference
        Angles at which the springs have no moment, since they carry the weight at rest [rad], as
        `stiffness`; 0 without weight.
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
    reference: Floats
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


def hinged_tree(simulator: SwaySimulator, *, has_twist_and_weight: bool = True) -> HingedTree:
    """Divide the tree of a simulator into bodies on three hinges, or on two without weight."""
    tree = simulator.tree
    settings = simulator.settings
    species = simulator.models[0].species
    bodies = _bodies(tree, species.density, _spread(tree, settings.leaf_mass))
    n_axes = 3 if has_twist_and_weight else 2
    hinges = _Hinges(tree, bodies, n_axes)
    root_stiffness = settings.root_stiffness or species.root_stiffness
    springs = _springs(tree, species, root_stiffness)[:, :n_axes]
    mass_matrix = hinges.mass_matrix()
    gravity = _GRAVITY if has_twist_and_weight else 0.0
    moment, weight_stiffness = hinges.weight(gravity)
    circular_frequency = 2.0 * math.pi * float(simulator.frequencies(1)[0])
    stiffness = sparse.diags(springs.ravel()).tocsc()
    factor, share = _factor_on_springs(
        stiffness, weight_stiffness, mass_matrix, circular_frequency**2
    )
    damping_ratio = simulator.check_tuning().damping_ratio
    damping_time = 2.0 * damping_ratio / (circular_frequency * share)
    fastest = factor * _fastest(stiffness, mass_matrix)
    limit = damping_time + math.hypot(damping_time, 2.0 / math.sqrt(fastest))
    springs = factor * springs
    return HingedTree(
        names=plain_names(tree),
        poses=poses_on_parents(tree, tree.rest_poses),
        stiffness=springs,
        reference=-moment / springs,
        drag_area=_drag_area(simulator),
        damping_time=damping_time,
        largest_step=_MARGIN * limit,
        **bodies._asdict(),
    )


def _factor_on_springs(
    stiffness: sparse.csc_matrix,
    weight_stiffness: sparse.csc_matrix,
    mass_matrix: sparse.csc_matrix,
    wanted: float,
) -> tuple[float, float]:
    """
    Find the factor on springs that gives the slowest mode a squared circular frequency [1/s^2].

    By Newton's method: the eigenvalue changes with the factor by the energy of the springs in the
    mode. The second figure is the share of the mode's stiffness that springs have; the rest, below
    0 where the tree stands, is that of the weight. A `TreeError` if none is found.
    """
    factor = 1.0
    for _ in range(_MOST_TRIALS):
        total = factor * stiffness + weight_stiffness
        (slowest,), mode = eigsh(total, 1, M=mass_matrix, sigma=-wanted)
        of_springs = float(mode[:, 0] @ (stiffness @ mode[:, 0]))  # modes have a mass of 1
        if abs(slowest / wanted - 1.0) < _FREQUENCY_TO:
            return factor, factor * of_springs / wanted
        factor += (wanted - slowest) / of_springs
    frequency = math.sqrt(wanted) / (2.0 * math.pi)
    raise TreeError(
        f'bodies on springs do not sway at {frequency:.3g} Hz', where='export', cure='write .sdf'
    )


def _fastest(stiffness: sparse.csc_matrix, mass_matrix: sparse.csc_matrix) -> float:
    """Highest squared circular frequency [1/s^2] on springs."""
    # Ordered by their pattern, the factors of the mass matrix of a tree stay sparse.
    factors = splu(
        mass_matrix, 'MMD_AT_PLUS_A', diag_pivot_thresh=0.0, options={'SymmetricMode': True}
    )
    inverse = LinearOperator(mass_matrix.shape, factors.solve, dtype=np.float64)
    found = eigsh(
        stiffness, 1, M=mass_matrix, Minv=inverse, tol=_FASTEST_TO, return_eigenvectors=False
    )
    return float(found[0])


def _spread(tree: Tree, leaves: Floats | None) -> Floats:
    """Leaves of the branches, (b,), per length of each segment, (n,)."""
    if leaves is None:
        return np.zeros(tree.n_segments)
    return (leaves / tree.branch_length)[tree.branch_of_segment]


def _drag_area(simulator: SwaySimulator) -> Floats:
    """Drag area [m^2] of each segment, as in `HingedTree`."""
    tree = simulator.tree
    model = simulator.models[0]
    reductions = TreeReductions(tree, model.species, simulator.settings)
    mean_diameter = 0.5 * (tree.base_diameter + tree.tip_diameter)
    leaf_width = _spread(tree, reductions.leaf_load_area)
    area = (mean_diameter + leaf_width) * tree.length
    drag = drag_density(SHARED_AT, *model.drag_law)
    return 2.0 / AIR_DENSITY * drag * area


def _points(tree: Tree) -> tuple[Floats, Floats, Floats]:
    """
    Return points of integration on both halves of the segments, (n, 2 `_N_POINTS`).

    Place along the segment as a share of its length, the same on all; length that the point
    stands for [m]; diameter there [m].
    """
    point, weight = np.polynomial.legendre.leggauss(_N_POINTS)
    share = np.concatenate([0.25 + 0.25 * point, 0.75 + 0.25 * point])
    part = 0.25 * np.outer(tree.length, np.tile(weight, 2))
    base = tree.base_diameter[:, None]
    return share, part, base + np.outer(tree.tip_diameter - tree.base_diameter, share)


def _springs(tree: Tree, wood: Species, root_stiffness: float) -> Floats:
    """Stiffness of the hinges [N m/rad], (n, 3): two of bending, and one of twist."""
    share, part, diameter = _points(tree)
    bend = part / (wood.modulus * round_section(diameter))
    parent = tree.segment_parent
    branch = tree.branch_of_segment
    # The moment is constant in a segment with children, and that of a uniform load in the last.
    to_end = 1.0 - share
    has_children = np.isin(np.arange(tree.n_segments), parent)[:, None]
    moment = np.where(has_children, 1.0, to_end**2)
    compliance = (to_end * moment * bend).sum(axis=1)
    at_end = (share * bend).sum(axis=1)
    is_last_of_branch = np.isin(parent, tree.branch_first[1:] - 1)
    continues = (branch == branch[parent]) | is_last_of_branch
    compliance += np.where(continues & (parent >= 0), at_end[parent], 0.0)
    # A round section has twice the second moment for twist that it has for bending.
    twist = 2.0 * wood.shear_ratio / compliance
    compliance[0] += 1.0 / root_stiffness
    bending = 1.0 / compliance
    return np.column_stack([bending, bending, twist])


class _Bodies(NamedTuple):
    """Mass, centre and inertia as in `HingedTree`."""

    mass: Floats
    centre: Floats
    inertia: Floats


def _bodies(tree: Tree, density: float, leaf_line: Floats) -> _Bodies:
    """Bodies of the segments with leaves of a mass per length [kg/m], (n,)."""
    share, part, diameter = _points(tree)
    along = np.outer(tree.length, share)
    wood = density * np.pi / 4.0 * diameter**2 * part
    total = wood + leaf_line[:, None] * part
    mass = total.sum(axis=1)
    centre = (total * along).sum(axis=1) / mass
    disc = (wood * diameter**2).sum(axis=1) / 16.0
    about_start = (total * along**2).sum(axis=1)
    across = about_start - mass * centre**2 + disc
    inertia = np.column_stack([2.0 * disc, across])
    return _Bodies(mass, centre, inertia)


class _Hinges:
    """
    Axes of the hinges at rest about y, z and, of three, x, and which of them carry which bodies.

    ``frame``: axes of the segments in the columns of matrices, (n, 3, 3).
    ``axes``: unit vectors of the hinges of each segment in the order of the joints, (n, k, 3).
    ``hinge`` and ``body``: each pair of a segment and one that it carries or is, (p,).
    ``lever``: centres of the bodies from the hinges that carry them [m], (p, 3).
    """

    def __init__(self, tree: Tree, bodies: _Bodies, n_axes: int) -> None:
        self.bodies = bodies
        self.n_axes = n_axes
        self.shape = 2 * (n_axes * tree.n_segments,)
        self.frame = Rotation.from_quat(tree.rest_poses[:, 3:]).as_matrix()
        self.axes = self.frame.transpose(0, 2, 1)[:, [1, 2, 0][:n_axes]]
        chains: dict[int, list[int]] = {-1: []}
        for segment, parent in enumerate(tree.segment_parent.tolist()):
            chains[segment] = [*chains[parent], segment]
        pairs = [(hinge, body) for body, chain in chains.items() for hinge in chain]
        self.hinge, self.body = np.array(pairs).T
        centre = tree.start + bodies.centre[:, None] * self.frame[:, :, 0]
        self.lever = centre[self.body] - tree.start[self.hinge]

    def numbers(self, segment: Ints) -> Ints:
        """Return the numbers of the hinges of segments, (p, k)."""
        return self.n_axes * segment[:, None] + np.arange(self.n_axes)

    def mass_matrix(self) -> sparse.csc_matrix:
        """
        Mass matrix of the hinges at rest, (k n, k n), in the order of the segments.

        It is J^T M J, with the Jacobian J of the bodies' motions by the rates of the hinges from
        the root to each body.
        """
        mass, _, inertia = self.bodies
        axes = self.axes[self.hinge]
        speed = np.cross(axes, self.lever[:, None])
        spin = np.einsum('kij,khi->khj', self.frame[self.body], axes)  # about the body's own axes
        place = np.repeat(self.body, self.n_axes), self.numbers(self.hinge).ravel()
        total = sparse.csc_matrix(self.shape)
        for axis, about_axis in enumerate(inertia.T[[0, 1, 1]]):
            for rate, weight in ((speed, mass), (spin, about_axis)):
                values = rate[:, :, axis].ravel()
                jacobian = sparse.csc_matrix((values, place), (len(mass), self.shape[1]))
                total += jacobian.T @ sparse.diags(weight) @ jacobian
        return total

    def weight(self, gravity: float) -> tuple[Floats, sparse.csc_matrix]:
        """
        Moments of the weight about the hinges [N m], (n, k), and its stiffness, (k n, k n).

        With r the sum of mass times lever of all that a hinge j carries, the potential grows by
        g e_z (a_j x r) per angle, and that by g e_z (a_i x (a_j x r)) per angle of a hinge i below
        it.
        """
        carried = np.zeros(self.axes[:, 0].shape)
        np.add.at(carried, self.hinge, self.bodies.mass[self.body, None] * self.lever)
        turned = np.cross(self.axes, carried[:, None])
        lower = self.axes[self.hinge, :, None]
        upper = turned[self.body, None]
        change = np.cross(lower, upper)[..., 2] * gravity
        # Hinges of one segment turn one after another.
        change[self.hinge == self.body] *= np.tri(self.n_axes).T
        row = np.repeat(self.numbers(self.hinge), self.n_axes, axis=1).ravel()
        column = np.tile(self.numbers(self.body), self.n_axes).ravel()
        half = sparse.csc_matrix((change.ravel(), (row, column)), self.shape)
        moment = -gravity * turned[:, :, 2]
        return moment, half + half.T - sparse.diags(half.diagonal())
