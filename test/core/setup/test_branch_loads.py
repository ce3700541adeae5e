# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""How branches move on each other and transmit loads: virtual work, balance, rigid motion."""

from __future__ import annotations

from drawn_trees import crooked
import numpy as np
import pytest

from tree_sway.core.rotation import cross_matrix, quaternion_rotated
from tree_sway.core.settings import Settings
from tree_sway.core.setup.preparation import prepare
from tree_sway.core.setup.reductions import TreeReductions
from tree_sway.core.setup.wind_moments import WindMoments
from tree_sway.core.species.species import species_named

CALM = np.zeros(3)


def turned_by(rotations, vectors):
    """
    Turn vectors v (n, 3) by rotation vectors [rad], (n, 3), as the law of the loads does.

    With h the axis times the tangent of half the angle (Rodrigues), by its series, it is
    ``[(1 - h.h) v + 2 (h.v) h + 2 h x v] / (1 + h.h)``.
    """
    t = np.square(rotations).sum(axis=1, keepdims=True)
    h = (0.5 + t * (1.0 / 24.0 + t * (1.0 / 240.0 + t * (17.0 / 40320.0)))) * rotations
    h_square = np.square(h).sum(axis=1, keepdims=True)
    along = (h * vectors).sum(axis=1, keepdims=True)
    turned = (1.0 - h_square) * vectors + 2.0 * along * h + 2.0 * np.cross(h, vectors)
    return turned / (1.0 + h_square)


class Loaded:
    """A tree in a pose, that moves, in a wind of 1 kg/m^3."""

    def __init__(self, tree, enrich='none'):
        chosen = Settings(model=60, enrich=enrich, gravity=0.0)
        self.tree = tree
        self.branches = prepare(tree, species_named('broadleaf'), chosen).branches
        self.hold()

    def hold(self):
        """Read the records, which may have changed."""
        self.of_branches = WindMoments(self.branches)
        self.n = self.of_branches.n
        self.loads = self.of_branches.loads

    def moments(self, x, v, wind):
        """Find the moments on the key rotations."""
        rates = None if v is None else v[None]
        return self.of_branches.at_poses(x[None], np.asarray(wind)[None], rates)[0]

    def velocity_of_centres(self, x, v):
        """Velocity of the centre of each load in the frame of its branch as it is turned."""
        self.moments(x, v, CALM)
        out = []
        for branch, load in zip(self.branches, self.loads, strict=True):
            k = branch['n_coordinates']
            own = slice(branch['coordinate'], branch['coordinate'] + k)
            lean = np.tile(-x[own] @ branch['load_rotation'][:k], (2, 1))
            place, spin = turned_by(lean, load['velocity'].reshape(2, 3))
            couple = branch['coupling'] - cross_matrix(branch['base'])
            out.append(place + couple.T @ spin + v[own] @ branch['load_mode'][:k])
        return np.array(out)


@pytest.fixture(scope='module', params=['none', 'all'])
def loaded(fork, request):
    return Loaded(fork(), request.param)


def test_a_child_takes_over_the_turn_of_its_parent(loaded):
    v = np.zeros(loaded.n)
    v[:2] = 0.3, -0.2
    loaded.moments(v, v, CALM)
    for child in (1, 3):
        twist = loaded.branches['twist'][child, :2, 3:]
        assert loaded.loads['rotation'][child] == pytest.approx(v[:2] @ twist)
        assert loaded.loads['velocity'][child, 3:] == pytest.approx(v[:2] @ twist)
    # The twig on a stiff limb goes along as one body.
    limb, twig = loaded.loads[1], loaded.loads[2]
    away = loaded.branches['base'][2] - loaded.branches['base'][1]
    carried = limb['velocity'][:3] + np.cross(limb['velocity'][3:], away)
    assert twig['velocity'][:3] == pytest.approx(carried)
    assert twig['orientation'] == pytest.approx(limb['orientation'])
    assert not loaded.loads['rotation'][0].any()


def test_still_branches_feel_the_wind_of_the_books(loaded):
    wind = np.array([6.0, 2.0, 1.0])
    loaded.moments(np.zeros(loaded.n), None, wind)
    tree = loaded.tree
    own = tree.segments_of(3)
    along = (tree.end[own] - tree.start[own])[0] / tree.length[own][0]
    across = wind - (wind @ along) * along
    area = (0.5 * (tree.base_diameter + tree.tip_diameter) * tree.length)[own].sum()
    expected = area * np.linalg.norm(across) * across
    assert loaded.loads['force'][3] == pytest.approx(expected)


