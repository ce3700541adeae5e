# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Trees that sway in measured wind: a reduced-order model of a tree, its files, its page. No ROS.

The names below are all that most users need. Each is imported at its first use, so that ``import
tree_sway`` itself costs nothing.

Examples
--------
>>> import tree_sway as sway
>>> tree = sway.open_tree("goldcrest")
>>> record = sway.simulate(tree, sway.read_wind("wind.csv"))

"""

from __future__ import annotations

from importlib import import_module
from typing import Any, TYPE_CHECKING

if TYPE_CHECKING:
    from tree_sway.core.model.settings import Settings as Settings
    from tree_sway.core.model.sway_model import SwayModel as SwayModel
    from tree_sway.core.scene.make import make_simulator as make_simulator
    from tree_sway.core.scene.placed_tree import PlacedTree as PlacedTree
    from tree_sway.core.scene.scene import Scene as Scene
    from tree_sway.core.scene.scene_simulator import Simulator as Simulator
    from tree_sway.core.setup.prepare import prepare as prepare
    from tree_sway.core.tree.building import tree_from_segments as tree_from_segments
    from tree_sway.core.tree.species import species_named as species_named
    from tree_sway.core.tree.tree import Tree as Tree
    from tree_sway.core.tree.wood import Species as Species
    from tree_sway.core.wind.averaging import WindAverage as WindAverage
    from tree_sway.core.wind.simulated.turbulence import simulate_turbulence as simulate_turbulence
    from tree_sway.errors import TreeSwayError as TreeSwayError
    from tree_sway.files.export.tree_export import write_tree as write_tree
    from tree_sway.files.models.model_file import read_model as read_model
    from tree_sway.files.models.model_writer import write_model as write_model
    from tree_sway.files.trees.source import open_scene as open_scene
    from tree_sway.files.trees.source import open_tree as open_tree
    from tree_sway.files.wind.wind_file import read_wind as read_wind
    from tree_sway.growth.grow import grow as grow
    from tree_sway.simulation.simulate import simulate as simulate
    from tree_sway.simulation.sway_record import SwayRecord as SwayRecord
    from tree_sway.stream.client import StreamClient as StreamClient
    from tree_sway.twin.identification.calibration import calibrate as calibrate

__version__ = '0.1.0'

_HOMES = {
    'PlacedTree': 'core.scene.placed_tree', 'Scene': 'core.scene.scene',
    'Settings': 'core.model.settings', 'Simulator': 'core.scene.scene_simulator',
    'Species': 'core.tree.wood', 'StreamClient': 'stream.client',
    'SwayModel': 'core.model.sway_model', 'SwayRecord': 'simulation.sway_record',
    'Tree': 'core.tree.tree', 'TreeSwayError': 'errors',
    'WindAverage': 'core.wind.averaging', 'calibrate': 'twin.identification.calibration',
    'grow': 'growth.grow', 'make_simulator': 'core.scene.make',
    'prepare': 'core.setup.prepare', 'read_model': 'files.models.model_file',
    'write_model': 'files.models.model_writer', 'open_scene': 'files.trees.source',
    'open_tree': 'files.trees.source',
    'read_wind': 'files.wind.wind_file', 'simulate': 'simulation.simulate',
    'simulate_turbulence': 'core.wind.simulated.turbulence', 'species_named': 'core.tree.species',
    'tree_from_segments': 'core.tree.building', 'write_tree': 'files.export.tree_export',
}  # fmt: skip
"""Module that each public name lives in."""

__all__ = sorted((*_HOMES, '__version__'))


def __getattr__(name: str) -> Any:
    """Import a name from where it lives."""
    if name not in _HOMES:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    value = getattr(import_module(f'{__name__}.{_HOMES[name]}'), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """Return the public names."""
    return sorted({*globals(), *__all__})
