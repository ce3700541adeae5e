# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Wood, bark, leaves and look of a species, by name.

A species is one row of ``species.csv``: density and modulus of green wood, modulus of rupture,
damping, drag in leaf, mass and area of leaves, and how bark and leaves look. `species_named` finds
it by any of its names, `species_like` by its last word, so that a silver birch is a birch; an
unknown name is a `SpeciesError` with names that are near. `Species` is the plain data, which a
caller may make or change (`dataclasses.replace`).

The sources of the numbers are in `species`. Leaves on a tree are in the house `leaves`.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.core.species.foliage_traits import LeafTraits as LeafTraits
    from tree_sway.core.species.look import Color as Color
    from tree_sway.core.species.look import Look as Look
    from tree_sway.core.species.look import Spray as Spray
    from tree_sway.core.species.species import leaf_traits as leaf_traits
    from tree_sway.core.species.species import look_of as look_of
    from tree_sway.core.species.species import ROOT_MOMENT as ROOT_MOMENT
    from tree_sway.core.species.species import SPECIES as SPECIES
    from tree_sway.core.species.species import species_keys as species_keys
    from tree_sway.core.species.species import species_like as species_like
    from tree_sway.core.species.species import species_named as species_named
    from tree_sway.core.species.species import typical_root_stiffness as typical_root_stiffness
    from tree_sway.core.species.wood import Species as Species
    from tree_sway.core.species.wood import WOOD_SPREAD as WOOD_SPREAD
else:
    __getattr__, __dir__, __all__ = face(__name__)
