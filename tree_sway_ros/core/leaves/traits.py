"""
Leaves of each species: how large, how many, how heavy, how quick to flutter.

Fresh mass is dry mass over dry-matter content. The mean of 85 woody species of Estonia is 68.6
g/m^2 dry (Niinemets & Kull 1994); leaves of woody plants are about .35 dry matter. Needles carry
two to three times that a square metre. Leaf area follows the conducting section of the stem (pipe
model: Shinozaki et al. 1964); its ratio varies by three orders of magnitude over the world's
species (Mencuccini et al. 2019), so ratios here are estimates within a factor of two, and so are
frequencies. Areas are of one side.

"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class LeafTraits:
    """
    Leaves of a species.

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
        Whether it keeps them in winter.

    """

    size: float
    area_per_section: float
    fresh_mass: float
    flutter_frequency: float
    is_evergreen: bool = False


_BROAD = LeafTraits(0.07, 2500.0, 0.20, 4.0)
_NEEDLES = LeafTraits(0.08, 2200.0, 0.50, 6.0, is_evergreen=True)

_TABLE = {
    "benjamina": LeafTraits(0.05, 2500.0, 0.22, 5.0, is_evergreen=True),
    "goldcrest": LeafTraits(0.03, 1800.0, 0.45, 7.0, is_evergreen=True),
    "spruce": _NEEDLES,
    "sitka": _NEEDLES,
    "douglas_fir": _NEEDLES,
    "pine": LeafTraits(0.12, 1000.0, 0.55, 5.0, is_evergreen=True),
    "birch": LeafTraits(0.045, 2500.0, 0.18, 5.0),
    "oak": LeafTraits(0.09, 2500.0, 0.21, 3.5),
    "beech": LeafTraits(0.065, 3000.0, 0.17, 4.5),
    "walnut": LeafTraits(0.10, 2500.0, 0.21, 3.0),
}


def leaf_traits(species: str) -> LeafTraits:
    """Leaves of a species; those of an average broadleaf if the table does not have it."""
    return _TABLE.get(species, _BROAD)
