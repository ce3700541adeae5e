# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
How many fields of rotation a branch may have, and what its records have room for.

A plain branch has one pair. An enriched one has further pairs, fields by rotation about its chord
(turns) and fields of subtrees that swing against each other.
"""

from tree_sway.core.model import MAX_COORDINATES

PLAIN_PAIRS, PLAIN_TURNS = 1, 0
"""Pairs and turns of a plain branch."""

ENRICHED_PAIRS = 3
"""Pairs of an enriched branch: the static ones, then by inertia."""

STEM_TURNS, BRANCH_TURNS = 3, 1
"""Turns of an enriched stem, and of any other enriched branch."""

LIMP_PAIRS = 2
"""Pairs of a limp branch that its own stiffness shapes."""

SMALL_TREE = 12
"""Largest number of branches of a small tree, which gets more pairs."""

SLENDER_BEAMS = (40.0, 60.0)
"""
Length over diameter of all branches of a small tree, least and most: short waves need slender
beams, and fling limp ones in a storm.
"""

MOST_OPPOSED = 3
"""Fields of subtrees against each other that a branch may always have."""

STEM_PAIRS_OF_SMALL = (MAX_COORDINATES - BRANCH_TURNS - MOST_OPPOSED) // 2
BRANCH_PAIRS_OF_SMALL = 5
"""Pairs of the stem and of each other branch of a small tree."""
