# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The stream of a scene: description, frames, tables, and their clients.

A description is sent once, then each frame is complete by itself: the coordinates of each tree, or
the wind alone for receivers that solve. `SceneState` makes them, `StreamClient` receives them over
a connection that is restored, `placing` gives poses by the native core, `ControlPanel` is what
viewers may change. Whatever arrives is checked before it is used. ``doc/streaming.md`` is the
specification.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.stream.check_description import Json as Json
    from tree_sway.stream.client import StreamClient as StreamClient
    from tree_sway.stream.controls import Control as Control
    from tree_sway.stream.controls import ControlPanel as ControlPanel
    from tree_sway.stream.controls import PAUSE_AND_RESET as PAUSE_AND_RESET
    from tree_sway.stream.controls import Refused as Refused
    from tree_sway.stream.controls import Value as Value
    from tree_sway.stream.protocol import decode_description as decode_description
    from tree_sway.stream.protocol import Description as Description
    from tree_sway.stream.protocol import encode_state as encode_state
    from tree_sway.stream.protocol import Frame as Frame
    from tree_sway.stream.protocol import FRAME_SIZE as FRAME_SIZE
    from tree_sway.stream.protocol import MAGIC as MAGIC
    from tree_sway.stream.protocol import part_of_frame as part_of_frame
    from tree_sway.stream.protocol import PAUSED as PAUSED
    from tree_sway.stream.protocol import WIND_LOST as WIND_LOST
    from tree_sway.stream.scene_state import SceneState as SceneState
    from tree_sway.stream.tables import why_no_tables as why_no_tables
else:
    __getattr__, __dir__, __all__ = face(__name__)
