# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Pictures and films of trees and of their sway, with matplotlib.

`picture_in_wind`, `animate_poses`, `plot_wind_and_tip`, `plot_strength`, `plot_study`. Nothing
that steps or streams needs this house.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.pictures.animation import animate_poses as animate_poses
    from tree_sway.pictures.animation import check_film as check_film
    from tree_sway.pictures.animation import write_pictures as write_pictures
    from tree_sway.pictures.pictures import picture_in_wind as picture_in_wind
    from tree_sway.pictures.plots import plot_strength as plot_strength
    from tree_sway.pictures.plots import plot_study as plot_study
    from tree_sway.pictures.plots import plot_wind_and_tip as plot_wind_and_tip
    from tree_sway.pictures.plots import STUDY_COLUMNS as STUDY_COLUMNS
    from tree_sway.pictures.plotting import new_figure as new_figure
    from tree_sway.pictures.plotting import save_figure as save_figure
    from tree_sway.pictures.tree_drawing import draw_trees as draw_trees
    from tree_sway.pictures.tree_drawing import limits_around as limits_around
else:
    __getattr__, __dir__, __all__ = face(__name__)
