# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Strain along branches and the share of strength used, beside what a beam's statics say."""

from __future__ import annotations

from dataclasses import replace
import math

import numpy as np
import pytest

from tree_sway.core.scene.placed_tree import PlacedTree
from tree_sway.core.settings import Settings
from tree_sway.core.species.species import ROOT_MOMENT, species_named
from tree_sway.growth import grow
from tree_sway.simulation.exposure import Exposure
from tree_sway.simulation.rig import Rig
from tree_sway.simulation.wood_strain import WoodStrain

STEADY = np.tile([3.0, 0.0, 0.0], (1200, 1))
STILL = Settings(gravity=0.0, damping_ratio=0.5, in_leaf=False)


@pytest.mark.parametrize('model', [20, 'full'])
def test_a_pole_strains_as_a_beam_under_an_even_load(stem, model):
    """M(s) = q (L - s)^2 / 2, and the fibre's strain is M r / (E I)."""
    tree = stem(base=0.02, tip=0.02, cuts=12)
    rig = Rig(tree, STILL, model=model)
    record = rig.run(STEADY)
    strain, simulator = WoodStrain(rig.reductions), rig.simulator
    simulator.reset()
    assert (strain.of(simulator.rotations()) == 0.0).all()
    for wind in STEADY:
        simulator.step(wind, 1 / 60)
    found, along = strain.of(simulator.rotations()), strain.height / tree.height
    half = np.repeat([1e-6, 1.0 / 24.0], 12)  # places at base ends, then means over segments
    beyond = ((1.0 - along + half) ** 3 - (1.0 - along - half) ** 3) / (6.0 * half)
    assert np.abs(found - found[0] * beyond / beyond[0]).max() < 0.02 * found[0]
    assert found[0] == pytest.approx(-record.base_strain[-1, 0], rel=0.01)
    assert record.strain[-1, 0] == pytest.approx(found[0])


@pytest.mark.parametrize('cuts', [1, 2, 12])
def test_the_strain_at_the_base_is_that_of_its_moment_however_coarse_the_tree(stem, cuts):
    rig = Rig(stem(base=0.02, tip=0.01, cuts=cuts), STILL, model=20)
    record = rig.run(STEADY[:60])
    assert record.strain[-1, 0] == pytest.approx(-record.base_strain[-1, 0], rel=0.01)


def test_roots_that_give_way_do_not_strain_the_wood(stem):
    tree = stem(base=0.03, tip=0.015, cuts=8)
    oak = species_named('oak')
    on_spring = replace(oak, root_stiffness=500.0)
    rigid, rooted = (
        Rig(PlacedTree('a', tree, species=wood), STILL).run(STEADY).strength
        for wood in (oak, on_spring)
    )
    assert rooted.wood[0] == pytest.approx(rigid.wood[0], rel=0.02)


def test_strength_used_is_stress_over_that_of_rupture(stem):
    tree, oak = stem(base=0.03, tip=0.015, cuts=8), species_named('oak')
    rig = Rig(PlacedTree('a', tree, species=oak), STILL)
    record = rig.run(STEADY)
    used = record.strength
    assert used.wood[0] == pytest.approx(oak.modulus * record.strain.max() / oak.rupture)
    low, high = used.moment_band
    assert low < used.base_moment < high
    assert used.wood[2] / used.wood[1] > high / low  # that of wood is in it as well
    moment = np.linalg.norm(record.base_moment, axis=1).max()
    assert used.roots[0] == pytest.approx(moment / (oak.rupture * math.pi / 32.0 * 0.03**3))
    assert used.stem == pytest.approx(used.wood[0])  # it is bent most at its base
    in_a_stand = Exposure('stand', height=tree.height).profile()
    record = Rig(PlacedTree('a', tree, species=oak), STILL, profile=in_a_stand).run(STEADY)
    moment = np.linalg.norm(record.base_moment, axis=1).max()
    capacity = ROOT_MOMENT * oak.density * tree.volume.sum()
    assert record.strength.roots[0] == pytest.approx(moment / capacity)
    assert used.branch in str(used)
    assert 'roots' in str(used)


def test_a_pot_has_no_root_strength(stem):
    pot = species_named('benjamina')
    used = Rig(PlacedTree('a', stem(), species=pot), STILL).run(STEADY[:10]).strength
    assert np.isnan(used.roots).all()
    assert 'unknown in a pot' in str(used)


def test_more_wind_uses_more_strength(stem):
    rig = Rig(PlacedTree('a', stem(), species=species_named('oak')), STILL, model=6)
    curve = rig.strength_curve([2.0, 4.0, 8.0], rng=np.random.default_rng(1), seconds=5.0)
    shares = [each.wood[0] for each in curve]
    assert shares[0] < 0.4 * shares[1] < 0.16 * shares[2]


def test_the_stem_alone_is_read_as_with_its_limbs():
    """And no limb, however much it is strained, counts for the fall of the tree."""
    tree = grow('lime', 6.0, rng=np.random.default_rng(1))
    rig = Rig(PlacedTree('a', tree, species=species_named('lime')), STILL, model=20)
    whole, stem = (rig.run(8.0 * STEADY[:60], strained=n).strength for n in (None, 1))
    assert stem.stem == pytest.approx(whole.stem, rel=1e-9)
    assert stem.roots[0] == pytest.approx(whole.roots[0], rel=1e-9)
    assert stem.branch == 'stem'
    assert whole.stem <= stem.wood[0] <= whole.wood[0]
