# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Sensors on the real tree: they correct the virtual one, and tell what it is like.

In the order of a sample: `motion_sensor` checks and keeps it, `sensor_track` and `alignment` find
how the sensor is mounted, `sensor_readings` is what it measures beyond the model, and a
steady-state Kalman filter (`unknown_motion`, `gain_design`, `steady_filter`, `observer`) moves the
coordinates. `ObservedTree` is the simulator in which this happens, `observed_scene` makes it from
a scene, `members` says how sure it is (the band). `tree_fit` and `running_fit` learn stiffness and
damping, `sway_watch` tells when a tree sways differently than it did.

``doc/motion_sensors.md`` says what is promised, and what it was measured on.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.twin.alignment import align as align
    from tree_sway.twin.alignment import Alignment as Alignment
    from tree_sway.twin.alignment import GRAVITY as GRAVITY
    from tree_sway.twin.learned_tree import LearnedTree as LearnedTree
    from tree_sway.twin.members import uncertainty_of as uncertainty_of
    from tree_sway.twin.members import uncorrelated_draws as uncorrelated_draws
    from tree_sway.twin.observed_tree import ObservedTree as ObservedTree
    from tree_sway.twin.scene_with_sensors import observed_scene as observed_scene
    from tree_sway.twin.sensor_advice import advised_places as advised_places
    from tree_sway.twin.sensor_place import as_orientation as as_orientation
    from tree_sway.twin.sensor_place import bend_at as bend_at
    from tree_sway.twin.sensor_place import place_on as place_on
    from tree_sway.twin.sensor_place import SensorPlace as SensorPlace
    from tree_sway.twin.sensor_place import strain_of as strain_of
    from tree_sway.twin.sensor_report import sensor_reports as sensor_reports
    from tree_sway.twin.sway_watch import SwayChange as SwayChange
    from tree_sway.twin.tree_fit import TreeFit as TreeFit
else:
    __getattr__, __dir__, __all__ = face(__name__)
