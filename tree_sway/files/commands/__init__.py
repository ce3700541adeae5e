# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Commands of files, and the arguments that most commands share: a tree, a wind, an output."""

from typing import TYPE_CHECKING

from tree_sway.commands import commands_of
from tree_sway.faces import face

COMMANDS = commands_of(__name__)

if TYPE_CHECKING:
    from tree_sway.files.commands.arguments import add_exact_argument as add_exact_argument
    from tree_sway.files.commands.arguments import add_leaves_argument as add_leaves_argument
    from tree_sway.files.commands.arguments import add_model_argument as add_model_argument
    from tree_sway.files.commands.arguments import add_output_arguments as add_output_arguments
    from tree_sway.files.commands.arguments import add_tree_arguments as add_tree_arguments
    from tree_sway.files.commands.arguments import chosen_leaves as chosen_leaves
    from tree_sway.files.commands.arguments import opened_scene as opened_scene
    from tree_sway.files.commands.arguments import opened_tree as opened_tree
    from tree_sway.files.commands.arguments import OUTPUT_HELP as OUTPUT_HELP
    from tree_sway.files.commands.arguments import output_path as output_path
    from tree_sway.files.commands.arguments import say_warnings as say_warnings
    from tree_sway.files.commands.arguments import what_was_written as what_was_written
    from tree_sway.files.commands.arguments import write_tree_file as write_tree_file
    from tree_sway.files.commands.moments import at_moments as at_moments
    from tree_sway.files.commands.moments import frame_times as frame_times
    from tree_sway.files.commands.typed_names import source_name as source_name
    from tree_sway.files.commands.wind_arguments import (
        add_distance_arguments as add_distance_arguments,
    )
    from tree_sway.files.commands.wind_arguments import add_sway_arguments as add_sway_arguments
    from tree_sway.files.commands.wind_arguments import add_wind_arguments as add_wind_arguments
    from tree_sway.files.commands.wind_arguments import distance_settings as distance_settings
    from tree_sway.files.commands.wind_arguments import opened_record as opened_record
    from tree_sway.files.commands.wind_arguments import opened_wind as opened_wind
    from tree_sway.files.commands.wind_arguments import refuse_unused_wind as refuse_unused_wind
    from tree_sway.files.commands.wind_arguments import simulated_speed as simulated_speed
else:
    __getattr__, __dir__, __all__ = face(__name__)
