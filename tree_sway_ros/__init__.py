# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Trees that sway as the wind blows: a reduced-order model of a tree and the ROS 2 nodes around it.

The names below are all that most users need. Each is imported when it is first asked for, so that
``import tree_sway_ros`` itself costs nothing.

Examples
--------
>>> import tree_sway_ros as sway
>>> tree = sway.open_tree("goldcrest")
>>> record = sway.simulate(tree, sway.read_wind("wind.csv"))

"""

from __future__ import annotations

from importlib import import_module
from typing import Any, TYPE_CHECKING

if TYPE_CHECKING:
    from tree_sway_ros.core.growth.builtin import BUILTIN_TREES
    from tree_sway_ros.core.growth.grow import grow
    from tree_sway_ros.core.identification.calibration import calibrate
    from tree_sway_ros.core.scene.forest import Forest
    from tree_sway_ros.core.scene.make import make_simulator
    from tree_sway_ros.core.scene.placed_tree import PlacedTree
    from tree_sway_ros.core.scene.simulate import simulate
    from tree_sway_ros.core.scene.sway_record import SwayRecord
    from tree_sway_ros.core.simulator.protocol import Simulator
    from tree_sway_ros.core.simulator.settings import Settings
    from tree_sway_ros.core.tree.species import Species, species_named
    from tree_sway_ros.core.tree.tree import Tree
    from tree_sway_ros.core.wind.averaging import WindAverage
    from tree_sway_ros.core.wind.convention import WindConvention
    from tree_sway_ros.core.wind.height_profile import WindProfile
    from tree_sway_ros.core.wind.simulated.turbulence import simulate_turbulence
    from tree_sway_ros.errors import TreeSwayError
    from tree_sway_ros.files.export.tree_export import write_tree
    from tree_sway_ros.files.trees.source import open_scene, open_tree
    from tree_sway_ros.files.wind.wind_file import read_wind

__version__ = '0.1.0'

_MODULES = {
    'core.growth.builtin': ('BUILTIN_TREES',),
    'core.growth.grow': ('grow',),
    'core.identification.calibration': ('calibrate',),
    'core.scene.forest': ('Forest',),
    'core.scene.make': ('make_simulator',),
    'core.scene.placed_tree': ('PlacedTree',),
    'core.scene.simulate': ('simulate',),
    'core.scene.sway_record': ('SwayRecord',),
    'core.simulator.protocol': ('Simulator',),
    'core.simulator.settings': ('Settings',),
    'core.tree.species': ('Species', 'species_named'),
    'core.tree.tree': ('Tree',),
    'core.wind.averaging': ('WindAverage',),
    'core.wind.convention': ('WindConvention',),
    'core.wind.height_profile': ('WindProfile',),
    'core.wind.simulated.turbulence': ('simulate_turbulence',),
    'errors': ('TreeSwayError',),
    'files.export.tree_export': ('write_tree',),
    'files.trees.source': ('open_scene', 'open_tree'),
    'files.wind.wind_file': ('read_wind',),
}
_HOMES = {name: module for module, names in _MODULES.items() for name in names}

__all__ = [
    'BUILTIN_TREES',
    'Forest',
    'PlacedTree',
    'Settings',
    'Simulator',
    'Species',
    'SwayRecord',
    'Tree',
    'TreeSwayError',
    'WindAverage',
    'WindConvention',
    'WindProfile',
    '__version__',
    'calibrate',
    'grow',
    'make_simulator',
    'open_scene',
    'open_tree',
    'read_wind',
    'simulate',
    'simulate_turbulence',
    'species_named',
    'write_tree',
]


def __getattr__(name: str) -> Any:
    """Import a name from where it lives."""
    if name not in _HOMES:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    value = getattr(import_module(f'{__name__}.{_HOMES[name]}'), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """Return what may be asked for."""
    return sorted({*globals(), *__all__})
