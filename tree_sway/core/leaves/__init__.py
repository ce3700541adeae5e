# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Leaves: mass and area per branch for the solver, clusters and flutter for viewers.

`foliage_of` spreads the leaf area of a species over the twigs of a tree; `clad_wood` adds their
mass. `leaf_clusters` places what a viewer draws, `flutter_angle` moves it with the air that
passes.

The solver takes mass and area alone; nothing here steps.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.core.leaves.flutter import FLUTTER as FLUTTER
    from tree_sway.core.leaves.flutter import flutter_angle as flutter_angle
    from tree_sway.core.leaves.foliage import clad_wood as clad_wood
    from tree_sway.core.leaves.foliage import foliage_of as foliage_of
    from tree_sway.core.leaves.foliage import joined_clusters as joined_clusters
    from tree_sway.core.leaves.foliage import leaf_clusters as leaf_clusters
    from tree_sway.core.leaves.foliage import LeafClusters as LeafClusters
    from tree_sway.core.leaves.foliage import stem_section as stem_section
else:
    __getattr__, __dir__, __all__ = face(__name__)
