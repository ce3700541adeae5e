# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Making of simulators by the name of the model; modules of a model are loaded when needed."""

from __future__ import annotations

from typing import Any

from tree_sway.cache.model_cache import SET_UPS, SetUpFiles
from tree_sway.core.model.settings import Settings, settings_with
from tree_sway.core.run.simulator import SwaySimulator
from tree_sway.core.tree.grown_tree import GrownTree, tree_and_species
from tree_sway.core.tree.species import Species
from tree_sway.core.tree.tree import Tree


def make_simulator(
    tree: Tree | GrownTree,
    species: Species | None = None,
    settings: Settings | None = None,
    *,
    tolerance: float = 0.005,
    budget: float = 0.0,
    cache: SetUpFiles | None = SET_UPS,
    **changes: Any,
) -> SwaySimulator:
    """
    Make a simulator of a tree.

    Parameters
    ----------
    tree, species, settings
        Arguments of `SwaySimulator`, for any model.
    tolerance
        Largest error of the tips in [m] for ``auto``.
    budget
        Largest cost of a frame in [us] for ``auto``, with priority over the tolerance; 0 for no
        limit.
    cache
        Where set-ups are written and found again, on disk if left out; nowhere if None.
    **changes
        Fields of the settings.

    Raises
    ------
    ParameterError
        An unknown model, a setting out of its range, or an argument of a wrong type.
    TreeError
        A tree that buckles under its own weight.

    """
    chosen = settings_with(settings, changes)
    bare, wood = tree_and_species(tree, species)
    if chosen.model == 'auto':
        from tree_sway.core.fidelity.adaptive import AdaptiveSimulator

        asked = {'tolerance': tolerance, 'budget': budget}
        return AdaptiveSimulator(bare, wood, chosen, **asked, cache=cache)
    return SwaySimulator(bare, wood, chosen, cache=cache)
