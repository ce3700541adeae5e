# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Loads of winds on a tree at rest, by the drag of each panel of its branches.

A branch that moves has the law of `fitted_load`. A wind along a crooked branch meets each of its
panels at another small angle, and there that law is off by a tenth: at rest it is not needed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tree_sway.core.arrays import Floats
from tree_sway.core.rotation import cross_matrix

if TYPE_CHECKING:
    from tree_sway.core.setup.reduced_tree import ReducedTree


def rest_loads(
    reduced: ReducedTree, shapes: Floats, is_loaded: NDArray[np.bool_] | None, winds: Floats
) -> Floats:
    """
    Return loads of winds (k, 3) of 1 kg/m^3 on shapes (N, m) of a tree at rest, (k, m).

    ``is_loaded`` says which branches the wind meets, (b,); all if None.
    """
    records = reduced.branches
    moments = np.zeros((len(shapes), len(winds)))
    wrench = np.zeros((len(records), 6, len(winds)))
    for b in reversed(range(len(records))):
        joint = records[b]
        model = reduced.models[b]
        if is_loaded is None or is_loaded[b]:
            tangent = model.beam.tangent
            across = winds[:, None] - (winds @ tangent.T)[..., None] * tangent
            force = across * np.linalg.norm(across, axis=-1, keepdims=True)
            area = (model.drag_area * model.beam.weight)[..., None]
            turning = cross_matrix((area * model.beam.point).sum(axis=1)).swapaxes(0, 1)
            moved = [(area * field.points).sum(axis=1) for field in model.fields]
            pushing = area.sum(axis=1) * np.eye(3)[:, None]
            work = np.concatenate([pushing, turning, moved]).reshape(6 + len(moved), -1)
            exerted = work @ force.reshape(len(winds), -1).T
            wrench[b] += exerted[:6]
            first = int(joint['coordinate'])
            moments[first : first + len(moved)] += exerted[6:]
        if joint['parent'] >= 0:
            below = records[joint['parent']]
            first, count = int(below['coordinate']), int(below['n_coordinates'])
            moments[first : first + count] += joint['twist'][:count] @ wrench[b]
            wrench[joint['parent']] += wrench[b]
    return np.asarray(moments.T @ shapes)
