# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The tree of the benchmarks: what carries more is thicker, if that is asked for."""

import numpy as np
from tree_sway_lab.bench.bench_tree import bench_tree


def test_the_section_of_a_branch_grows_as_that_of_all_it_carries() -> None:
    usual, rich = bench_tree(2), bench_tree(2, (12, 6, 4), bears=True)
    assert (bench_tree(2, bears=True).end == usual.end).all()
    shares = np.zeros((2, 4))
    for share, tree in zip(shares, (usual, rich), strict=True):
        order = np.zeros(tree.n_branches, dtype=int)
        for branch, parent in enumerate(tree.branch_parent[1:], start=1):
            order[branch] = order[parent] + 1
        np.add.at(share, order, tree.base_diameter[tree.branch_first[:-1]] ** 2)
    assert np.allclose(shares[1] / shares[0], 4.0)
    height = (rich.end[1, 2] - rich.start[0, 2]) / (usual.end[1, 2] - usual.start[0, 2])
    assert np.isclose(height, 4.0 ** (1.0 / 3.0))
