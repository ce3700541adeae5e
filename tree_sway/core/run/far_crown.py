# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The winds of the parts of a crown apart from its anemometer, and where a step reads them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.wind.crown_wind import N_DELAYS
from tree_sway.core.wind.far_wind import FarWind

if TYPE_CHECKING:
    from tree_sway.core.model.sway_model import SwayModel
    from tree_sway.core.run.bank import Bank
    from tree_sway.core.run.crown_gusts import CrownGusts


class FarCrown:
    """The wind of a crown; that of its parts is written where the step of the model reads it."""

    def __init__(self, model: SwayModel, bank: Bank, gusts: CrownGusts | None) -> None:
        """Start without wind."""
        settings, branches = model.settings, bank.branches
        tree = model.tree
        part = model.limb_delay if model.has_limbs else np.zeros(len(branches), dtype=np.int64)
        load = np.bincount(part, branches['area'], N_DELAYS)
        top = tree.end[int(np.argmax(tree.end[:, 2]))]
        beside = (branches['centre'] - top).T
        places = [np.bincount(part, branches['area'] * x, N_DELAYS) for x in beside]
        self.wind = FarWind(
            np.stack(places, axis=1) / np.maximum(load, 1e-12)[:, None],
            load / load.sum(),
            settings.anemometer_distance,
            settings.anemometer_bearing,
            int(settings.motion_seed) if settings.motion == 'sample' else None,
        )
        self._apart = self._read_by_step(bank, gusts)

    def push(self, x: float, y: float, z: float, dt: float) -> tuple[float, float, float]:
        """Add the wind of a step at the anemometer [m/s]; return that of the crown."""
        east, north, up = self.wind.push(x, y, z, dt, self._apart).tolist()
        return east, north, up

    @staticmethod
    def _read_by_step(bank: Bank, gusts: CrownGusts | None) -> Floats:
        """Winds of the parts less that of the crown, (parts, 3), where the model has them."""
        stand = getattr(bank.oscillators, 'stand', None)
        if gusts is not None:
            memory = gusts.wind.memory()[0]
        elif stand is not None and stand.states.history.size:
            memory = stand.states.history[bank.oscillators.number]
        else:
            memory = np.zeros(3 * N_DELAYS)
        return np.asarray(memory[-3 * N_DELAYS :].reshape(N_DELAYS, 3))
