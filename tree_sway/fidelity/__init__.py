# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
How many coordinates a tree needs: the model ``auto``.

`WindClimate` is the mean and spectrum of the load of what blows, which `ClimateTracker` keeps;
`estimate` finds by it error and cost of every number of coordinates before a step is taken;
`AdaptiveSimulator` takes the smallest number that is good enough, and changes it while the tree
sways without a jump. `set_demand` says what is good enough: an error that nobody sees, a time per
frame.

The core finds `AdaptiveSimulator` by an entry point (`tree_sway.installed_models`).
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.fidelity.adaptive import AdaptiveSimulator as AdaptiveSimulator
    from tree_sway.fidelity.adaptive import REVIEW as REVIEW
    from tree_sway.fidelity.climate import WindClimate as WindClimate
    from tree_sway.fidelity.demand import adaptive_among as adaptive_among
    from tree_sway.fidelity.demand import measure_costs as measure_costs
    from tree_sway.fidelity.demand import set_demand as set_demand
    from tree_sway.fidelity.estimate import DIAL as DIAL
    from tree_sway.fidelity.estimate import dialled as dialled
else:
    __getattr__, __dir__, __all__ = face(__name__)
