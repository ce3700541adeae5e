# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The wind from a sensor to the trees.

In the order of a sample: `WindConvention` (unit, sign, turn of the mast), `WindGate` (what no wind
does is refused and counted), `WindIntake` (both, then the force plane), `WindAverage` (the mean of
the curve through the samples over a step), `WindProfile` (height), `GustHistory` (gusts travel to
a tree) and `CrownWind` (and from limb to limb). Speeds are in [m/s], the way the air goes, east,
north, up; times in [ns] where they are stamps, else in [s].

`simulate_turbulence` draws a record from Kaimal's spectra (IEC 61400-1:2005, annex B.2); the same
seed gives the same wind on every machine. Gusts in space are in `gusts`; formats of files and
instruments are in other houses.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.core.wind.averaging import LONGEST_HOLD as LONGEST_HOLD
    from tree_sway.core.wind.averaging import WindAverage as WindAverage
    from tree_sway.core.wind.convention import velocity_of_bearing as velocity_of_bearing
    from tree_sway.core.wind.convention import WindConvention as WindConvention
    from tree_sway.core.wind.gate import GateCounts as GateCounts
    from tree_sway.core.wind.gate import LONGEST_TRANSPORT as LONGEST_TRANSPORT
    from tree_sway.core.wind.gate import WindGate as WindGate
    from tree_sway.core.wind.height_profile import WindProfile as WindProfile
    from tree_sway.core.wind.intake import GoodWind as GoodWind
    from tree_sway.core.wind.intake import WindIntake as WindIntake
    from tree_sway.core.wind.limits import FASTEST_WIND as FASTEST_WIND
    from tree_sway.core.wind.limits import is_wind as is_wind
    from tree_sway.core.wind.limits import shorter_than as shorter_than
    from tree_sway.core.wind.sensor_timing import SensorTiming as SensorTiming
    from tree_sway.core.wind.turbulence import along_bearing as along_bearing
    from tree_sway.core.wind.turbulence import REFERENCE_INTENSITY as REFERENCE_INTENSITY
    from tree_sway.core.wind.turbulence import SCALE_RATIOS as SCALE_RATIOS
    from tree_sway.core.wind.turbulence import SHORTEST_PERIOD as SHORTEST_PERIOD
    from tree_sway.core.wind.turbulence import simulate_turbulence as simulate_turbulence
    from tree_sway.core.wind.turbulence import Turbulence as Turbulence
    from tree_sway.core.wind.turbulence import turbulence_scale as turbulence_scale
else:
    __getattr__, __dir__, __all__ = face(__name__)
