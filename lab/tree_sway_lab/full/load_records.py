# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""From the records of branches to those of the wind load on each, in slots of sixteen."""

from __future__ import annotations

import numpy as np

from tree_sway.core.arrays import Records
from tree_sway.core.model import WIDTH
from tree_sway.core.rotation import cross
from tree_sway_lab.full.load_layouts import load_layout, zeros_in_lines


def load_records(branches: Records) -> Records:
    """
    Lay the wind load of `Branch` records, (b,), out in sixteens, (ceil(b / 16),).

    Records are at rest, without force, and of `load_layout` with the rows of the branches.
    """
    layout = load_layout(branches.dtype['load_mode'].shape[0])
    records = zeros_in_lines(-(-len(branches) // WIDTH), layout)
    block, slot = np.divmod(np.arange(len(branches)), WIDTH)
    for name in ('speed', 'area', 'spread', 'projector'):
        records[name][block, ..., slot] = branches[name]
    for name in ('damping_mode', 'load_rotation', 'load_mode'):
        records[name][block, ..., slot] = branches[name]
    at_base = cross(branches['base'][:, None], np.eye(3)).swapaxes(1, 2)
    records['coupling'][block, ..., slot] = branches['coupling'] - at_base
    np.maximum.at(records['n_rows'], block, branches['n_coordinates'])
    return records
