# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
From a tree to its `SwayModel`: found in a cache, or made (`make_model`).

To make it takes a fraction of a second for a small tree, and some seconds for one of 10,000
branches; a cache stores the result.
"""

from __future__ import annotations

from contextlib import suppress
from typing import Any

from tree_sway.core.model import ModelCache, PREPARED, SwayModel
from tree_sway.core.settings import Settings, settings_with
from tree_sway.core.setup.reductions import TreeReductions
from tree_sway.core.species import Species
from tree_sway.core.tree import GrownTree, Tree, tree_and_species
from tree_sway.core.tree_state import digest_of
from tree_sway.errors import FormatError, ParameterError


def prepare(
    tree: Tree | GrownTree,
    species: Species | None = None,
    settings: Settings | None = None,
    *,
    cache: ModelCache | None = PREPARED,
    **changes: Any,
) -> SwayModel:
    """
    Prepare the model of a tree.

    Parameters
    ----------
    tree
        Tree, with or without its species.
    species
        Species for wood, damping and drag; the tree's own if None.
    settings, **changes
        Settings, and fields of them; the model ``auto`` needs the `USUAL` number of coordinates.
    cache
        Where models are found again; nowhere if None.

    Raises
    ------
    ParameterError
        A setting out of its range, or a model that is not solved by itself.
    TreeError
        A tree that buckles under its own weight, or a branch without mass.

    """
    bare, wood = tree_and_species(tree, species)
    return prepared(TreeReductions(bare, wood, settings_with(settings, changes)), cache=cache)


def prepared(reductions: TreeReductions, cache: ModelCache | None = None) -> SwayModel:
    """
    Prepare the model of a reduced tree.

    The model is read from the cache, or made and written there; both have the same bits.
    """
    settings = reductions.settings
    if settings.model == 'auto':
        raise ParameterError(
            "model 'auto' has no oscillators",
            where='model',
            cure='make it by make_simulator, or give a number of coordinates',
        )
    tree = reductions.tree
    species = reductions.species
    digest = digest_of(tree, species, settings)
    found = None if cache is None else cache.read(digest)
    if found is not None:
        with suppress(FormatError):  # of an older version, or damaged: it is made again
            stored = SwayModel.of_arrays(found, tree, species, settings)
            if not stored.is_isolated:
                reductions.frequencies = stored.natural_frequencies
            return stored
    from tree_sway.core.setup.make_model import make_model  # a stored model does not need it

    made = make_model(reductions)
    if cache is not None:
        cache.write(digest, made.arrays())
    return made
