# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""From the reductions of a tree to the oscillators of the model `full`."""

from __future__ import annotations

from tree_sway.cache.model_cache import SetUpFiles
from tree_sway.core.run.assembly import laid_out, modal_arrays_of, stored_set_up
from tree_sway.core.run.bank import Bank
from tree_sway.core.setup.reductions import TreeReductions
from tree_sway_lab.full.bank import FullBank


def full_bank(reductions: TreeReductions, cache: SetUpFiles | None = None) -> Bank:
    """Build the oscillators of all coordinates of a tree, read from the cache or made."""
    made_of = stored_set_up(reductions, 'full', cache, lambda: modal_arrays_of(reductions, 'full'))
    kind: type[FullBank] = FullBank
    if reductions.plain:
        from tree_sway_lab.full.numpy_bank import NumpyFullBank

        kind = NumpyFullBank
    oscillators = kind(made_of['branches'].copy(), made_of, reductions.damping_ratio)
    return laid_out(oscillators, made_of, reductions.plain)
