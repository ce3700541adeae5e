# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The species that there are: a new one is one row of ``species.csv``, for all of the program.

Modulus and density are of green wood: ForestGALES species tables, the BIOMASS wood density table
and the field table of Jackson et al. (2019). Maple (mean of sugar and red maple), lime (American
basswood), willow (black willow), poplar (eastern cottonwood), larch (western larch), fir (mean of
grand and Pacific silver fir), alder (red alder), cherry (black cherry), plane (American sycamore)
and eucalyptus (jarrah) are by tables 5-3 and 5-5 of the Wood Handbook (Forest Products Laboratory,
2010), their density the basic one times one plus the moisture of its table 4-1: other members of a
genus may differ by a quarter. Drag in leaf is C U^-N between 4 and 20 m/s: Mayhead (1973) for
conifers, Vollsinger et al. (2005) for broadleaves. Where no crown was measured, a broadleaf has
the mean of the three measured ones and a conifer the drag of spruce. Entries marked as estimates
have no measurement behind them. Where leaves come from is said in `leaf_traits`. Names
are what species are called besides by their keys: genus, Latin and other names, abbreviations.
"""

from __future__ import annotations

from dataclasses import fields
from typing import Any

from tree_sway.core.tree.leaf_traits import LeafTraits
from tree_sway.core.tree.wood import Species
from tree_sway.tables import table_beside

_ROWS = {row['key']: row for row in table_beside(__file__, 'species.csv')}

NAMES: dict[str, list[str]] = {key: row.pop('names').split(', ') for key, row in _ROWS.items()}
"""Other names of every species, by its key."""


def _species(row: dict[str, Any]) -> Species:
    leaves = LeafTraits(**{each.name: row.pop(each.name) for each in fields(LeafTraits)})
    return Species(**row, leaves=leaves)


SPECIES = {key: _species(row) for key, row in _ROWS.items()}
"""Every species by its key."""
