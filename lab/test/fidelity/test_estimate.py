# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A frame costs more with the load on every branch."""

from __future__ import annotations

from drawn_trees import crown

from tree_sway.core.scene.make import make_simulator
from tree_sway.fidelity.estimate import frame_cost


def test_a_branch_by_itself_costs_less_than_the_load_on_every_branch():
    few, all_of_them = (
        frame_cost(make_simulator(crown(), model=each).banks[0]) for each in (6, 'full')
    )
    assert few < all_of_them
