# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Set-up: all that is computed once for a tree, before the first step.

In the order of the mechanics:

1. `beams`: each branch as a beam, and the fields of rotation in which it bends.
2. `matrices`, `subtree_inertia`: mass, weight and stiffness of the key rotations of all branches.
3. `modes`: natural modes of the coupled tree; a tree that buckles is refused.
4. `gust_responses`, `static_responses`: what gusts and steady winds move; the coordinates span it.
5. `load_table`: the load of every wind on every coordinate at every lean.
6. `stream_basis`: the few numbers in which poses are streamed.

`make_model` is this order in code, `prepare` finds the result in a cache or makes it, and
`TreeReductions` shares the parts among models. `season` adds the leaves. It is numpy and scipy,
with the loads of branches from the native core; nothing here runs in a step.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.core.setup.beams.beam import BranchBeam as BranchBeam
    from tree_sway.core.setup.beams.beam import N_POINTS as N_POINTS
    from tree_sway.core.setup.beams.beam import round_section as round_section
    from tree_sway.core.setup.beams.greenhill import greenhill_length as greenhill_length
    from tree_sway.core.setup.bent_inertia import MOST_CHANGE as MOST_CHANGE
    from tree_sway.core.setup.damping import relative_damping as relative_damping
    from tree_sway.core.setup.modes import buckling_factor as buckling_factor
    from tree_sway.core.setup.modes import natural_modes as natural_modes
    from tree_sway.core.setup.preparation import prepare as prepare
    from tree_sway.core.setup.preparation import prepared as prepared
    from tree_sway.core.setup.reductions import TreeReductions as TreeReductions
    from tree_sway.core.setup.season import in_season as in_season
    from tree_sway.core.setup.season import is_in_leaf as is_in_leaf
    from tree_sway.core.setup.season import LEAVES as LEAVES
    from tree_sway.core.setup.standing import standing_tree as standing_tree
    from tree_sway.core.setup.threads import one_thread as one_thread
    from tree_sway.core.setup.tree_motion import base_motion as base_motion
    from tree_sway.core.setup.tree_motion import branch_rotations as branch_rotations
    from tree_sway.core.setup.tree_motion import own_motion as own_motion
    from tree_sway.core.setup.tree_motion import tip_motion as tip_motion
    from tree_sway.core.setup.uncoupled_responses import basis_of_isolated as basis_of_isolated
    from tree_sway.core.setup.wind_moments import WindMoments as WindMoments
else:
    __getattr__, __dir__, __all__ = face(__name__)
