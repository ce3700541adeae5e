# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Many trees in many winds: studies, and the wind that each tree of an inventory stands.

``tree-sway study`` computes every tree in every wind with every combination of settings;
``tree-sway risk`` the critical wind of each tree of a list. A plan becomes cases, computed once
each in any order, on the cores of a machine or a Dask cluster, with workers that may die. Live
programs do not need this house.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.forest.risk import risk_work as risk_work
    from tree_sway.forest.risk import RiskWork as RiskWork
    from tree_sway.forest.risk import rows_of_kind as rows_of_kind
    from tree_sway.forest.risk_kind import compute_kind as compute_kind
    from tree_sway.forest.risk_kind import KindResult as KindResult
else:
    __getattr__, __dir__, __all__ = face(__name__)
