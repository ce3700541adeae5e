# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Leaves of a species: size, number, mass and frequency of flutter.

Fresh mass is dry mass over dry-matter content. The mean of 85 woody species of Estonia is 68.6
g/m^2 dry (Niinemets & Kull 1994); leaves of woody plants are about 0.35 dry matter. Needles have
two to three times that per square metre. Leaf area follows the conducting section of the stem
(pipe model: Shinozaki et al. 1964); its ratio varies by three orders of magnitude over the world's
species (Mencuccini et al. 2019), so ratios are estimates within a factor of two, and so are
frequencies. Areas are of one side.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class LeafTraits:
    """
    Leaves of a species; the defaults are those of an average broadleaf.

    Parameters
    ----------
    size
        Diameter of a leaf, or of a shoot with its needles, in [m].
    area_per_section
        Leaf area over cross-section of the stem in [m^2/m^2].
    fresh_mass
        Fresh mass over leaf area in [kg/m^2].
    flutter_frequency
        Frequency at which a leaf turns on its stalk in [Hz].
    is_evergreen
        Whether the species keeps them in winter.
    are_needles
        Whether they are needles instead of blades.

    """

    size: float = 0.07
    area_per_section: float = 2500.0
    fresh_mass: float = 0.20
    flutter_frequency: float = 4.0
    is_evergreen: bool = False
    are_needles: bool = False
