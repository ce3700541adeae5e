# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Gusts in space: from the anemometer to a tree, and from limb to limb.

`GustHistory` lets gusts travel to the trees of a scene (Taylor 1938), `CrownWind` from limb to
limb of a crown. `FarWind` is the wind of a tree that stands apart from its anemometer, which no
longer knows the small gusts there: the expected wind, or a sample of what may be (Davenport 1961;
Wiener 1949).
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.core.wind.gusts.crown_wind import CrownWind as CrownWind
    from tree_sway.core.wind.gusts.crown_wind import DECAY as DECAY
    from tree_sway.core.wind.gusts.crown_wind import delays_of as delays_of
    from tree_sway.core.wind.gusts.crown_wind import limbs_of as limbs_of
    from tree_sway.core.wind.gusts.crown_wind import N_DELAYS as N_DELAYS
    from tree_sway.core.wind.gusts.crown_wind import parts_of as parts_of
    from tree_sway.core.wind.gusts.crown_wind import USUAL_COHERENCE as USUAL_COHERENCE
    from tree_sway.core.wind.gusts.far_wind import FarWind as FarWind
    from tree_sway.core.wind.gusts.far_wind import SAMPLES as SAMPLES
    from tree_sway.core.wind.gusts.gust_travel import GustHistory as GustHistory
    from tree_sway.core.wind.gusts.wind_history import follow_mean as follow_mean
    from tree_sway.core.wind.gusts.wind_history import WindHistory as WindHistory
else:
    __getattr__, __dir__, __all__ = face(__name__)
