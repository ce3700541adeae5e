# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Records of motion sensors on real trees, as tables and bags, and what they told over days."""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.files.json_values import flat as flat
    from tree_sway.files.json_values import unit_beside as unit_beside
    from tree_sway.files.motion.imu_bag import read_imu_bag as read_imu_bag
    from tree_sway.files.motion.motion_file import read_motion as read_motion
    from tree_sway.files.motion.motion_record import AXES as AXES
    from tree_sway.files.motion.motion_record import MotionRecord as MotionRecord
    from tree_sway.files.motion.strain_table import read_strain as read_strain
    from tree_sway.files.motion.tree_history import refuse_no_history as refuse_no_history
    from tree_sway.files.motion.tree_history import TreeHistory as TreeHistory
    from tree_sway.files.motion.tree_record import RecordedSensor as RecordedSensor
    from tree_sway.files.motion.tree_record import SHEET as SHEET
    from tree_sway.files.motion.tree_record import TreeRecord as TreeRecord
    from tree_sway.files.motion.tree_record import write_tree_record as write_tree_record
else:
    __getattr__, __dir__, __all__ = face(__name__)
