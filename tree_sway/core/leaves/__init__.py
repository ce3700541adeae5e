# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Leaves: traits of a species, mass and area per branch, places and flutter.

Arrays per branch or per leaf.
Drag of leaves in wind is in ``motion/drag``.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.core.leaves.calendar import FIRST_MONTH as FIRST_MONTH
    from tree_sway.core.leaves.calendar import is_bare as is_bare
    from tree_sway.core.leaves.calendar import LAST_MONTH as LAST_MONTH
    from tree_sway.core.leaves.calendar import species_in_month as species_in_month
    from tree_sway.core.leaves.calendar import SUMMER as SUMMER
    from tree_sway.core.leaves.flutter import flutter_angle as flutter_angle
    from tree_sway.core.leaves.flutter import FLUTTER_GAIN as FLUTTER_GAIN
    from tree_sway.core.leaves.flutter import LARGEST_ANGLE as LARGEST_ANGLE
    from tree_sway.core.leaves.flutter import leaf_list as leaf_list
    from tree_sway.core.leaves.flutter import leaf_poses as leaf_poses
    from tree_sway.core.leaves.foliage import clad_wood as clad_wood
    from tree_sway.core.leaves.foliage import foliage_of as foliage_of
    from tree_sway.core.leaves.foliage import joined_clusters as joined_clusters
    from tree_sway.core.leaves.foliage import leaf_clusters as leaf_clusters
    from tree_sway.core.leaves.foliage import LeafClusters as LeafClusters
else:
    __getattr__, __dir__, __all__ = face(__name__)
