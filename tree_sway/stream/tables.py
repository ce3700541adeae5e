# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Tables of the kinds of a described scene, by which a receiver solves it."""

from __future__ import annotations

import numpy as np

from tree_sway.core.run import TableOscillators
from tree_sway.core.scene import Simulator
from tree_sway.core.settings import USUAL
from tree_sway.errors import ParameterError, TreeSwayError
from tree_sway.stream.check_description import Arrays
from tree_sway.stream.protocol import encode_description, TABLES
from tree_sway.stream.scene_kind import SceneKind
from tree_sway.stream.table_export import exported_table, rounded


def why_no_tables(kinds: list[SceneKind]) -> TreeSwayError | None:
    """
    Return the error of a scene that a receiver cannot solve; None if it can.

    A table belongs to a tree on a number of coordinates, whose limbs meet each gust together.
    """
    for kind in kinds:
        model = kind.simulator
        if model.settings.has_limb_winds:
            what = 'a crown whose limbs meet gusts one after another has no table to solve it by'
            if model.settings.is_far:
                return ParameterError(what, where='gusts', cure='set them to measured')
            return ParameterError(what, where='crown_coherence', cure='set it to 1')
        if isinstance(model.banks[0].oscillators, TableOscillators):
            continue
        what = f"model '{model.model}' has no table to solve it by"
        cure = f'give a number of coordinates, such as {USUAL}'
        return ParameterError(what, where='--model', cure=cure)
    return None


def tables_of(simulator: Simulator, kinds: list[SceneKind], identity: str) -> bytes | None:
    """
    Write the tables of a scene that is described with an identity.

    Returns None where a tree has no table; see `why_no_tables`.
    """
    if why_no_tables(kinds) is not None:
        return None
    entries = []
    arrays = Arrays()
    for number, kind in enumerate(kinds):
        model = kind.simulator
        bank = model.banks[0].oscillators
        assert isinstance(bank, TableOscillators)
        numbers, own = exported_table(model.models[0], bank.modal.damping)
        state = bank.all_shapes @ kind.basis.projection.T
        # Motion of a correction of the coordinates with the least energy.
        root = np.sqrt(bank.modal.stiffness)
        own['state'] = state.astype(np.float32)
        own['correction'] = (np.linalg.pinv(state / root[:, None]) / root).astype(np.float32)
        branches, modes = bank.compliance
        for part, exact in (('branch', branches), ('shape', state.T @ modes @ state)):
            # To a share of 0.002, so that files are smaller.
            own[f'{part}_compliance'] = rounded(exact, 16)
        arrays |= {f'{number}/{name}': array for name, array in own.items()}
        entries.append({**numbers, 'drag_law': list(model.models[0].drag_law)})
    arrays['tree_speed'] = simulator.speeds.astype(np.float32)
    header: dict[str, object] = {
        'format': 'tree_sway tables',
        'description': identity,
        'kinds': entries,
        'anemometer': None,
        'convection_ratio': 1.0,
    }
    gusts = simulator.gusts
    if gusts is not None:
        header['anemometer'] = None if gusts.anemometer is None else gusts.anemometer.tolist()
        ratio = gusts.convection_ratio
        header['convection_ratio'] = ratio if np.isfinite(ratio) else None
    return encode_description(header, arrays, TABLES)
