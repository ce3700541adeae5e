"""
Setting a tree up, timed: from its segments to a simulator that is ready to step.

What is compiled and kept on disk is loaded before, by setting a small tree up.

"""

from __future__ import annotations

import time
from collections.abc import Sequence

from tree_sway_ros.core.simulator.settings import RUNGS
from tree_sway_ros.core.simulator.simulator import SwaySimulator
from tree_sway_ros.core.tree.tree import Tree
from tree_sway_ros.study.bench.bench_tree import bench_tree

#: On the stem and on branches of the next orders: 1,021 branches of 6 segments.
_CHILDREN = (12, 6, 13)
_SMALL = (3, 2)


def time_setups(tree: Tree, rungs: Sequence[str]) -> dict[str, float]:
    """
    Set a tree up on several rungs, each from nothing.

    Parameters
    ----------
    tree
        The tree.
    rungs
        Some of `RUNGS`; ``modes`` steps as many as it does where nothing is said.

    Returns
    -------
    dict
        By rung, CPU time in [s], of all threads together.

    """
    small = bench_tree(3, _SMALL)
    spent = {}
    for rung in rungs:
        SwaySimulator(small, rung=rung)
        begin = time.process_time()
        SwaySimulator(tree, rung=rung)
        spent[rung] = time.process_time() - begin
    return spent


def setup_table() -> str:
    """
    Time all rungs on the tree of the other benchmarks and on a big one, and lay out what is found.

    """
    rungs = RUNGS[1:]
    lines = ["set-up [s]" + " " * 26 + "".join(f"{rung:>9}" for rung in rungs)]
    for tree in (bench_tree(), bench_tree(children=_CHILDREN)):
        times = "".join(f"{each:9.2f}" for each in time_setups(tree, rungs).values())
        lines.append(f"  {tree.n_branches:5} branches, {tree.n_segments:6} segments  {times}")
    return "\n".join(lines)
