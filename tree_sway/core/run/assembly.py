# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
From a `SwayModel` to the bank that steps and places it.

A number of coordinates is stepped on a table of winds, the model ``branch`` branch by branch. The
oscillators of other models come from installed packages (`installed_models`). Modules of one law
are imported where a tree needs them.
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.model import SwayModel
from tree_sway.core.native import AT_POSE, bytes_of, NativeModel, NativeStand
from tree_sway.core.run.bank import Bank, Oscillators

_NO_INERTIA = (
    'twigs hang or whip, but the segments have no inertia to solve with at their pose: the law '
    'of a stiffer tree moves them; check diameters and lengths'
)


def native_stand(model: SwayModel) -> NativeStand:
    """Return a native stand of one tree, where the tree of a model stands."""
    place = np.array([[*model.tree.start[0], 0.0, 1.0]])
    own = NativeModel(bytes_of(model.native_arrays()))
    return NativeStand([own], np.zeros(1, dtype=np.int64), place, np.ones(1))


def bank_of(model: SwayModel) -> Bank:
    """Make a model ready to be stepped and placed."""
    stand = native_stand(model)
    made = _oscillators(model, stand)
    solved: NativeStand = getattr(made, 'stand', stand)
    is_stiffer = model.is_limp and solved.models[0].sizes.is_stepped != AT_POSE
    return Bank(made, model, solved, _NO_INERTIA if is_stiffer else '')


def _oscillators(model: SwayModel, stand: NativeStand) -> Oscillators:
    """Make the oscillators of the law of a model."""
    if model.is_isolated:
        from tree_sway.core.run.branch_oscillators import BranchOscillators

        return BranchOscillators(model)
    name = model.settings.model
    if isinstance(name, str):
        from tree_sway.installed_models import maker_of

        made: Oscillators = maker_of(name)(model, model.branches)
        return made
    if not model.has_table:
        from tree_sway.core.run.rigid import RigidBank

        return RigidBank(model)
    from tree_sway.core.run.table_model import TableOscillators

    return TableOscillators(model, stand)
