# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Turbulence without end: any tick of a stream that never repeats and has no seams.

The stream is a sum of records, one begun every half period, each faded in and out by half a sine.
The squares of two neighbouring fades sum to one and the records are independent, so that variance
and spectrum are the same at every tick (the spectrum smeared by no more than one line). Block k
draws its phases from (seed, k) alone: a tick has one value, whichever ticks were asked for before,
and a change of mean or intensity under the same seed keeps the pattern of the gusts.
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import within
from tree_sway.core.wind.simulated.turbulence import SHORTEST_PERIOD, Turbulence


class TurbulenceStream:
    """Endless turbulence, a function of seed (0 to 2^63) and tick, at 1000 per second at most."""

    def __init__(self, turbulence: Turbulence, rate: float, seed: int) -> None:
        """Draw nothing yet."""
        self._turbulence = turbulence
        self._rate = within('rate', rate, 0.0, 1000.0, 'Hz', above=True)
        self._seed = int(within('seed', seed, 0, 2**63))
        # A power of two, no shorter than the period that IEC defines the deviations over.
        self._n_block = 1 << max(2, int(np.ceil(np.log2(SHORTEST_PERIOD * self._rate))))
        self._n_hop = self._n_block // 2
        middle = (np.arange(self._n_block) + 0.5) / self._n_block
        self._fade = np.sin(np.pi * middle)[:, np.newaxis]
        self._hop = -1
        self._wind: Floats = np.empty((0, 3))
        self._tail: Floats = np.empty((0, 3))

    def at(self, tick: int) -> Floats:
        """Return u, v, w about their zero mean in [m/s], (3,), at a tick from 0 on; a copy."""
        within('tick', tick, 0, 2**63)
        hop, offset = divmod(tick, self._n_hop)
        if hop != self._hop:
            self._move_to(hop)
        wind: Floats = self._wind[offset].copy()
        return wind

    def _move_to(self, hop: int) -> None:
        """Join the last block's end to the next one's start; in order, one block is drawn."""
        tail = self._tail if hop == self._hop + 1 and hop > 0 else self._block(hop)[self._n_hop :]
        head, self._tail = np.split(self._block(hop + 1), 2)
        self._wind = head + tail
        self._hop = hop

    def _block(self, index: int) -> Floats:
        rng = np.random.default_rng((self._seed, index))
        block: Floats = self._turbulence.record(self._n_block, self._rate, rng) * self._fade
        return block
