# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Members without spreads move as the model; those of one spread as trees made with it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tree_sway.core.arrays import Floats
from tree_sway.core.scene.make import make_simulator
from tree_sway.core.species.species import species_named
from tree_sway.core.wind.turbulence import simulate_turbulence
from tree_sway.growth.growing import grow
from tree_sway.simulation.rig import simulate
from tree_sway.twin import members as members_module
from tree_sway.twin import observed_tree as observed_tree_module
from tree_sway.twin.members import Uncertainty, uncorrelated_draws
from tree_sway.twin.observed_tree import ObservedTree

DT = 1.0 / 60.0
TREE, SPECIES = grow('spruce', 5.0, rng=np.random.default_rng(8)), species_named('spruce')
WIND = simulate_turbulence(6.0, rate=60.0, duration=20.0, rng=np.random.default_rng(21))


def swayed(spreads: Uncertainty) -> tuple[ObservedTree, Floats, Floats]:
    """Sway a tree; return it, its first key rotation (n,) and that of its members (n, e)."""
    twin = ObservedTree(TREE, SPECIES, in_leaf=False, at={}, has_band=True, crown_coherence=1.0)
    assert twin.members is not None
    twin.members.spreads = spreads
    shape = twin.banks[0].oscillators.shapes[0, : twin.observer.count]
    own, others = [], []
    for each in WIND:
        twin.step(each, DT)
        own.append(twin.rotations()[0])
        others.append(shape @ twin.members.motion[0])
    return twin, np.array(own), np.array(others)


@pytest.fixture
def calm(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let all gusts be known."""
    for module in (members_module, observed_tree_module):
        monkeypatch.setattr(module, 'USUAL_COHERENCE', 1.0)


@pytest.mark.usefixtures('calm')
def test_members_that_do_not_differ_move_as_the_model() -> None:
    _, own, others = swayed(Uncertainty(0.0, 0.0, 0.0))
    wrong = others - own[:, None]
    assert np.sqrt(np.square(wrong).mean()) < 0.02 * np.sqrt(np.square(own).mean())


@pytest.mark.usefixtures('calm')
def test_a_member_of_softer_wood_moves_as_a_tree_of_it() -> None:
    twin, _, others = swayed(Uncertainty(0.2, 0.0, 0.0))
    assert twin.members is not None
    which = int(np.argmin(np.abs(twin.members.stiffness - 0.8)))
    wood = replace(SPECIES, modulus=float(twin.members.stiffness[which]) * SPECIES.modulus)
    softer = make_simulator(TREE, wood, in_leaf=False, crown_coherence=1.0)
    wanted = []
    for each in WIND:
        softer.step(each, DT)
        wanted.append(softer.rotations()[0])
    wrong = others[:, which] - wanted
    assert np.std(wrong) < 0.1 * np.std(wanted)
    assert abs(np.mean(wrong)) < 0.1 * abs(np.mean(wanted))


def test_simulate_writes_bounds_about_the_motion() -> None:
    record = simulate(TREE, WIND, in_leaf=False, band=True)
    assert record.tip_band is not None
    assert record.moment_band is not None
    low, high = record.tip_band[60:, 0, 0], record.tip_band[60:, 1, 0]
    own = record.tips[60:, 0]
    assert ((low[:, :2] <= own[:, :2]) & (own[:, :2] <= high[:, :2])).mean() > 0.9
    assert (record.moment_band[60:, 0] <= record.moment_band[60:, 1]).all()
    names = record.columns()
    assert len({name for name in names if ' low_' in name}) == 6
    assert simulate(TREE, WIND[:60], in_leaf=False).tip_band is None


def test_members_err_by_gusts_as_the_model_does_against_gusts_limb_by_limb() -> None:
    true = make_simulator(TREE, SPECIES, in_leaf=False, crown_coherence=0.3)
    wanted = []
    for each in WIND:
        true.step(each, DT)
        wanted.append(true.rotations()[0])
    _, own, others = swayed(Uncertainty(0.0, 0.0, 0.0))
    error = np.std(own - wanted)
    spread = np.sqrt(np.square(others - own[:, None]).mean())
    print(f'spread {spread / error:.2f} of the error')
    assert 0.7 < spread / error < 2.0


def test_wood_and_drag_of_the_members_are_not_correlated() -> None:
    drawn = uncorrelated_draws(64, 3, np.random.default_rng(0))
    assert np.abs(np.corrcoef(drawn) - np.eye(3)).max() < 0.05
    np.testing.assert_allclose(np.sort(drawn[0]), np.sort(drawn[1]))
