# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The command line ``tree-sway``: one module per command.

They convert arguments to text or a file. Computations are in rooms below.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.commands.arguments import add_leaves_argument as add_leaves_argument
    from tree_sway.commands.arguments import add_model_argument as add_model_argument
    from tree_sway.commands.arguments import add_tree_arguments as add_tree_arguments
    from tree_sway.commands.arguments import chosen_leaves as chosen_leaves
    from tree_sway.commands.arguments import opened_scene as opened_scene
    from tree_sway.commands.arguments import opened_tree as opened_tree
    from tree_sway.commands.arguments import refuse_overwriting as refuse_overwriting
    from tree_sway.commands.cli import COMMANDS as COMMANDS
    from tree_sway.commands.command import Command as Command
    from tree_sway.commands.command import commands_beside as commands_beside
    from tree_sway.commands.ending import Ending as Ending
    from tree_sway.commands.ending import LONGEST as LONGEST
    from tree_sway.commands.exposure import add_exposure_arguments as add_exposure_arguments
    from tree_sway.commands.exposure import (
        refuse_spacing_in_the_open as refuse_spacing_in_the_open,
    )
    from tree_sway.commands.exposure import turbulence_of as turbulence_of
    from tree_sway.commands.live_motion_arguments import (
        add_live_motion_arguments as add_live_motion_arguments,
    )
    from tree_sway.commands.motion_arguments import add_motion_arguments as add_motion_arguments
    from tree_sway.commands.motion_arguments import placed_motion as placed_motion
    from tree_sway.commands.page_arguments import add_page_arguments as add_page_arguments
    from tree_sway.commands.page_arguments import page_settings as page_settings
    from tree_sway.commands.page_arguments import print_address as print_address
    from tree_sway.commands.progress import bar as bar
    from tree_sway.commands.progress import waiting as waiting
    from tree_sway.commands.row_file import RowFile as RowFile
    from tree_sway.commands.sensor_arguments import add_sensor_argument as add_sensor_argument
    from tree_sway.commands.tree_recording import record_tree as record_tree
    from tree_sway.commands.wind_arguments import add_sway_arguments as add_sway_arguments
    from tree_sway.commands.wind_arguments import add_wind_arguments as add_wind_arguments
    from tree_sway.commands.wind_arguments import opened_record as opened_record
    from tree_sway.commands.wind_arguments import refuse_unused_wind as refuse_unused_wind
    from tree_sway.commands.wind_arguments import simulated_speed as simulated_speed
    from tree_sway.commands.wind_recording import record_wind as record_wind
else:
    __getattr__, __dir__, __all__ = face(__name__)
