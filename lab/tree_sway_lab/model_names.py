# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Models by name, as commands of the laboratory take them: ``default``, ``60``, ``full``."""

from __future__ import annotations

from dataclasses import replace

from tree_sway.core.run import SwaySimulator
from tree_sway.core.scene import make_simulator
from tree_sway.core.settings import Settings
from tree_sway.core.species import Species
from tree_sway.core.tree import Tree


def settings_called(model: str, settings: Settings) -> Settings:
    """
    Return settings with a model.

    Parameters
    ----------
    model
        ``default``, a number of coordinates, or the name of a model: ``60``, ``branch``, ``full``.
    settings
        All else.

    Raises
    ------
    ParameterError
        If there is no such model.

    """
    if model == 'default':
        return settings
    return replace(settings, model=int(model) if model.isdecimal() else model)


def simulator_called(
    model: str, tree: Tree, species: Species, settings: Settings
) -> SwaySimulator:
    """Make a simulator on a model, as of `settings_called`."""
    return make_simulator(tree, species, settings_called(model, settings))
