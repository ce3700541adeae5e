# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Simulations of trees and winds by their names, for a notebook."""

from __future__ import annotations

from inspect import signature
from pathlib import Path
from typing import Any
import warnings

from numpy.typing import ArrayLike

from tree_sway.core.settings import Settings
from tree_sway.core.species import species_keys
from tree_sway.core.tree import GrownTree, oddities, refuse_implausible, Tree, tree_and_species
from tree_sway.errors import nearest, ParameterError
from tree_sway.files.trees import open_tree
from tree_sway.files.wind import read_wind
from tree_sway.growth import BUILTIN_TREES, grow
from tree_sway.simulation import simulate as simulate_tree
from tree_sway.simulation import SwayRecord, WindSamples

_GROWN = frozenset(species_keys()) - frozenset(BUILTIN_TREES)
"""Names of species that stand for a tree."""

HEIGHT = 10.0
"""Height of a tree that is named by its species alone [m]."""


def simulate(
    tree: Tree | GrownTree | str | Path, wind: WindSamples | ArrayLike | str | Path, **options: Any
) -> SwayRecord:
    """
    Let a tree sway in a wind from rest.

    Parameters
    ----------
    tree
        A tree, a file of one, the name of a built-in one, or that of a species: a tree of it of
        `HEIGHT`, grown by the seed 0.
    wind
        A record, a file or the name of one, or the mean wind of each step in [m/s], (t, 3).
    **options
        Further arguments of `tree_sway.simulation.simulate`: ``rate``, ``seconds``, settings.

    Raises
    ------
    TreeSwayError
        An error of reading, or of `tree_sway.simulation.simulate`.

    """
    known = {**signature(simulate_tree).parameters, **Settings.__dataclass_fields__}
    del known['changes']
    for name in options.keys() - known:
        cure = nearest(name, known) or f'there are: {", ".join(known)}'
        raise ParameterError(f"unknown argument '{name}'", cure=cure)
    if isinstance(tree, str) and tree in _GROWN and not Path(tree).exists():
        tree = grow(tree, HEIGHT, name=f'{tree} of {HEIGHT:g} m')
    elif isinstance(tree, str | Path):
        tree = open_tree(tree)
    elif isinstance(tree, Tree):
        wood = tree_and_species(tree)
        refuse_implausible(*wood)
        for each in oddities(*wood):
            warnings.warn(each, stacklevel=2)
    if isinstance(wind, str | Path):
        wind = read_wind(wind)
    return simulate_tree(tree, wind, **options)
