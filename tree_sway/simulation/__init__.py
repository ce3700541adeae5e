# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Used share of the strength of a tree: of the wood by its strain, of the roots by the base moment.

Strain along every branch, shares and their bands. This is no verdict on safety.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.simulation.critical_wind import ShareCurve as ShareCurve
    from tree_sway.simulation.exposure import Exposure as Exposure
    from tree_sway.simulation.exposure import exposure_of as exposure_of
    from tree_sway.simulation.exposure import EXPOSURES as EXPOSURES
    from tree_sway.simulation.exposure import STATION_HEIGHT as STATION_HEIGHT
    from tree_sway.simulation.rig import PlacedMotion as PlacedMotion
    from tree_sway.simulation.rig import refuse_too_many_steps as refuse_too_many_steps
    from tree_sway.simulation.rig import Rig as Rig
    from tree_sway.simulation.rig import simulate as simulate
    from tree_sway.simulation.rig import WindSamples as WindSamples
    from tree_sway.simulation.strength_band import root_band as root_band
    from tree_sway.simulation.strength_band import wood_band as wood_band
    from tree_sway.simulation.strength_use import StrengthUse as StrengthUse
    from tree_sway.simulation.sway_record import SwayRecord as SwayRecord
else:
    __getattr__, __dir__, __all__ = face(__name__)
