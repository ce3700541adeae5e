# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""From a tree to its oscillators: what each model takes into account."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from simulators import AUTO, FULL

from tree_sway.core.model.records import branch_layout, room_for_fields, ROOMS
from tree_sway.core.run import assembly
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.settings import Settings
from tree_sway.core.setup.preparation import prepare
from tree_sway.core.setup.reductions import TreeReductions
from tree_sway.core.species.species import species_named
from tree_sway.errors import TreeError

OAK = species_named('oak')


def bank_of(tree, **changes):
    chosen = Settings(**changes)
    return assembly.bank_of(prepare(tree, OAK, chosen))


def frequencies(tree, species=OAK, count=100, **changes):
    return make_simulator(tree, species, **changes).frequencies(count)


def test_a_lone_stem_is_the_same_on_every_model(stem):
    first = [frequencies(stem(tip=0.01), model=model, gravity=0.0)[0] for model in ('branch', 12)]
    assert first == pytest.approx([first[0]] * 2, rel=0.02)


@pytest.mark.parametrize('share', [0.15, 0.6])
def test_leaves_slow_the_branches_they_sit_on(stem, share):
    """Leaf mass of 15-60 % of a branch's own lowers its f0 to 0.70-0.95 of the bare one."""
    tree = stem(length=1.5, base=0.02, tip=0.01, direction=(1, 0, 1))
    bare = bank_of(tree, model='branch')
    leafy = bank_of(tree, model='branch', leaf_mass=np.array([share * bare.model.mass]))
    assert leafy.model.mass == pytest.approx((1.0 + share) * bare.model.mass)
    slower = [
        frequencies(tree, model='branch', leaf_mass=np.array([s * bare.model.mass]))[0]
        for s in (share, 0.0)
    ]
    assert 0.7 < slower[0] / slower[1] < 0.95


def test_stiffness_goes_with_modulus_and_mass_with_density(fork):
    species = [
        OAK,
        *(OAK.__class__('x', 'x', m * OAK.modulus, d * OAK.density) for m, d in ((4, 1), (1, 4))),
    ]
    wood, stiff, heavy = (frequencies(fork(), s, model='branch', gravity=0.0) for s in species)
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
        'volume_stiffness': 3e5,
        'volume_damping': 2e3,
    }
    o = bank_of(tree, **chosen).oscillators
    volume = np.add.reduceat(tree.volume, tree.branch_first[:-1])
    rule = np.sqrt(volume * volume[[0, 0, 1, 0]])
    assert o.stiffness == pytest.approx(3e5 * rule)
    assert o.damping == pytest.approx(2e3 * rule)
    twice = frequencies(tree, **(chosen | {'volume_stiffness': 1.2e6}))
    assert twice == pytest.approx(2.0 * frequencies(tree, **chosen))


def test_frequencies_rise_and_masses_agree(fork):
    for model in ('branch', 60):
        bank = bank_of(fork(), model=model)
        assert (np.diff(frequencies(fork(), model=model)) >= 0).all()
        assert bank.model.mass == pytest.approx(OAK.density * fork().volume.sum())


def test_modes_are_the_coupled_ones(fork):
    coupled, few = (frequencies(fork(), model=m, enrich='none') for m in (60, 5))
    assert few == pytest.approx(coupled, rel=1e-9)


@pytest.mark.parametrize('model', [3, 6, 60, *FULL])
def test_its_frequencies_are_the_natural_ones_whatever_the_number_of_coordinates(fork, model):
    """Shapes that correct the static answer are none of them, and none is left out."""
    natural = TreeReductions(fork(), OAK, Settings()).natural_frequencies(6)
    assert len(natural) == 6
    assert frequencies(fork(), count=6, model=model) == pytest.approx(natural, rel=1e-6)


def test_enriching_makes_no_mode_faster(fork):
    plain = frequencies(fork(), model=60, enrich='none')
    for enrich in ('stem', 'needed', 'carriers', 'all'):
        rich = frequencies(fork(), model=60, enrich=enrich)
        assert len(rich) > len(plain)
        assert (rich[: len(plain)] <= plain * (1 + 1e-9)).all()


@pytest.mark.parametrize(('tree', 'rows'), [('fork', ROOMS[1]), ('stem', ROOMS[2])])
def test_records_have_room_for_all_that_a_step_needs(fork, stem, tree, rows):
    bank = bank_of(fork() if tree == 'fork' else stem(base=0.04, cuts=8), model=60, enrich='all')
    room = room_for_fields(bank.branches['n_coordinates'].max())
    assert room == rows
    assert bank.branches.dtype == branch_layout(room)
    assert (bank.branches['n_coordinates'] <= bank.branches['load_mode'].shape[1]).all()
    first = bank.branches['coordinate']
    assert np.array_equal(first[1:], np.cumsum(bank.branches['n_coordinates'])[:-1])


def test_records_of_plain_branches_have_room_for_no_more(fork):
    for model in ('branch',):
        bank = bank_of(fork(), model=model)
        assert bank.branches.dtype == branch_layout(2)
        assert bank.branches.dtype.itemsize < 0.5 * branch_layout(ROOMS[1]).itemsize


@pytest.mark.parametrize('model', [60, *AUTO, *FULL])
@pytest.mark.parametrize('seed', range(4))
def test_a_scan_with_absurd_diameters_is_refused_or_stays_finite(fork, model, seed):
    rng, tree = np.random.default_rng(seed), fork()
    factor = np.ones(tree.n_segments)
    factor[rng.integers(0, tree.n_segments, 2)] = 10.0 ** rng.uniform(-7.0, 5.0, 2)
    mutated = replace(
        tree, base_diameter=factor * tree.base_diameter, tip_diameter=factor * tree.tip_diameter
    )
    try:
        sim = make_simulator(mutated, OAK, model=model, gravity=0.0)
    except TreeError:
        return
    for _ in range(30):
        sim.step((8.0, 1.0, 0.0), 1 / 60)
    assert np.isfinite(sim.place()).all()
