# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
State estimation: motion sensors on the real tree correct the virtual one.

A steady-state Kalman filter corrects the motion that the wind alone would cause by what sensors on
the tree measure.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.twin.alignment import align as align
    from tree_sway.twin.alignment import Alignment as Alignment
    from tree_sway.twin.alignment import GRAVITY as GRAVITY
    from tree_sway.twin.identification.calibration import calibrate as calibrate
    from tree_sway.twin.identification.calibration import Calibration as Calibration
    from tree_sway.twin.identification.free_decay import FreeDecay as FreeDecay
    from tree_sway.twin.identification.measured_sway import estimate_sway as estimate_sway
    from tree_sway.twin.learned_tree import LearnedTree as LearnedTree
    from tree_sway.twin.members import uncertainty_of as uncertainty_of
    from tree_sway.twin.members import uncorrelated_draws as uncorrelated_draws
    from tree_sway.twin.observed_tree import ObservedTree as ObservedTree
    from tree_sway.twin.scene_with_sensors import observed_scene as observed_scene
    from tree_sway.twin.sensor_advice import advised_places as advised_places
    from tree_sway.twin.sensor_place import place_on as place_on
    from tree_sway.twin.sensor_place import SensorPlace as SensorPlace
    from tree_sway.twin.sensor_report import sensor_reports as sensor_reports
    from tree_sway.twin.smoothed_motion import LATE_STEPS as LATE_STEPS
    from tree_sway.twin.tree_fit import TreeFit as TreeFit
else:
    __getattr__, __dir__, __all__ = face(__name__)
