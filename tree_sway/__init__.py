# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Trees that sway in measured wind: a reduced-order model of a tree, its files, its page. No ROS.

The names below are all that most users need. Each is imported at its first use, so that ``import
tree_sway`` itself costs nothing.

Examples
--------
>>> import tree_sway as sway
>>> sway.simulate("oak", "canopy", seconds=10).plot()
>>> tree = sway.open_tree("goldcrest")
>>> record = sway.simulate(tree, sway.read_wind("wind.csv"))

"""

from __future__ import annotations

from typing import TYPE_CHECKING

from tree_sway.faces import face

__version__ = '0.1.0'

if TYPE_CHECKING:
    from tree_sway.by_name import simulate as simulate
    from tree_sway.core.model import SwayModel as SwayModel
    from tree_sway.core.scene import make_simulator as make_simulator
    from tree_sway.core.scene import PlacedTree as PlacedTree
    from tree_sway.core.scene import Scene as Scene
    from tree_sway.core.scene import Simulator as Simulator
    from tree_sway.core.settings import Settings as Settings
    from tree_sway.core.setup import prepare as prepare
    from tree_sway.core.species import Species as Species
    from tree_sway.core.species import species_named as species_named
    from tree_sway.core.tree import Tree as Tree
    from tree_sway.core.tree import tree_from_segments as tree_from_segments
    from tree_sway.core.wind import simulate_turbulence as simulate_turbulence
    from tree_sway.core.wind import WindAverage as WindAverage
    from tree_sway.errors import TreeSwayError as TreeSwayError
    from tree_sway.files.export import write_tree as write_tree
    from tree_sway.files.models import read_model as read_model
    from tree_sway.files.models import write_model as write_model
    from tree_sway.files.trees import open_scene as open_scene
    from tree_sway.files.trees import open_tree as open_tree
    from tree_sway.files.wind import read_wind as read_wind
    from tree_sway.growth import grow as grow
    from tree_sway.identification import calibrate as calibrate
    from tree_sway.simulation import SwayRecord as SwayRecord
    from tree_sway.stream import StreamClient as StreamClient
else:
    __getattr__, __dir__, __all__ = face(__name__)
    __all__ = sorted((*__all__, '__version__'))
