# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Recordings of a swaying tree: rosbag2 bags, MCAP or sqlite3, written and read without ROS."""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.files.recording.bag_writer import BagWriter as BagWriter
    from tree_sway.files.recording.bag_writer import FORMATS as FORMATS
else:
    __getattr__, __dir__, __all__ = face(__name__)
