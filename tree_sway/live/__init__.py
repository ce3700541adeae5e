# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Live instruments: wind and motion from a network, a serial port, a phone, the internet.

`open_source` makes a `LiveWind` from an address such as ``udp://:10110``: `transports` deliver
bytes and connect again, `readers` say what they mean, and a file of `sources` puts one of each
together. One sender is followed; another is refused, counted and named. `open_motion` and
`MotionFeed` do the same for motion sensors. A new kind of source is one file in
`sources` and its row there (``CONTRIBUTING.md``).
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.live.camera.camera_view import CameraView as CameraView
    from tree_sway.live.camera.film import Film as Film
    from tree_sway.live.camera.film import is_camera as is_camera
    from tree_sway.live.camera.film import LiveFilm as LiveFilm
    from tree_sway.live.camera.page_film import PAGE as PAGE
    from tree_sway.live.camera.page_film import PageFilm as PageFilm
    from tree_sway.live.camera.point_tracker import PointTracker as PointTracker
    from tree_sway.live.camera.point_tracker import Sighting as Sighting
    from tree_sway.live.live_wind import LiveWind as LiveWind
    from tree_sway.live.motion.live_motion import LiveMotion as LiveMotion
    from tree_sway.live.motion.motion_feed import MotionFeed as MotionFeed
    from tree_sway.live.motion.motion_registry import open_motion as open_motion
    from tree_sway.live.readers.instrument_lines import InstrumentLines as InstrumentLines
    from tree_sway.live.registry import open_source as open_source
else:
    __getattr__, __dir__, __all__ = face(__name__)
