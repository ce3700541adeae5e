# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Table of natural modes: frequency, damping, and the branch that bends most."""

from __future__ import annotations

from typing import Any

import numpy as np

from tree_sway.core.setup import relative_damping, TreeReductions


def mode_table(whole: TreeReductions, count: int) -> tuple[list[dict[str, Any]], float]:
    """
    List the slowest natural modes of a tree, a number of them or all, and its mass in [kg].

    A mode has frequency [Hz] and damping ratio of wood and leaves, both without air, and the
    branch that bends most.
    """
    modes = whole.natural_modes(min(count, whole.with_subtrees.reduction.n_coordinates))
    damping_ratios = whole.damping_ratio * relative_damping(whole, modes)
    reduced = whole.with_subtrees
    owner = np.repeat(reduced.branch, reduced.branches['n_coordinates'])
    rows = [
        {
            'frequency': frequency,
            'damping_ratio': damping_ratio,
            'branch': whole.tree.branch_names[int(owner[np.argmax(np.abs(shape))])],
        }
        for frequency, damping_ratio, shape in zip(
            modes.frequencies.tolist(), damping_ratios.tolist(), modes.shapes.T, strict=True
        )
    ]
    return rows, float(reduced.mass.sum())
