# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A tree in a wind in one call, and what its sway means for its strength.

`simulate` (and `Rig`, for several winds) steps a tree from rest through a record and returns a
`SwayRecord`: tips, moments, strains, notes of doubt, a band. `Exposure` is the wind where a tree
stands: in the open, at an edge, inside a stand. `StrengthUse` is the largest share of its strength
that the tree used, of the wood by its strain and of the roots by the moment at the base, with the
band of trees of its kind; `critical_wind` is the mean wind at which that share reaches one. It is
no verdict on a tree's safety. `wind_at` is the wind at any place of a running scene.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.simulation.critical_wind import ShareCurve as ShareCurve
    from tree_sway.simulation.exposure import Exposure as Exposure
    from tree_sway.simulation.exposure import exposure_of as exposure_of
    from tree_sway.simulation.exposure import EXPOSURES as EXPOSURES
    from tree_sway.simulation.exposure import STATION_HEIGHT as STATION_HEIGHT
    from tree_sway.simulation.interpolated import interpolated_means as interpolated_means
    from tree_sway.simulation.local_wind import wind_at as wind_at
    from tree_sway.simulation.rig import PlacedMotion as PlacedMotion
    from tree_sway.simulation.rig import refuse_too_many_steps as refuse_too_many_steps
    from tree_sway.simulation.rig import Rig as Rig
    from tree_sway.simulation.rig import simulate as simulate
    from tree_sway.simulation.rig import WindSamples as WindSamples
    from tree_sway.simulation.strength_band import root_band as root_band
    from tree_sway.simulation.strength_band import wood_band as wood_band
    from tree_sway.simulation.strength_use import StrengthUse as StrengthUse
    from tree_sway.simulation.sway_record import SwayRecord as SwayRecord
    from tree_sway.simulation.wind_source import blow as blow
    from tree_sway.simulation.wind_source import RecordedWind as RecordedWind
    from tree_sway.simulation.wind_source import SimulatedWind as SimulatedWind
    from tree_sway.simulation.wind_source import WindSource as WindSource
else:
    __getattr__, __dir__, __all__ = face(__name__)
