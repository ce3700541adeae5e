# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The prepared model of a tree: the wall between set-up and run.

`SwayModel` is one object of named arrays with units and shapes (`MEANINGS`,
``doc/sway_model.md``): whoever has it steps and places the tree without any of the set-up, in
Python, C++ or a browser. Its ``check`` names the array that is wrong. `ModelCache` is where
prepared models are found again, by a digest of what they were made of. `StateBasis` is the basis
in which poses are streamed.

`records` and `branch_blocks` are layouts that set-up fills and the
native core reads. Here is no arithmetic of motion; a new array begins here, in `sway_model`.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.core.model.branch_blocks import BranchBlocks as BranchBlocks
    from tree_sway.core.model.model_cache import ModelCache as ModelCache
    from tree_sway.core.model.model_cache import PREPARED as PREPARED
    from tree_sway.core.model.records import Branch as Branch
    from tree_sway.core.model.records import branches_at_rest as branches_at_rest
    from tree_sway.core.model.records import LOADED as LOADED
    from tree_sway.core.model.records import MAX_COORDINATES as MAX_COORDINATES
    from tree_sway.core.model.records import MOST_IN_ALL as MOST_IN_ALL
    from tree_sway.core.model.records import N_AZIMUTHS as N_AZIMUTHS
    from tree_sway.core.model.records import N_HARMONICS as N_HARMONICS
    from tree_sway.core.model.records import N_LEVELS as N_LEVELS
    from tree_sway.core.model.records import PLACED as PLACED
    from tree_sway.core.model.records import room_for_fields as room_for_fields
    from tree_sway.core.model.records import WIDTH as WIDTH
    from tree_sway.core.model.state_basis import FULL_SCALE as FULL_SCALE
    from tree_sway.core.model.state_basis import MARGIN as MARGIN
    from tree_sway.core.model.state_basis import rounded as rounded
    from tree_sway.core.model.state_basis import StateBasis as StateBasis
    from tree_sway.core.model.sway_model import MEANINGS as MEANINGS
    from tree_sway.core.model.sway_model import SwayModel as SwayModel
    from tree_sway.core.model.sway_model import TYPES as TYPES
else:
    __getattr__, __dir__, __all__ = face(__name__)
