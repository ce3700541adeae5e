# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The basis in which the motion of a tree is streamed."""

from __future__ import annotations

from tree_sway.core.model import StateBasis
from tree_sway.core.run.simulator import SwaySimulator


def basis_of(simulator: SwaySimulator) -> StateBasis:
    """Return the basis in which a tree's motion is streamed; no state is read or changed."""
    (model,), (bank,) = simulator.models, simulator.banks
    if not model.is_isolated:
        return model.basis
    from tree_sway.core.setup import basis_of_isolated

    return basis_of_isolated(model, bank.branches)
