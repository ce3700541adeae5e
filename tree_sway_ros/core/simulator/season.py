"""
The season of a tree: what its leaves weigh, catch and damp, as settings of its model.

"""

from __future__ import annotations

from dataclasses import replace

from tree_sway_ros.core.leaves.foliage import foliage_of
from tree_sway_ros.core.leaves.traits import LeafTraits
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.core.tree.tree import Tree


def in_season(
    tree: Tree,
    settings: Settings | None = None,
    *,
    leaf_on: bool,
    traits: LeafTraits | None = None,
) -> Settings:
    """
    Return settings for a tree with its leaves on or off.

    Leaves add mass and area to their branches, damp them as the species in leaf, and let the crown
    streamline.

    Parameters
    ----------
    tree
        The tree.
    settings
        What else is set; the usual settings if None.
    leaf_on
        Whether it is the season of leaves; evergreens have theirs always.
    traits
        Its leaves; those of its species if None.

    """
    given = settings if settings is not None else Settings()
    foliage = foliage_of(tree, leaf_on=leaf_on, traits=traits)
    if not foliage.area.any():
        return replace(given, in_leaf=False, leaf_mass=None, leaf_area=None)
    return replace(given, in_leaf=True, leaf_mass=foliage.mass, leaf_area=foliage.drag_area)
