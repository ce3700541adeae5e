# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Matrices of the key rotations, against differences of placed segments.

Placing knows nothing of mass or weight, and the matrices nothing of quaternions: the kinetic
energy of the placed segments and the second variation of the height of pieces that turn one upon
another must be what the matrices say.

"""

from __future__ import annotations

from drawn_trees import Sketch, towards, UP
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tree_sway.core.native.model import bytes_of, NativeModel
from tree_sway.core.native.stand import NativeStand
from tree_sway.core.setup.beams.branch_model import TreeBeams
from tree_sway.core.setup.branch_places import places_of
from tree_sway.core.setup.branch_records import branch_records
from tree_sway.core.setup.matrices import reduce_tree

MODULUS, SHEAR, DENSITY = 9e9, 3.5e9, 900.0
_GAUSS, _WEIGHT = np.polynomial.legendre.leggauss(5)


def stand_of(tree, places, twist):
    """Return a native stand of a tree that can be placed alone."""
    room = twist.shape[1]
    turn = np.zeros((tree.n_segments, room, 3))
    turn[:, : places.segment_turn.shape[1]] = places.segment_turn
    arrays = {
        'tree_start': tree.start, 'tree_end': tree.end,
        'tree_base_diameter': tree.base_diameter, 'tree_tip_diameter': tree.tip_diameter,
        'branch_first': places.first, 'branch_parent': places.parent,
        'branch_base_segment': places.base_segment, 'branch_coordinate': places.coordinate,
        'branch_keys': places.n_coordinates, 'branch_frame': places.frame,
        'branch_skew': np.stack([places.skew, places.tip_skew], axis=1),
        'branch_offset': places.offset, 'branch_twist': twist,
        'segment_slope': places.slope, 'segment_tip_slope': places.tip_slope,
        'segment_chord': places.chord, 'segment_rest': places.rest, 'segment_turn': turn,
    }  # fmt: skip
    place = np.array([[*tree.start[0], 0.0, 1.0]])
    model = NativeModel(bytes_of(arrays))
    return NativeStand([model], np.zeros(1, dtype=np.int64), place, np.ones(1))


class Reduced:
    """A tree with its matrices and the way to place it."""

    def __init__(self, tree, gravity=9.81, enriched=(), subtrees=True, **leaves):
        self.tree = tree
        beams = TreeBeams(tree, DENSITY, **leaves)
        self.models = beams.models(subtrees=subtrees, enriched=frozenset(enriched))
        self.reduction = reduce_tree(tree, self.models, MODULUS, SHEAR, gravity, subtrees=subtrees)
        even = np.ones(tree.n_segments)
        places = places_of(tree, self.models, self.reduction)
        self.branches = branch_records(tree, self.models, self.reduction, places, even)
        self.stand = stand_of(tree, places, self.branches['twist'])

    def poses(self, x):
        out = np.empty((self.tree.n_segments, 7))
        self.stand.place_keys(0, np.ascontiguousarray(x), out)
        return out

    def points(self, x):
        """
        Twenty points of each segment, (n, 20, 3), four in each of five cross-sections.

        Masses there are as hard to rotate as the discs.
        """
        out, u, tree = self.poses(x), 0.5 + 0.5 * _GAUSS, self.tree
        d = tree.base_diameter[:, None] * (1 - u) + tree.tip_diameter[:, None] * u
        ring = np.array([(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)])
        places = np.empty((tree.n_segments, 5, 4, 3))
        places[..., 0] = (u * tree.length[:, None])[:, :, None]
        places[..., 1:] = d[..., None, None] / 8.0**0.5 * ring
        frame = Rotation.from_quat(out[:, 3:]).as_matrix()
        moved = np.einsum('nij,ngrj->ngri', frame, places)
        return out[:, None, :3] + moved.reshape(tree.n_segments, 20, 3)

    @property
    def weights(self):
        """Mass at each of those points in [kg], (n, 20)."""
        u = 0.5 + 0.5 * _GAUSS
        tree = self.tree
        d = tree.base_diameter[:, None] * (1 - u) + tree.tip_diameter[:, None] * u
        masses = DENSITY * np.pi / 4.0 * d**2 * tree.length[:, None] * 0.5 * _WEIGHT
        return np.repeat(masses / 4.0, 4, axis=1)


def mass_by_differences(reduced, differences):
    x0 = np.zeros(reduced.reduction.n_coordinates)
    moved = differences(reduced.points, x0)
    return np.einsum('sg,sgki,sgkj->ij', reduced.weights, moved, moved)


def height_of_weight(reduced, x):
    """
    Mass times height in [kg m], every piece of a branch turned on top of all before it.

    So does the elastic moment that bears the weight at rest turn with the piece it acts on, and
    its work is of first order alone. Placing turns a segment at once by the sum of what turns it.

    """
    tree, first, total = reduced.tree, reduced.reduction.first, 0.0
    bases = [(np.eye(3), tree.start[0])] * tree.n_branches
    for b, model in enumerate(reduced.models):
        beam, (turn, base) = model.beam, bases[b]
        own = x[first[b] : first[b + 1]]
        slope = np.tensordot(own, [one.slope for one in model.fields], axes=1).reshape(-1, 3)
        steps = Rotation.from_rotvec(np.diff(slope, axis=0, prepend=np.zeros((1, 3))))
        turns = [turn]
        for step in steps.as_matrix():
            turns.append(turns[-1] @ step)
        tangents = np.repeat(beam.tangent, 5, axis=0)
        ahead = np.einsum('pij,pj->pi', turns[1:], tangents).reshape(beam.point.shape)
        points, _, feet = beam.from_base(ahead)
        total += (model.mass * beam.weight * (base[2] + points[..., 2])).sum()
        child_slope = np.tensordot(own, [one.child_slope for one in model.fields], axes=1)
        for child, at, foot, slanted in zip(
            model.children, beam.child_place, feet, child_slope, strict=True
        ):
            before = int((beam.place.ravel() < at).sum())
            last = Rotation.from_rotvec(slanted - (slope[before - 1] if before else 0.0))
            bases[child] = turns[before] @ last.as_matrix(), base + foot
    return total


def weight_by_differences(reduced, step=4e-4):
    """Second differences of the height along each coordinate and each sum of two."""
    n = reduced.reduction.n_coordinates
    ways, rest = step * np.eye(n), height_of_weight(reduced, np.zeros(n))
    found = np.zeros((n, n))
    for i in range(n):
        for j in range(i, n):
            way = ways[i] + ways[j]
            bend = height_of_weight(reduced, way) + height_of_weight(reduced, -way) - 2.0 * rest
            found[i, j] = found[j, i] = 9.81 * bend / step**2
    alone = np.diag(found) / 4.0
    out = 0.5 * (found - alone[:, None] - alone)
    np.fill_diagonal(out, alone)
    return out


def relative(one, other):
    """Largest difference of two matrices, each entry over its row's and column's diagonal."""
    scale = np.sqrt(np.abs(np.diag(other)))
    return np.abs((one - other) / np.outer(scale, scale)).max()


def straight(cuts):
    """Draw a stem with three limbs; of straight branches, whose seats are nodes of all cuts."""
    drawn = Sketch()
    drawn.add(None, 0, UP, 6.0, 0.12, 0.048, cuts)
    for k, seat in enumerate((cuts // 2, 2 * cuts // 3, 5 * cuts // 6)):
        drawn.add(0, seat, towards(137.5 * k, 40.0), 3.0, 0.072, 0.029, cuts)
    return drawn.tree()


@pytest.mark.parametrize('shape', ['fork', 'straight'])
def test_mass_is_kinetic_energy_in_the_limit_of_fine_segments(fork, differences, shape):
    error = []
    cuts = (8, 16) if shape == 'fork' else (18, 36, 72)
    for fine in cuts:
        tree = fork(fine)
        if shape == 'straight':
            tree = straight(fine)
        reduced = Reduced(tree, enriched=range(tree.n_branches))
        matrix = reduced.reduction.mass.toarray()
        error.append(relative(matrix, mass_by_differences(reduced, differences)))
    assert error[1] < 0.02
    # Straight segments approximate a curve: second order.
    order = np.log2(error[0] / error[-1]) / (len(cuts) - 1)
    assert order == pytest.approx(2.0, abs=0.1)


def test_plain_branches_are_drawn_nearly_as_they_move(fork, differences):
    # By one slope about both axes, and their twist by what it turns their children by.
    for tree in (fork(8), straight(12)):
        reduced = Reduced(tree)
        matrix = reduced.reduction.mass.toarray()
        assert relative(matrix, mass_by_differences(reduced, differences)) < 0.025


def test_weight_is_the_second_variation_of_height(fork):
    error = []
    for fine in (4, 8):
        reduced = Reduced(fork(fine), enriched=range(2))
        matrix = reduced.reduction.gravity.toarray()
        found = weight_by_differences(reduced)
        scale = np.abs(np.diag(matrix)).max()
        error.append(np.abs(matrix - found).max() / scale)
    assert error[1] < 2e-3
    assert np.log2(error[0] / error[1]) == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize('enriched', [(), (0,), (0, 1, 2, 3)])
def test_mass_is_symmetric_and_positive(fork, enriched):
    reduction = Reduced(fork(), enriched=enriched).reduction
    mass = reduction.mass.toarray()
    assert np.array_equal(mass, mass.T) or np.abs(mass - mass.T).max() < 1e-15 * np.abs(mass).max()
    scale = 1.0 / np.sqrt(np.diag(mass))
    assert np.linalg.eigvalsh(mass * np.outer(scale, scale))[0] > 1e-6
    gravity = reduction.gravity.toarray()
    assert np.abs(gravity - gravity.T).max() <= 1e-15 * np.abs(gravity).max()
    assert (reduction.elastic.diagonal() > 0).all()


def test_total_mass_rides_on_the_tree(fork):
    # A stiff turn of the stem alone would move all; the mass matrix must see all of it too.
    reduced = Reduced(fork())
    tree = reduced.tree
    total = DENSITY * tree.volume.sum()
    assert reduced.weights.sum() == pytest.approx(total, rel=1e-12)
    assert sum(m.beam.integral(m.mass) for m in reduced.models) == pytest.approx(total, rel=1e-12)


def test_without_gravity_there_is_no_weight(fork):
    reduction = Reduced(fork(), gravity=0.0).reduction
    assert abs(reduction.gravity).max() == 0.0
    assert reduction.stiffness.toarray() == pytest.approx(reduction.elastic.toarray())


def test_alone_branches_do_not_feel_each_other(fork):
    reduction = Reduced(fork(), subtrees=False).reduction
    mass = reduction.mass.toarray()
    for b in range(4):
        mass[2 * b : 2 * b + 2, 2 * b : 2 * b + 2] = 0.0
    assert not mass.any()


def test_only_ancestors_couple(fork):
    mass = Reduced(fork()).reduction.mass.toarray()
    # Branch 3 sits on the stem, as branch 1 with its twig 2 does.
    assert not mass[6:, 2:6].any()
    assert np.abs(mass[2:4, 4:6]).max() > 0.0


def test_leaves_add_their_mass(fork):
    leaves = np.array([0.0, 0.3, 0.1, 0.2])
    with_leaves = Reduced(fork(), leaf_mass=leaves)
    total = sum(m.beam.integral(m.mass) for m in with_leaves.models)
    assert total == pytest.approx(Reduced(fork()).weights.sum() + 0.6)
    heavier = with_leaves.reduction.mass.diagonal() - Reduced(fork()).reduction.mass.diagonal()
    assert (heavier > 0.0).all()


def test_an_upright_tree_is_softened_and_a_hanging_one_stiffened(stem):
    upright = Reduced(stem(direction=(0, 0, 1))).reduction.gravity.diagonal()
    hanging = Reduced(stem(direction=(0, 0, -1))).reduction.gravity.diagonal()
    assert (upright < 0.0).all()
    assert hanging == pytest.approx(-upright)
    level = Reduced(stem(direction=(1, 0, 0))).reduction.gravity.toarray()
    assert np.abs(level).max() < 1e-12 * hanging[0]


def test_the_twist_of_a_child_is_the_motion_of_its_base(fork, differences):
    reduced = Reduced(fork(8), enriched=(0, 1))
    moved = differences(reduced.poses, np.zeros(reduced.reduction.n_coordinates))
    first = reduced.tree.branch_first
    for child, parent in ((1, 0), (2, 1), (3, 0)):
        own = slice(*reduced.reduction.first[parent : parent + 2])
        twist = reduced.reduction.twist[child, : own.stop - own.start]
        base = reduced.tree.start[first[child]]
        motion = twist[:, :3] + np.cross(twist[:, 3:], base)
        assert moved[first[child], :3, own].T == pytest.approx(motion, abs=2e-3)
