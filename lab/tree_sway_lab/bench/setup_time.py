# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Setting a tree up, timed: from its segments to a simulator that is ready to step.

What is compiled and cached on disk is loaded before, by setting a small tree up.

"""

from __future__ import annotations

from collections.abc import Sequence
import time

from tree_sway.core.scene import make_simulator
from tree_sway.core.tree import Tree
from tree_sway_lab.bench.bench_tree import bench_tree

#: On the stem and on branches of the next orders: 1,021 branches of 6 segments.
MODELS = ('branch', 20, 60, 'full')
_CHILDREN = (12, 6, 13)
_SMALL = (3, 2)


def time_setups(tree: Tree, models: Sequence[int | str]) -> dict[int | str, float]:
    """
    Set a tree up on several models, each from nothing.

    Parameters
    ----------
    tree
        The tree.
    models
        Numbers of coordinates, ``branch`` or ``full``.

    Returns
    -------
    dict
        By model, CPU time in [s], of all threads together.

    """
    small = bench_tree(3, _SMALL)
    spent: dict[int | str, float] = {}
    for model in models:
        make_simulator(small, model=model)
        begin = time.process_time()
        make_simulator(tree, model=model, cache=None)
        spent[model] = time.process_time() - begin
    return spent


def setup_table() -> str:
    """Time all models on the tree of the other benchmarks and on a big one, as a table."""
    lines = ['set-up [s]' + ' ' * 26 + ''.join(f'{model:>9}' for model in MODELS)]
    for tree in (bench_tree(), bench_tree(children=_CHILDREN)):
        times = ''.join(f'{each:9.2f}' for each in time_setups(tree, MODELS).values())
        lines.append(f'  {tree.n_branches:5} branches, {tree.n_segments:6} segments  {times}')
    return '\n'.join(lines)
