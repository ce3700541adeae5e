# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Many trees in many winds with many settings, offline: ``tree-sway study STUDY.yaml``.

A plan becomes cases; each case is computed independently, in any process and order, once. Live
programs do not import this room.

"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.forest.risk import risk_work as risk_work
    from tree_sway.forest.risk import Row as Row
    from tree_sway.forest.risk import rows_of_kind as rows_of_kind
    from tree_sway.forest.risk_kind import compute_kind as compute_kind
    from tree_sway.forest.runner import cores as cores
else:
    __getattr__, __dir__, __all__ = face(__name__)
