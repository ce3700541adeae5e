# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Simulated winds: turbulence of a given spectrum, gust events, a simulated anemometer.

Randomness comes from an ``rng`` argument. Recorded winds are in the room above.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.core.wind.simulated.about_means import can_be_filled as can_be_filled
    from tree_sway.core.wind.simulated.about_means import LEAST_INTERVAL as LEAST_INTERVAL
    from tree_sway.core.wind.simulated.about_means import (
        turbulence_about_means as turbulence_about_means,
    )
    from tree_sway.core.wind.simulated.anemometer import AnemometerModel as AnemometerModel
    from tree_sway.core.wind.simulated.gusts_about_mean import GustsAboutMean as GustsAboutMean
    from tree_sway.core.wind.simulated.gusts_about_mean import RATE as RATE
    from tree_sway.core.wind.simulated.sensor_faults import SensorFaults as SensorFaults
    from tree_sway.core.wind.simulated.turbulence import SCALE_RATIOS as SCALE_RATIOS
    from tree_sway.core.wind.simulated.turbulence import simulate_turbulence as simulate_turbulence
    from tree_sway.core.wind.simulated.turbulence import Turbulence as Turbulence
    from tree_sway.core.wind.simulated.turbulence import turbulence_scale as turbulence_scale
else:
    __getattr__, __dir__, __all__ = face(__name__)
