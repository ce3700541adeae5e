# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""T5: where Newton's iteration starts from, on a stiff chain of six at h = 1/30."""

from __future__ import annotations

import numpy as np

from tree_sway_lab.battery.row import fails, holds, Row
from tree_sway_lab.methods.chain import uniform_chain
from tree_sway_lab.methods.multiplier.generalized_alpha import GeneralizedAlpha

TITLE = "predictor of Newton's iteration"
DT, STEPS = 1 / 30, 150


def iterations(from_old_acceleration: bool) -> np.ndarray:
    """Newton iterations of each step, -1 where it fails, of a chain in a zigzag of 0.02 rad."""
    chain, method = uniform_chain(6, 2.0, 0.05), GeneralizedAlpha(0.8, from_old_acceleration)
    theta = 0.02 * np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
    load = np.zeros((1, 6, 2))
    load[..., 1] = 0.5
    state, options = method.start(chain, theta, 0 * theta, load[0], DT), method.options(chain, DT)
    return np.array(
        [GeneralizedAlpha.kernel(chain.table, state, load, DT, options) for _ in range(STEPS)]
    )


def run(full: bool = False) -> list[Row]:
    """Count iterations and failures from both starts."""
    old, good = iterations(True), iterations(False)
    failed = int(np.count_nonzero(old < 0))
    return [
        fails(
            'from the old acceleration',
            f'fails {STEPS} of {STEPS} steps',
            f'{failed} of {STEPS}',
            failed == STEPS,
        ),
        holds(
            'from q + h v',
            'at most 5 iterations',
            f'{good.min()} to {good.max()}',
            bool(good.min() > 0 and good.max() <= 5),
        ),
    ]
