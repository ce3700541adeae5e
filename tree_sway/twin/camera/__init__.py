# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A camera that films the real tree moves the virtual one.

Where the camera stands follows from a few clicked points; points on limbs that a tracker follows
are matched to segments, and a Kalman filter of the model's coordinates follows them. Pictures are
no concern of this room: it takes positions in them.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.twin.camera.camera_pose import camera_of_clicks as camera_of_clicks
    from tree_sway.twin.camera.camera_pose import Click as Click
    from tree_sway.twin.camera.clicked_points import told_by as told_by
    from tree_sway.twin.camera.filmed_tree import FilmedMotion as FilmedMotion
    from tree_sway.twin.camera.filmed_tree import FilmedTree as FilmedTree
    from tree_sway.twin.camera.limb_points import drawn_wood as drawn_wood
    from tree_sway.twin.camera.limb_points import DrawnWood as DrawnWood
    from tree_sway.twin.camera.limb_points import matched_points as matched_points
    from tree_sway.twin.camera.pinhole import Camera as Camera
    from tree_sway.twin.camera.pinhole import looking as looking
else:
    __getattr__, __dir__, __all__ = face(__name__)
