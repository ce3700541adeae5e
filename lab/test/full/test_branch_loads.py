# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""How branches move on each other and transmit loads: virtual work, balance, rigid motion."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.full import branch_loads
from tree_sway_lab.full.load_records import load_records
from tree_sway_lab.full.rotation import turned
from tree_sway_lab.kernel import fused

from tree_sway.core.rotation import cross_matrix
from tree_sway.core.run.assembly import bank_of
from tree_sway.core.settings import Settings
from tree_sway.core.setup.preparation import prepare
from tree_sway.core.setup.wind_moments import WindMoments
from tree_sway.core.species.species import species_named

# Parts of kernels, each compiled for itself.
bent_loads, outward_pass, set_air, wind_forces = (
    fused(getattr(branch_loads, name))
    for name in ('bent_loads', 'outward_pass', 'set_air', 'wind_forces')
)


DRAG = 0.5 * 1.225 * 1.2


class Loaded:
    """A tree with its records, forces and rates at hand."""

    def __init__(self, tree, enrich='none'):
        chosen = Settings(model='full', enrich=enrich, gravity=0.0)
        bank = bank_of(prepare(tree, species_named('broadleaf'), chosen))
        bank.oscillators.set_step(1 / 60)
        self.tree, self.branches, self.work = tree, bank.branches, bank.oscillators.work
        self.loads = load_records(self.branches)
        self.n = len(bank.oscillators.rotations())

    def blow(self, wind):
        """Find the forces of a wind on branches at rest, whose bases may move."""
        set_air(self.work, self.loads, *wind)
        wind_forces(self.loads, DRAG)
        bent_loads(self.branches, self.work, self.loads, np.zeros(self.n))

    def velocity_of_centres(self, x, v):
        """Velocity of the centre of each load in the frame of its branch as it is turned."""
        outward_pass(self.branches, self.work, x, v)
        out = []
        for branch, work in zip(self.branches, self.work, strict=True):
            k = branch['n_coordinates']
            own = slice(branch['coordinate'], branch['coordinate'] + k)
            lean = -x[own] @ branch['load_rotation'][:k]
            place, spin = (_turned(lean, work['velocity'][i : i + 3]) for i in (0, 3))
            couple = branch['coupling'] - cross_matrix(branch['base'])
            out.append(place + couple.T @ spin + v[own] @ branch['load_mode'][:k])
        return np.array(out)


@pytest.fixture(scope='module', params=['none', 'all'])
def loaded(fork, request):
    return Loaded(fork(), request.param)


def test_a_child_takes_over_the_turn_of_its_parent(loaded):
    v = np.zeros(loaded.n)
    v[:2] = 0.3, -0.2
    outward_pass(loaded.branches, loaded.work, v, v)
    for child in (1, 3):
        twist = loaded.branches['twist'][child, :2, 3:]
        assert loaded.work['rotation'][child] == pytest.approx(v[:2] @ twist)
        assert loaded.work['velocity'][child, 3:] == pytest.approx(v[:2] @ twist)
    # The twig on a stiff limb goes along as one body.
    limb, twig = loaded.work[1], loaded.work[2]
    away = loaded.branches['base'][2] - loaded.branches['base'][1]
    carried = limb['velocity'][:3] + np.cross(limb['velocity'][3:], away)
    assert twig['velocity'][:3] == pytest.approx(carried)
    assert twig['orientation'] == pytest.approx(limb['orientation'])
    assert not loaded.work['rotation'][0].any()


def test_still_branches_feel_the_wind_of_the_books(loaded):
    outward_pass(loaded.branches, loaded.work, np.zeros(loaded.n), np.zeros(loaded.n))
    loaded.blow((6.0, 2.0, 1.0))
    wind = np.array([6.0, 2.0, 1.0])
    tree = loaded.tree
    for b in (3,):
        own = tree.segments_of(b)
        along = (tree.end[own] - tree.start[own])[0] / tree.length[own][0]
        across = wind - (wind @ along) * along
        area = (0.5 * (tree.base_diameter + tree.tip_diameter) * tree.length)[own].sum()
        expected = DRAG * area * np.linalg.norm(across) * across
        assert loaded.work['force'][b] == pytest.approx(expected)


