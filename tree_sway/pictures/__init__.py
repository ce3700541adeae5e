# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Pictures and films of trees and of their sway, with matplotlib.

`figure_in_wind` draws trees, `animate_poses` makes a film, ``plots`` draws wind, sway, strength
and studies, and `save_figure` writes a figure to a file. Nothing that steps or streams needs this
house.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.pictures.animation import animate_poses as animate_poses
    from tree_sway.pictures.animation import write_pictures as write_pictures
    from tree_sway.pictures.pictures import figure_in_wind as figure_in_wind
    from tree_sway.pictures.plotting import new_figure as new_figure
    from tree_sway.pictures.plotting import save_figure as save_figure
    from tree_sway.pictures.tree_drawing import draw_trees as draw_trees
    from tree_sway.pictures.tree_drawing import limits_around as limits_around
else:
    __getattr__, __dir__, __all__ = face(__name__)