def test_a_turned_branch_faces_the_wind_as_it_is_turned(sketch):
    """A limb that its stem lays flat into the wind has no load."""
    drawn = sketch()
    drawn.add(None, 0, (0, 0, 1), 1.0, 0.02, 0.02, 8)
    drawn.add(0, 8, (0, 0, 1), 0.5, 0.01, 0.01, 2)
    tree = Loaded(drawn.tree())
    turn = tree.branches['twist'][1, :2, 3:]
    x = np.zeros(tree.n)
    x[:2] = np.linalg.lstsq(turn.T, np.array([0.0, np.pi / 2, 0.0]), rcond=None)[0]
    tree.moments(x, None, (6.0, 0.0, 0.0))
    assert tree.loads['own_force'][1] == pytest.approx(np.zeros(3), abs=1e-9)
    tree.moments(0.5 * x, None, (6.0, 0.0, 0.0))
    assert np.linalg.norm(tree.loads['own_force'][1]) > 0.05


def test_the_load_on_a_crooked_branch_is_that_on_its_pieces():
    tree = crooked(4)
    reduced = TreeReductions(tree, species_named('oak'), Settings(in_leaf=False)).with_subtrees
    for wind in np.array([[1.0, 0.0, 0.0], [0.6, -0.8, 0.0]]):
        true, fitted, centred = np.zeros((3, len(reduced.branches), 3))
        for b, (model, record) in enumerate(zip(reduced.models, reduced.branches, strict=True)):
            tangent = model.beam.tangent
            across = wind - (tangent @ wind)[:, None] * tangent
            piece = np.linalg.norm(across, axis=1)[:, None] * across
            force = (model.drag_area * model.beam.weight)[..., None] * piece[:, None]
            true[b] = np.cross(model.beam.point, force).sum(axis=(0, 1))
            projector = record['projector'][[0, 3, 4, 3, 1, 5, 4, 5, 2]].reshape(3, 3)
            drag = np.sqrt(wind @ projector @ wind) * (projector @ wind)
            drag *= record['area'] * record['speed'] ** 2
            fitted[b] = record['coupling'] @ drag
            centred[b] = np.cross(record['centre'], force.sum(axis=(0, 1)))
        error = np.linalg.norm(fitted - true) / np.linalg.norm(true)
        assert error < 0.01
        # Nearer than the true force would be, were it to act at one place in all winds.
        assert error < np.linalg.norm(centred - true) / np.linalg.norm(true)


@pytest.mark.parametrize('bend', [0.0, 0.5, 2.0])
def test_moments_do_the_work_of_the_forces_however_far_a_tree_is_bent(loaded, bend):
    """So drag takes energy from a tree that swings in still air, in any pose."""
    rng = np.random.default_rng(3)
    v, x = rng.normal(size=(2, loaded.n))
    moments = loaded.moments(bend * x, None, rng.normal(size=3))
    force = loaded.loads['own_force'].copy()
    power = (force * loaded.velocity_of_centres(bend * x, v)).sum()
    assert moments @ v == pytest.approx(power, rel=1e-10)


def test_drag_takes_energy_from_a_tree_that_moves_in_still_air(loaded):
    rng = np.random.default_rng(4)
    for x, v in rng.normal(size=(10, 2, loaded.n)):
        assert loaded.moments(0.5 * x, v, CALM) @ v < 0.0


def test_a_stem_has_the_moment_of_a_limb_at_its_present_place(loaded):
    """Its base has gone to one side, and its own load further, as it is turned."""
    alone = Loaded(loaded.tree)
    alone.branches['area'][[0, 2, 3]] = 0.0
    alone.hold()
    x = np.zeros(alone.n)
    x[0] = 0.2
    alone.moments(x, None, (1.0, 2.0, -5.0))
    stem, limb = alone.loads[:2]
    force = limb['force']
    branch = alone.branches[1]
    lever = np.array([branch['coupling'] - cross_matrix(branch['base'])])
    couple = turned_by(limb['turn'][None], np.einsum('bij,bj->bi', lever, limb['own_force'][None]))
    moment = np.cross(limb['arm'], force) + quaternion_rotated(limb['orientation'][None], couple)
    assert stem['wrench'][:3] == pytest.approx(force, rel=1e-3)
    assert stem['wrench'][3:] == pytest.approx(moment[0], rel=2e-3)
