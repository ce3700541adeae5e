# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Branches in blocks: the same step as one by one, whatever the number."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.methods.branch_bank import guards, step_bank
from tree_sway_lab.methods.branch_blocks import BranchBlocks, WIDTH

from tree_sway.core.oscillators.propagation import propagator


def bank(n, seed=0, dt=1 / 60):
    rng = np.random.default_rng(seed)
    w, inertia = 2 * np.pi * rng.uniform(0.3, 8, n), rng.uniform(0.01, 5, n)
    stiffness = inertia * w * w
    state = np.vstack([rng.uniform(-0.8, 0.8, (2, n)), rng.uniform(-2, 2, (2, n))])
    load = rng.normal(0, 2.0, (3, n)) * stiffness
    return (
        state,
        load,
        propagator(inertia, 0.1 * w * inertia, stiffness, dt),
        guards(inertia, stiffness, dt),
    )


@pytest.mark.parametrize('n', [1, WIDTH, 3 * WIDTH + 5])
@pytest.mark.parametrize(('kind', 'slack'), [(np.float64, 1e-12), (np.float32, 3e-5)])
def test_blocks_step_as_the_bank_does(n, kind, slack):
    state, load, rows, guard = bank(n)
    blocks = BranchBlocks(rows, guard, kind)
    blocks.state, blocks.load = state, load
    for _ in range(3):
        clamped = step_bank(state, load, rows, guard)
        assert blocks.step() == clamped
    assert blocks.state == pytest.approx(state, rel=slack, abs=slack * 50)
    assert blocks.load == pytest.approx(load, rel=1e-6)


def test_the_slots_without_a_branch_stay_at_rest():
    _, load, rows, guard = bank(3)
    blocks = BranchBlocks(rows, guard)
    blocks.load = load * np.nan
    assert blocks.step() == 3
    assert not blocks.state.any()
