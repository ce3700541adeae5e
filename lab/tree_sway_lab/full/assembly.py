# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""From a prepared model of all coordinates to the oscillators of the model `full`."""

from __future__ import annotations

from tree_sway.core.arrays import Records
from tree_sway.core.model import SwayModel
from tree_sway.core.native import AT_POSE
from tree_sway.core.run import native_stand, Oscillators
from tree_sway_lab.full.bank import FullBank
from tree_sway_lab.full.limp_bank import LimpFullBank


def full_bank(model: SwayModel, branches: Records) -> Oscillators:
    """Make the oscillators of all coordinates of a tree."""
    if model.is_limp:
        stand = native_stand(model)
        if stand.models[0].sizes.is_stepped == AT_POSE:
            return LimpFullBank(model, stand)
    return FullBank(branches, model)