def test_a_branch_that_goes_with_the_wind_feels_none(stem):
    tree = Loaded(stem())
    tree.work['velocity'][0] = [6.0, 2.0, 0.0, 0.0, 0.0, 0.0]
    tree.blow((6.0, 2.0, 0.0))
    assert tree.work['force'][0] == pytest.approx(np.zeros(3), abs=1e-12)


def test_a_turned_branch_faces_the_wind_as_it_is_turned(stem):
    """Laid flat into the wind by its base, an upright stem has no load."""
    tree = Loaded(stem())
    tree.work['orientation'][0] = [np.cos(np.pi / 4), 0.0, np.sin(np.pi / 4), 0.0]
    tree.blow((6.0, 0.0, 0.0))
    assert tree.work['force'][0] == pytest.approx(np.zeros(3), abs=1e-12)


class _Bent:
    """A tree bent by its key rotations, its loads on rods that turn with what they hang on."""

    def __init__(self, tree, x, force):
        """Give every branch a force (b, 3) in its own frame as it is turned."""
        loaded = Loaded(tree)
        outward_pass(loaded.branches, loaded.work, x, 0.0 * x)
        self.branches, self.work, self.loads = loaded.branches, loaded.work, loaded.loads
        n = len(force)
        turn = np.einsum('bc,bck->bk', x.reshape(-1, 2), loaded.branches['load_rotation'][:, :2])
        into = self.loads[0]
        into['rotation'][:, :n], into['own_force'][:, :n] = turn.T, force.T
        into['force'][:, :n] = np.array(
            [_turned(t, f) for t, f in zip(turn, force, strict=True)]
        ).T
        self.moment = np.zeros(len(x))
        bent_loads(self.branches, self.work, self.loads, self.moment)


def _turned(rotation, vector):
    return np.array(turned(*rotation, *vector))


def test_the_native_core_finds_the_same_loads(loaded):
    """Two programs of one law."""
    rng = np.random.default_rng(5)
    x, v = 0.3 * rng.normal(size=(2, loaded.n))
    wind = rng.normal(size=3)
    own = np.zeros(loaded.n)
    loaded.loads['drag_impulse'] = loaded.loads['compliance'] = 0.0
    branch_loads.wind_moments(loaded.branches, loaded.work, loaded.loads, x, v, own, *wind, 1.0)
    native = WindMoments(loaded.branches)
    found = native(x, v, wind)
    assert found == pytest.approx(own, rel=1e-9, abs=1e-12 * np.abs(own).max())
    for name in ('velocity', 'orientation', 'rotation', 'displacement', 'arm', 'force', 'wrench'):
        assert native.loads[name][1:] == pytest.approx(
            loaded.work[name][1:], rel=1e-9, abs=1e-12
        ), name


@pytest.mark.parametrize('bend', [0.0, 0.5, 2.0])
def test_moments_do_the_work_of_the_forces_however_far_a_tree_is_bent(fork, bend):
    """So drag takes energy from a tree that swings in still air, in any pose."""
    rng, tree = np.random.default_rng(3), Loaded(fork())
    force, v, x = rng.normal(size=(4, 3)), rng.normal(size=tree.n), rng.normal(size=tree.n)
    power = (force * tree.velocity_of_centres(bend * x, v)).sum()
    assert _Bent(fork(), bend * x, force).moment @ v == pytest.approx(power, rel=1e-10)


def test_a_stem_has_the_moment_of_a_limb_at_its_present_place(sketch):
    """Its base has gone to one side, and its own load further, as it is turned."""
    drawn = sketch()
    drawn.add(None, 0, (0, 0, 1), 1.0, 0.02, 0.02, 8)
    drawn.add(0, 8, (0, 0, 1), 0.5, 0.01, 0.01, 2)
    x = np.array([0.2, 0.0, 0.0, 0.0])
    tree, down = drawn.tree(), np.array([0.0, 0.0, -1.0])
    turned_by = x[0] * Loaded(tree).branches['twist'][1, 0, 3:]
    bent = _Bent(tree, x, np.array([np.zeros(3), _turned(-turned_by, down)]))
    wrench = bent.work['wrench'][0]
    assert wrench[:3] == pytest.approx(down, abs=1e-12)
    aside = 0.2 + 0.25 * np.sin(np.linalg.norm(turned_by))
    assert np.linalg.norm(wrench[3:]) == pytest.approx(aside, rel=1e-3)
