# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The trees that come with the package: the paper's two pot plants and a small broadleaf."""

from __future__ import annotations

from collections.abc import Callable
from types import MappingProxyType

import numpy as np

from tree_sway.core.growth.benjamina import grow_benjamina
from tree_sway.core.growth.broadleaf import grow_broadleaf
from tree_sway.core.growth.goldcrest import grow_goldcrest
from tree_sway.core.tree.tree import Tree
from tree_sway.errors import nearest, ParameterError

_GENERATORS: MappingProxyType[str, Callable[[np.random.Generator], Tree]] = MappingProxyType(
    {'benjamina': grow_benjamina, 'goldcrest': grow_goldcrest, 'broadleaf': grow_broadleaf}
)

BUILTIN_TREES: tuple[str, ...] = tuple(_GENERATORS)
"""Names that `builtin_tree` knows."""


def builtin_tree(name: str, seed: int = 0) -> Tree:
    """
    Grow a tree of `BUILTIN_TREES`; the same seed, not negative, gives the same tree.

    Raises a `ParameterError` for a name that no tree has, or a negative seed.
    """
    if name not in _GENERATORS:
        guess = nearest(name.lower(), BUILTIN_TREES)
        cure = f'{guess} use one of: {", ".join(BUILTIN_TREES)}'.lstrip()
        raise ParameterError(f"no built-in tree is called '{name}'", where='tree', cure=cure)
    if seed < 0:
        raise ParameterError(f'seed {seed} is negative', where='seed', cure='give 0 or more')
    return _GENERATORS[name](np.random.default_rng(seed))
