# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Error and cost of every number of coordinates, and the choice among them.

Estimates are made before a step is taken. The models themselves are in rooms below.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.core.fidelity.adaptive import AdaptiveSimulator as AdaptiveSimulator
    from tree_sway.core.fidelity.adaptive import REVIEW as REVIEW
    from tree_sway.core.fidelity.estimate import DIAL as DIAL
    from tree_sway.core.fidelity.estimate import dialled as dialled
else:
    __getattr__, __dir__, __all__ = face(__name__)
