# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Making of simulators by the name of the model; modules of a model are loaded when needed."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, TYPE_CHECKING

from tree_sway.core.model import ModelCache, PREPARED, SwayModel
from tree_sway.core.run import SwaySimulator
from tree_sway.core.settings import Settings, settings_with, USUAL
from tree_sway.core.species import Species
from tree_sway.core.tree import Tree
from tree_sway.errors import ParameterError

if TYPE_CHECKING:
    from tree_sway.core.setup import TreeReductions
    from tree_sway.core.tree import GrownTree


def make_simulator(
    tree: Tree | GrownTree | SwayModel,
    species: Species | None = None,
    settings: Settings | None = None,
    *,
    tolerance: float = 0.005,
    budget: float = 0.0,
    cache: ModelCache | None = PREPARED,
    **changes: Any,
) -> SwaySimulator:
    """
    Make a simulator of a tree.

    Parameters
    ----------
    tree
        Tree, with or without its species; or its prepared model, which has its own settings.
    species
        Species for wood, damping and drag; the tree's own if None.
    settings
        Settings, for any model.
    tolerance
        Largest error of the tips in [m] for ``auto``.
    budget
        Largest cost of a frame in [us] for ``auto``, with priority over the tolerance; 0 for no
        limit.
    cache
        Where prepared models are found again; nowhere if None.
    **changes
        Fields of the settings.

    Raises
    ------
    ParameterError
        An unknown model, a setting out of its range, or an argument of a wrong type.
    TreeError
        A tree that buckles under its own weight.

    """
    if isinstance(tree, SwayModel):
        if species is not None or settings is not None or changes:
            what = 'a prepared model with another species or other settings'
            raise ParameterError(what, where=tree.tree.name, cure='prepare the tree again')
        return SwaySimulator(tree)
    # The set-up is most of the program: a prepared model is stepped without loading it.
    from tree_sway.core.setup import TreeReductions
    from tree_sway.core.tree import tree_and_species

    bare, wood = tree_and_species(tree, species)
    chosen = settings_with(settings, changes)
    how = {'tolerance': tolerance, 'budget': budget} if chosen.model == 'auto' else {}
    reductions = TreeReductions(bare, wood, solved(chosen))
    return simulator_of(reductions, cache=cache, **how)


def solved(settings: Settings) -> Settings:
    """Return the settings of the model that is solved: ``auto`` chooses among `USUAL`."""
    return replace(settings, model=USUAL) if settings.model == 'auto' else settings


def simulator_of(
    reductions: TreeReductions, *, cache: ModelCache | None = None, **auto: float
) -> SwaySimulator:
    """
    Make a simulator of a tree whose reductions are needed otherwise too.

    With the tolerance and the budget of ``auto``, it chooses its coordinates.
    """
    from tree_sway.core.setup import prepared

    model = prepared(reductions, cache=cache)
    if not auto:
        return SwaySimulator(model)
    from tree_sway.installed_models import chooser_of

    made: SwaySimulator = chooser_of('auto')(model, **auto)
    return made
