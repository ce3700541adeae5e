# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""From a tree to its oscillators: what each model takes into account."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway_ros.core.kernel import like
from tree_sway_ros.core.motion.records import BRANCH, branch_layout, SEGMENT, segment_layout, WORK
from tree_sway_ros.core.simulator.assembly import build_bank
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.core.tree.species import species_named

OAK = species_named('oak')


def bank_of(tree, **changes):
    return build_bank(tree, OAK, Settings(**changes))


def test_a_lone_stem_is_the_same_on_every_model(stem):
    first = [
        bank_of(stem(tip=0.01), model=model, n_modes=1, gravity=0.0).frequencies[0]
        for model in ('branch', 'subtree', 'modes', 'coupled')
    ]
    assert first == pytest.approx([first[0]] * 4, rel=0.02)


def test_what_is_carried_slows_a_branch(fork):
    alone = bank_of(fork(), model='branch').frequencies
    carrying = bank_of(fork(), model='subtree').frequencies
    assert carrying[0] < 0.9 * alone[0]
    coupled = bank_of(fork(), model='coupled', enrich='none').frequencies
    assert coupled[0] == pytest.approx(carrying[0], rel=0.1)


@pytest.mark.parametrize('share', [0.15, 0.6])
def test_leaves_slow_the_branches_they_sit_on(stem, share):
    """Leaf mass of 15-60 % of a branch's own lowers its f0 to 0.70-0.95 of the bare one."""
    tree = stem(length=1.5, base=0.02, tip=0.01, direction=(1, 0, 1))
    bare = bank_of(tree, model='subtree')
    leafy = bank_of(tree, model='subtree', leaf_mass=np.array([share * bare.mass]))
    assert leafy.mass == pytest.approx((1.0 + share) * bare.mass)
    assert 0.7 < leafy.frequencies[0] / bare.frequencies[0] < 0.95


def test_stiffness_goes_with_modulus_and_mass_with_density(fork):
    species = [
        OAK,
        *(OAK.__class__('x', 'x', m * OAK.modulus, d * OAK.density) for m, d in ((4, 1), (1, 4))),
    ]
    settings = Settings(model='subtree', gravity=0.0)
    wood, stiff, heavy = (build_bank(fork(), s, settings).frequencies for s in species)
    assert stiff == pytest.approx(2.0 * wood, rel=1e-9)
    assert heavy == pytest.approx(0.5 * wood, rel=1e-9)


def test_damping_is_asked_for_or_the_species_in_its_season(stem):
    def ratio(**changes):
        o = bank_of(stem(), model='branch', gravity=0.0, **changes).oscillators
        return (o.damping / (2.0 * np.sqrt(o.stiffness * o.inertia)))[0]

    assert ratio() == pytest.approx(OAK.damping_bare)
    assert ratio(in_leaf=True) == pytest.approx(OAK.damping_in_leaf)
    assert ratio(damping_ratio=0.2, in_leaf=True) == pytest.approx(0.2)
    assert ratio(damping_ratio=0.0) == 0.0


def test_the_volume_rule_sets_stiffness_and_damping_from_volumes(fork):
    tree = fork()
    chosen = {
        'model': 'branch',
        'stiffness': 'volume_rule',
        'volume_stiffness': 3e5,
        'volume_damping': 2e3,
    }
    o = bank_of(tree, **chosen).oscillators
    volume = np.add.reduceat(tree.volume, tree.branch_first[:-1])
    rule = np.sqrt(volume * volume[[0, 0, 1, 0]])
    assert o.stiffness == pytest.approx(3e5 * rule)
    assert o.damping == pytest.approx(2e3 * rule)
    twice = bank_of(tree, **(chosen | {'volume_stiffness': 1.2e6}))
    assert twice.frequencies == pytest.approx(2.0 * bank_of(tree, **chosen).frequencies)


def test_frequencies_rise_and_masses_agree(fork):
    for model in ('branch', 'subtree', 'coupled'):
        bank = bank_of(fork(), model=model)
        assert (np.diff(bank.frequencies) >= 0).all()
        assert bank.mass == pytest.approx(OAK.density * fork().volume.sum())


def test_modes_are_the_coupled_ones(fork):
    coupled = bank_of(fork(), model='coupled', enrich='none').frequencies
    few = bank_of(fork(), model='modes', n_modes=8, enrich='none').frequencies
    assert few == pytest.approx(coupled, rel=1e-9)


def test_enriching_makes_no_mode_faster(fork):
    plain = bank_of(fork(), model='coupled', enrich='none').frequencies
    for enrich in ('stem', 'needed', 'carriers', 'all'):
        rich = bank_of(fork(), model='coupled', enrich=enrich).frequencies
        assert len(rich) > len(plain)
        assert (rich[: len(plain)] <= plain * (1 + 1e-9)).all()


def test_more_modes_come_closer_to_all_of_them(fork):
    def tip(model, n=1):
        sim = SwaySimulator(fork(), model=model, n_modes=n)
        path = []
        for k in range(120):
            sim.step([6.0 + 3.0 * np.sin(k / 4.0), 2.0, 0.0], 1 / 60)
            sim.place()
            path.append(sim.tip_displacement.copy())
        return np.array(path)

    truth = tip('coupled')
    error = [np.abs(tip('modes', n) - truth).max() / np.abs(truth).max() for n in (2, 6, 14)]
    assert error[2] < 0.02
    assert error[2] < error[0]
    assert error[1] < 0.05


def test_a_steady_wind_bends_the_coupled_tree_as_its_stiffness_says(fork):
    sim = SwaySimulator(fork(), model='coupled', gravity=0.0, damping_ratio=0.5)
    for _ in range(1500):
        sim.step([1.0, 0.4, 0.0], 1 / 30)
    bank = sim.bank.oscillators
    x, moment = bank.rotations(), bank.state[0]
    shapes, w2 = bank.shapes, bank.stiffness
    assert x == pytest.approx(shapes @ ((shapes.T @ moment) / w2), rel=1e-6, abs=1e-12)


def test_records_have_room_for_all_that_a_step_needs(fork):
    bank = bank_of(fork(), model='coupled', enrich='all')
    assert bank.branches.dtype == BRANCH
    assert bank.segments.dtype == SEGMENT
    assert bank.oscillators.work.dtype == WORK
    assert (bank.branches['n_coordinates'] <= bank.branches['push'].shape[1]).all()
    first = bank.branches['coordinate']
    assert np.array_equal(first[1:], np.cumsum(bank.branches['n_coordinates'])[:-1])


def test_constants_are_plain_numbers_outside_compiled_code():
    assert like(0.5, np.float32(1.0)) == 0.5


def test_records_of_plain_branches_have_room_for_no_more(fork):
    for model in ('branch', 'subtree'):
        bank = bank_of(fork(), model=model)
        assert bank.branches.dtype == branch_layout(2)
        assert bank.segments.dtype == segment_layout(2)
        assert bank.branches.dtype.itemsize < 0.5 * BRANCH.itemsize
