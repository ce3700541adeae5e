# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""From a prepared model of all coordinates to the oscillators of the model `full`."""

from __future__ import annotations

from tree_sway.core.arrays import Records
from tree_sway.core.model.sway_model import SwayModel
from tree_sway_lab.full.bank import FullBank


def full_bank(model: SwayModel, branches: Records) -> FullBank:
    """Make the oscillators of all coordinates of a tree."""
    if model.is_limp:
        from tree_sway_lab.full.limp_bank import LimpFullBank

        return LimpFullBank(branches, model)
    return FullBank(branches, model)
