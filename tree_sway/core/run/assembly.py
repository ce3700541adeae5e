# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
From a `SwayModel` to the bank that steps and places it.

A number of coordinates is stepped on a table of winds, the model ``branch`` branch by branch. The
oscillators of other models come from installed packages (`installed_models`). Modules of one law
are imported where a tree needs them.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tree_sway.core.arrays import Records
from tree_sway.core.kernel import WHY_PLAIN
from tree_sway.core.model.fill_records import (
    block_records,
    fill_places,
    Places,
    segment_records,
)
from tree_sway.core.model.records import branch_layout
from tree_sway.core.model.sway_model import SwayModel
from tree_sway.core.run.bank import Bank, Oscillators

LOADED = (
    'frame', 'offset', 'twist', 'area', 'speed', 'spread', 'lever', 'projector', 'centre',
    'coupling', 'load_mode', 'damping_mode', 'load_rotation', 'tip_mode',
)  # fmt: skip
"""Fields of a branch's record that are arrays of the model."""

_NO_INERTIA = (
    'twigs hang or whip, but the segments have no inertia to solve with at their pose: the law '
    'of a stiffer tree moves them; check diameters and lengths'
)


def bank_of(model: SwayModel, *, plain: bool = False) -> Bank:
    """Lay a model out for stepping and placing; with ``plain`` nothing is compiled."""
    plain = plain or bool(WHY_PLAIN)
    places = _places(model)
    branches = _branches(model, places)
    segments = segment_records(places)
    oscillators = _oscillators(model, branches, plain)
    blocks = block_records(branches, segments)
    bank = Bank(oscillators, branches, segments, blocks, model.mass, plain)
    if model.is_limp:
        from tree_sway.core.run.limp_tree import LimpStep

        assert isinstance(oscillators, LimpStep)
        try:
            oscillators.begin(model, bank)
        except np.linalg.LinAlgError:
            stiffer = replace(model, segment_mass=np.zeros(0))
            others = _oscillators(stiffer, branches, plain)
            return replace(bank, oscillators=others, doubt=_NO_INERTIA)
    return bank


def _oscillators(model: SwayModel, branches: Records, plain: bool) -> Oscillators:
    """Make the oscillators of the law of a model."""
    if model.is_isolated:
        return _isolated(model, branches, plain)
    name = model.settings.model
    if isinstance(name, str):
        from tree_sway.installed_models import maker_of

        made: Oscillators = maker_of(name)(model, branches, plain)
        return made
    if not model.has_table:
        from tree_sway.core.run.rigid import RigidBank

        return RigidBank(branches, model)
    return _on_table(model, branches, plain)


def _isolated(model: SwayModel, branches: Records, plain: bool) -> Oscillators:
    """Make an oscillator for each branch; what a tuning changes is copied."""
    from tree_sway.core.run.branch_oscillators import BranchOscillators

    kind: type[BranchOscillators] = BranchOscillators
    if plain:
        from tree_sway.core.run.numpy_branch_oscillators import NumpyBranchOscillators

        kind = NumpyBranchOscillators
    given = (model.inertia, model.own_damping, model.stiffness, model.weight)
    return kind(branches, *(array.copy() for array in given))


def _on_table(model: SwayModel, branches: Records, plain: bool) -> Oscillators:
    """Make the coordinates that a table loads."""
    from tree_sway.core.model.table_record import table_record
    from tree_sway.core.run.modal_coordinates import ModalCoordinates

    coordinates = ModalCoordinates(branches, model)
    if model.is_limp:
        from tree_sway.core.run.limp_tree import LimpBank, NumpyLimpBank

        return (NumpyLimpBank if plain else LimpBank)(coordinates, table_record(model))
    if plain:
        from tree_sway.core.run.numpy_table import NumpyTableBank

        return NumpyTableBank(coordinates, table_record(model))
    from tree_sway.core.run.table_model import WindBasisBank

    return WindBasisBank(coordinates, table_record(model))


def _places(model: SwayModel) -> Places:
    """How the branches of a model are joined and drawn."""
    return Places(
        model.branch_first, model.branch_parent, model.branch_base_segment,
        model.branch_coordinate, model.branch_keys, model.branch_frame, model.branch_skew[:, 0],
        model.branch_skew[:, 1], model.branch_offset, model.branch_twist[:, :, 3:],
        model.segment_chord, model.segment_rest, model.segment_slope, model.segment_tip_slope,
        model.segment_turn,
    )  # fmt: skip


def _branches(model: SwayModel, places: Places) -> Records:
    """Fill the records of the branches for stepping and placing, (b,)."""
    tree = model.tree
    first = model.branch_first[:-1]
    last = model.branch_first[1:] - 1
    records: Records = np.zeros(len(first), dtype=branch_layout(model.branch_twist.shape[1]))
    fill_places(places, records)
    for name in LOADED:
        records[name] = getattr(model, f'branch_{name}')
    records['tip'] = tree.end[last] - tree.start[0]
    base = tree.start[first] - tree.start[0]
    arm = base - base[np.maximum(model.branch_parent, 0)]
    square = np.square(arm).sum(axis=1)
    records['base'] = base
    records['arm'] = arm
    records['per_arm'] = np.divide(0.5, square, out=np.zeros_like(square), where=square > 0.0)
    return records
