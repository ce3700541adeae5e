# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Live instruments: links over a network or a serial port, and what their messages mean.

``transports`` delivers messages as bytes and reconnects; ``sources`` has one file per kind of
source, which puts a transport and a reader together; the registry opens one by its address.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.live.camera.film import Film as Film
    from tree_sway.live.camera.film import is_camera as is_camera
    from tree_sway.live.camera.film import LiveFilm as LiveFilm
    from tree_sway.live.camera.point_tracker import PointTracker as PointTracker
    from tree_sway.live.live_wind import LiveWind as LiveWind
    from tree_sway.live.motion.live_motion import LiveMotion as LiveMotion
    from tree_sway.live.motion.live_motion import MotionSample as MotionSample
    from tree_sway.live.motion.motion_feed import MotionFeed as MotionFeed
    from tree_sway.live.motion.motion_feed import PlacedSensor as PlacedSensor
    from tree_sway.live.motion.motion_registry import open_motion as open_motion
    from tree_sway.live.readers.instrument_lines import InstrumentLines as InstrumentLines
    from tree_sway.live.reading import WindReading as WindReading
    from tree_sway.live.registry import open_source as open_source
else:
    __getattr__, __dir__, __all__ = face(__name__)
