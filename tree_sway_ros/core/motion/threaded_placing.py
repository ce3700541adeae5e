# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Placing a large tree on several threads: blocks whose parents stand are placed side by side.

Blocks are in an order in which parents come first. A run of them in which none sits on another is
a wave; its blocks are shared out among the threads, and the next wave waits for all of them. Poses
are those of one thread to rounding. It pays from some ten thousand segments on.

"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cached_property, partial
from itertools import pairwise
from typing import Any

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.kernel import entry_of
from tree_sway_ros.core.motion.placing import place_blocks

_WORTH_SHARING = 256
"""Records, of sixteen segments each, from which on a wave is shared out."""


class ThreadedPlacing:
    """
    What `placing.place` does, on several threads.

    Parameters
    ----------
    branches, segments, heads, work
        As for `placing.place`.
    threads
        How many threads place.

    """

    def __init__(self, branches: Any, segments: Any, heads: Any, work: Any, threads: int) -> None:
        """Find the waves, and share each out."""
        self._scratch = np.zeros(threads, dtype=heads.dtype)
        self._arrays = (branches, segments, heads, work, self._scratch)
        self._shares = [
            _shared(heads["n_records"], first, end, threads) for first, end in waves(heads)
        ]
        self._pool = ThreadPoolExecutor(threads - 1, "placing")

    @cached_property
    def _compiled(self) -> Callable[..., None]:
        given = np.zeros(1), np.zeros(3), np.zeros((1, 7)), 0, 0, 0
        return partial(entry_of(place_blocks, *self._arrays, *given), *self._arrays)

    def place(self, x: Floats, origin: Floats, out: Floats) -> None:
        """Place every segment by key rotations (N,) in [rad], from a root node (3,) on, (n, 7)."""
        place, submit = self._compiled, self._pool.submit
        for shares in self._shares:
            others = [
                submit(place, x, origin, out, thread, first, end)
                for thread, (first, end) in enumerate(shares[1:], start=1)
            ]
            place(x, origin, out, 0, *shares[0])
            for other in others:
                other.result()


def waves(heads: Any) -> list[tuple[int, int]]:
    """Runs of blocks, first and one past the last, in which none sits on another."""
    n_blocks = len(heads) - 1
    block_of: dict[int, int] = {}
    for block, head in enumerate(heads[:n_blocks]):
        block_of.update(dict.fromkeys(head["branch"][: head["n_lanes"]].tolist(), block))
    found, first = [], 0
    for block, head in enumerate(heads[:n_blocks]):
        parents = head["parent"][: head["n_lanes"]].tolist()
        if any(parent >= 0 and block_of[parent] >= first for parent in parents):
            found.append((first, block))
            first = block
    return [*found, (first, n_blocks)]


def _shared(n_records: Any, first: int, end: int, threads: int) -> list[tuple[int, int]]:
    """Share blocks out among threads, about as many records to each."""
    reached = np.cumsum(n_records[first:end])
    if reached[-1] < _WORTH_SHARING:
        return [(first, end)]
    marks = reached[-1] * np.arange(1, threads) / threads
    cuts = [first, *(first + 1 + np.searchsorted(reached, marks)).tolist(), end]
    return [(begin, past) for begin, past in pairwise(cuts) if begin < past]
