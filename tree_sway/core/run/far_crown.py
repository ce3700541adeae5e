# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The winds of the parts of a crown apart from its anemometer, and where a step reads them."""

from __future__ import annotations

from typing import Any, TYPE_CHECKING

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.wind.gusts import FarWind, N_DELAYS, parts_of

if TYPE_CHECKING:
    from tree_sway.core.model import SwayModel
    from tree_sway.core.run.bank import Bank
    from tree_sway.core.run.crown_gusts import CrownGusts
    from tree_sway.core.settings import Settings
    from tree_sway.core.tree import Tree


class FarCrown:
    """The wind of a crown; that of its parts is written where the step of the model reads it."""

    def __init__(
        self, model: SwayModel, bank: Bank, gusts: CrownGusts | None, settings: Settings
    ) -> None:
        """Start without wind; observed trees, whose models have one wind, draw what may be too."""
        branches = bank.branches
        is_sample = settings.gusts == 'sample' and settings is model.settings
        is_drawn = is_sample or settings is not model.settings
        tree = model.tree
        wood = parts_of(tree)
        load = wood.share
        if model.has_limbs:
            load = np.asarray(np.bincount(model.limb_delay, branches['area'], N_DELAYS), float)
        places, size = self._places(tree, wood.of_branch[tree.branch_of_segment])
        self.wind = FarWind(
            places,
            size,
            load / load.sum(),
            float(model.natural_frequencies[0]),
            settings.anemometer_distance,
            settings.anemometer_bearing,
            int(settings.gust_seed) if is_drawn else None,
            is_sample=is_sample,
        )
        self._apart = self._read_by_step(bank, gusts)

    def push(self, x: float, y: float, z: float, dt: float) -> tuple[float, float, float]:
        """Add the wind of a step at the anemometer [m/s]; return that of the crown."""
        east, north, up = self.wind.push(x, y, z, dt, self._apart).tolist()
        return east, north, up

    @staticmethod
    def _places(tree: Tree, part: Ints) -> tuple[Floats, Floats]:
        """Middle of each part from the highest point, (g, 3), and its rms radius, (g,), in [m]."""
        area = tree.length * (tree.base_diameter + tree.tip_diameter)
        total = np.maximum(np.bincount(part, area, N_DELAYS), 1e-12)
        centre = 0.5 * (tree.start + tree.end)
        sums = [np.bincount(part, area * x, N_DELAYS) for x in centre.T]
        middle = np.stack(sums, axis=1) / total[:, None]
        square = np.square(centre - middle[part]).sum(axis=1)
        radius = np.sqrt(np.bincount(part, area * square, N_DELAYS) / total)
        return middle - tree.end[int(np.argmax(tree.end[:, 2]))], radius

    @staticmethod
    def _read_by_step(bank: Bank, gusts: CrownGusts | None) -> Floats:
        """Winds of the parts less that of the crown, (parts, 3), where the model has them."""
        oscillators: Any = bank.oscillators
        stand = getattr(oscillators, 'stand', None)
        if gusts is not None:
            memory = gusts.wind.memory()[0]
        elif stand is not None and stand.states.history.size:
            memory = stand.states.history[oscillators.number]
        else:
            memory = np.zeros(3 * N_DELAYS)
        return np.asarray(memory[-3 * N_DELAYS :].reshape(N_DELAYS, 3))
