# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Simulated winds: turbulence of a given spectrum, gusts about means, an anemometer.

`simulate_turbulence` draws a record from Kaimal's spectra (IEC 61400-1:2005, annex B.2) by a
seeded generator; `turbulence_about_means` puts such gusts between means of minutes or hours;
`AnemometerModel` is an instrument that never ends, with the faults of `SensorFaults` where a test
asks for them. The same seed gives the same wind on every machine.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.core.wind.simulated.about_means import can_be_filled as can_be_filled
    from tree_sway.core.wind.simulated.about_means import LEAST_INTERVAL as LEAST_INTERVAL
    from tree_sway.core.wind.simulated.about_means import (
        turbulence_about_means as turbulence_about_means,
    )
    from tree_sway.core.wind.simulated.about_means import usual_deviation as usual_deviation
    from tree_sway.core.wind.simulated.about_means import usual_gust as usual_gust
    from tree_sway.core.wind.simulated.anemometer import AnemometerModel as AnemometerModel
    from tree_sway.core.wind.simulated.sensor_faults import SensorFaults as SensorFaults
    from tree_sway.core.wind.simulated.turbulence import SCALE_RATIOS as SCALE_RATIOS
    from tree_sway.core.wind.simulated.turbulence import simulate_turbulence as simulate_turbulence
    from tree_sway.core.wind.simulated.turbulence import Turbulence as Turbulence
    from tree_sway.core.wind.simulated.turbulence import turbulence_scale as turbulence_scale
else:
    __getattr__, __dir__, __all__ = face(__name__)
