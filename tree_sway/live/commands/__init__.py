# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Arguments of live instruments, and records of them."""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.live.commands.live_motion_arguments import (
        add_live_motion_arguments as add_live_motion_arguments,
    )
    from tree_sway.live.commands.live_motion_arguments import say_motion as say_motion
    from tree_sway.live.commands.live_motion_arguments import sensing as sensing
    from tree_sway.live.commands.sensor_arguments import add_sensor_argument as add_sensor_argument
    from tree_sway.live.commands.sensor_arguments import listening as listening
    from tree_sway.live.commands.sensor_arguments import live_record as live_record
    from tree_sway.live.commands.sensor_places import add_place_argument as add_place_argument
    from tree_sway.live.commands.sensor_places import sensors_and_places as sensors_and_places
    from tree_sway.live.commands.tree_recording import record_tree as record_tree
    from tree_sway.live.commands.wind_recording import record_wind as record_wind
else:
    __getattr__, __dir__, __all__ = face(__name__)
