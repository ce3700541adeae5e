# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A modulus fitted to a frequency gives that frequency, in the model that the simulator steps."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.core.settings import Settings
from tree_sway.core.setup.reductions import TreeReductions
from tree_sway.core.species.species import species_named
from tree_sway.errors import ParameterError, TreeError
from tree_sway.files.trees import open_tree
from tree_sway.identification.calibration import calibrate

OAK = species_named('oak')
COUPLED = Settings(model='full')
WEIGHTLESS = Settings(gravity=0.0)


def slowest(tree, species, settings=COUPLED):
    return float(TreeReductions(tree, species, settings).natural_frequencies(1)[0])


@pytest.mark.parametrize('share', [0.2, 0.9, 1.0, 1.5, 20.0])
def test_the_simulator_has_the_measured_frequency(fork, share):
    tree = fork()
    before = slowest(tree, OAK)
    fitted = calibrate(tree, OAK, share * before)
    assert fitted.frequency_before == pytest.approx(before, rel=1e-9)
    assert fitted.frequency == pytest.approx(share * before, rel=1e-8)
    assert slowest(tree, fitted.species) == pytest.approx(share * before, rel=1e-8)
    assert fitted.species.modulus == pytest.approx(fitted.modulus_ratio * OAK.modulus)


def test_without_weight_the_modulus_goes_with_the_square(fork):
    before = slowest(fork(), OAK, WEIGHTLESS)
    fitted = calibrate(fork(), OAK, 1.3 * before, settings=WEIGHTLESS)
    assert fitted.modulus_ratio == pytest.approx(1.69, rel=1e-8)
    assert fitted.sensitivity == pytest.approx(2.0, rel=1e-8)


def test_weight_makes_the_modulus_less_sensitive(fork):
    tree = fork()
    target = 0.5 * slowest(tree, OAK)
    fitted = calibrate(tree, OAK, target)
    up, down = (calibrate(tree, OAK, target * (1.0 + h)).species.modulus for h in (1e-4, -1e-4))
    assert fitted.sensitivity == pytest.approx(np.log(up / down) / 2e-4, rel=1e-4)
    assert fitted.sensitivity < 2.0


def test_damping_is_that_of_the_season(fork):
    bare = calibrate(fork(), OAK, 1.0, 0.07).species
    assert (bare.damping_bare, bare.damping_in_leaf) == (0.07, OAK.damping_in_leaf)
    leafy = calibrate(fork(), OAK, 1.0, 0.07, Settings(in_leaf=True)).species
    assert (leafy.damping_bare, leafy.damping_in_leaf) == (OAK.damping_bare, 0.07)
    assert calibrate(fork(), OAK, 1.0).species.damping_bare == OAK.damping_bare


def test_leaves_weigh_on_the_answer(fork):
    tree = fork()
    leaves = Settings(
        leaf_mass=np.full(tree.n_branches, 0.05), leaf_area=np.full(tree.n_branches, 0.01)
    )
    fitted = calibrate(tree, OAK, 1.0, settings=leaves)
    assert fitted.modulus_ratio > calibrate(tree, OAK, 1.0).modulus_ratio
    assert slowest(tree, fitted.species, leaves) == pytest.approx(1.0, rel=1e-8)


def test_a_guess_becomes_a_measurement(fork):
    guess = species_named('benjamina')
    assert guess.is_estimate
    assert not calibrate(fork(), guess, 1.0).species.is_estimate


def test_a_tree_that_could_not_stand_gets_a_modulus_that_holds_it(stem):
    tree = stem(length=30.0, base=0.02)
    with pytest.raises(TreeError, match='buckles'):
        slowest(tree, OAK)
    fitted = calibrate(tree, OAK, 0.3)
    assert fitted.frequency_before is None
    assert fitted.modulus_ratio > 1.0
    assert slowest(tree, fitted.species) == pytest.approx(0.3, rel=1e-8)


def test_too_slow_a_sway_would_buckle_the_tree(stem):
    with pytest.raises(
        TreeError, match=r"1e-05 Hz is out of reach: .* when branch '.*' nearly buckles"
    ):
        calibrate(stem(), OAK, 1e-5)


def test_the_branch_that_sways_is_named(sketch):
    drawn = sketch()
    trunk = drawn.add(None, 0, (0.0, 0.0, 1.0), 2.0, 0.2, 0.15, 4)
    drawn.add(trunk, 4, (1.0, 0.0, 0.2), 1.5, 0.006, 0.004, 3)
    tree = drawn.tree()
    limb, stem = calibrate(tree, OAK, 1.0, settings=WEIGHTLESS), tree.branch_names[0]
    assert limb.branch == tree.branch_names[1]
    slowest, of_the_stem = (
        calibrate(tree, OAK, 12.0, settings=WEIGHTLESS, branch=each) for each in (None, stem)
    )
    assert of_the_stem.branch == stem
    assert of_the_stem.species.modulus < 0.1 * slowest.species.modulus


def test_branches_that_are_cut_keep_their_names():
    """The goldcrest's are more pieces than branches."""
    tree = open_tree('goldcrest').tree
    slowest = calibrate(tree, None, 1.5)
    assert slowest.branch in tree.branch_names
    fitted = calibrate(tree, None, 1.5, branch='stem')
    assert fitted.branch == 'stem'
    assert fitted.frequency == pytest.approx(1.5)


@pytest.mark.parametrize('frequency', [0.0, -1.0, np.nan, np.inf, 2e3])
def test_a_frequency_out_of_range(fork, frequency):
    with pytest.raises(ParameterError, match='frequency'):
        calibrate(fork(), OAK, frequency)


@pytest.mark.parametrize('damping', [-0.1, 1.5, np.nan])
def test_a_damping_ratio_out_of_range(fork, damping):
    with pytest.raises(ParameterError, match='damping ratio'):
        calibrate(fork(), OAK, 1.0, damping)
