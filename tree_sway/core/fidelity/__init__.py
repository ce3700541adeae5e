# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
How many coordinates a tree needs: the model ``auto``.

`estimate` finds error and cost of every number of coordinates before a step is taken, from the
spectrum of the wind that blows; `AdaptiveSimulator` takes the smallest number that is good enough,
and changes it while the tree sways without a jump.
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
