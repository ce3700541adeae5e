# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The built-in trees: the paper's two pot plants and a small broadleaf."""

from __future__ import annotations

from collections.abc import Callable
from types import MappingProxyType

import numpy as np

from tree_sway.core.checks import one_of, within
from tree_sway.core.tree import Tree
from tree_sway.growth.benjamina import grow_benjamina
from tree_sway.growth.broadleaf import grow_broadleaf
from tree_sway.growth.goldcrest import grow_goldcrest

_GENERATORS: MappingProxyType[str, Callable[[np.random.Generator], Tree]] = MappingProxyType(
    {'benjamina': grow_benjamina, 'goldcrest': grow_goldcrest, 'broadleaf': grow_broadleaf}
)

BUILTIN_TREES: tuple[str, ...] = tuple(_GENERATORS)
"""Names that `builtin_tree` knows."""


def builtin_tree(name: str, seed: int = 0) -> Tree:
    """
    Grow a tree of `BUILTIN_TREES`; the same seed, not negative, gives the same tree.

    Raises a `ParameterError` for an unknown name, or a negative seed.
    """
    one_of('built-in tree', name, BUILTIN_TREES)
    within('seed', seed, 0, 2**63)
    return _GENERATORS[name](np.random.default_rng(seed))
