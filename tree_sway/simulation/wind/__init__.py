# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Wind without an instrument: gusts about means, and an instrument that is simulated.

`turbulence_about_means` puts gusts between means of minutes or hours, as stations report them;
`AnemometerModel` is an instrument that never ends, with the faults of `SensorFaults` where one
asks for them. The same seed gives the same wind on every machine. The turbulence itself is in the
house `core.wind`.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.simulation.wind.about_means import can_be_filled as can_be_filled
    from tree_sway.simulation.wind.about_means import LEAST_INTERVAL as LEAST_INTERVAL
    from tree_sway.simulation.wind.about_means import (
        turbulence_about_means as turbulence_about_means,
    )
    from tree_sway.simulation.wind.about_means import usual_deviation as usual_deviation
    from tree_sway.simulation.wind.about_means import usual_gust as usual_gust
    from tree_sway.simulation.wind.anemometer import AnemometerModel as AnemometerModel
    from tree_sway.simulation.wind.sensor_faults import SensorFaults as SensorFaults
else:
    __getattr__, __dir__, __all__ = face(__name__)
