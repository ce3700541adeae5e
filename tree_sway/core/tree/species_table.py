# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The species that there are: a new one is one entry here, and every part of the program reads it.

Modulus and density are of green wood: ForestGALES species tables, the BIOMASS wood density table
and the field table of Jackson et al. (2019). Maple (mean of sugar and red maple), lime (American
basswood), willow (black willow), poplar (eastern cottonwood), larch (western larch), fir (mean of
grand and Pacific silver fir), alder (red alder), cherry (black cherry), plane (American sycamore)
and eucalyptus (jarrah) are by tables 5-3 and 5-5 of the Wood Handbook (Forest Products Laboratory,
2010), their density the basic one times one plus the moisture of its table 4-1: other members of a
genus may differ by a quarter. Drag in leaf is C U^-N between 4 and 20 m/s: Mayhead (1973) for
conifers, Vollsinger et al. (2005) for broadleaves. Where no crown was measured, a broadleaf has
the mean of the three measured ones and a conifer the drag of spruce. The modulus of rupture is of
small clear specimens of green wood: Lavers (1983, The strength properties of timber) for European
trees, tables 5-3 and 5-5 of the Wood Handbook for the others. Entries marked as estimates have no
measurement behind them. Where leaves come from is said in `leaf_traits`.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Any

from tree_sway.core.tree.leaf_traits import LeafTraits, NEEDLES
from tree_sway.core.tree.wood import Species


def _needles(*green: float, evergreen: bool = True) -> LeafTraits:
    """Average needles of a colour of their own."""
    return replace(NEEDLES, green=green, is_evergreen=evergreen)  # type: ignore[arg-type]


def _species(
    key: str,
    title: str,
    modulus: float,
    density: float,
    rupture: float,
    drag: tuple[float, float],
    **more: Any,
) -> Species:
    """One row of the table; rupture in [MPa]; the drag is C and N of the law in leaf."""
    more |= {'rupture': 1e6 * rupture, 'drag_coefficient': drag[0], 'drag_exponent': drag[1]}
    return Species(key, title, modulus, density, **more)


_conifer = partial(_species, habit='conifer')
_estimate = partial(_species, is_estimate=True)
_BROADLEAF, _SPRUCE = (2.345, 0.877), (2.35, 0.51)

SPECIES = {s.key: s for s in (
    _estimate('benjamina', 'Ficus benjamina', 8.3e9, 950.0, 50.0, _BROADLEAF, habit='pot',
              leaves=LeafTraits(0.05, 4400.0, 0.20, 5.0, True, green=(0.22, 0.45, 0.16)),
              bark=(0.52, 0.48, 0.42)),
    _estimate('goldcrest', "Cupressus macrocarpa 'Goldcrest'", 6.0e9, 950.0, 40.0, _SPRUCE,
              leaves=LeafTraits(0.03, 1800.0, 0.45, 7.0, True, True, green=(0.63, 0.70, 0.22)),
              habit='pot', bark=(0.46, 0.32, 0.24)),
    _estimate('broadleaf', 'a broadleaf of no known species', 9.0e9, 900.0, 55.0, _BROADLEAF),
    _estimate('conifer', 'a conifer of no known species', 7.0e9, 850.0, 40.0, _SPRUCE,
              habit='conifer', leaves=_needles(0.23, 0.38, 0.24), bark=(0.42, 0.31, 0.25)),
    _conifer('spruce', 'Norway spruce', 6.3e9, 850.0, 36.0, _SPRUCE,
             leaves=_needles(0.20, 0.36, 0.22), bark=(0.42, 0.29, 0.22)),
    _conifer('sitka', 'Sitka spruce', 5.9e9, 850.0, 34.0, _SPRUCE,
             leaves=_needles(0.26, 0.40, 0.30), bark=(0.42, 0.37, 0.36)),
    _conifer('pine', 'Scots pine', 7.3e9, 850.0, 46.0, (3.07, 0.75), bark=(0.66, 0.40, 0.24),
             leaves=LeafTraits(0.12, 1000.0, 0.55, 5.0, True, True, green=(0.28, 0.42, 0.28))),
    _conifer('douglas_fir', 'Douglas-fir', 8.3e9, 850.0, 53.0, (2.40, 0.70),
             leaves=_needles(0.22, 0.38, 0.20), bark=(0.38, 0.29, 0.24)),
    _conifer('fir', 'fir', 9.2e9, 780.0, 42.0, _SPRUCE,
             leaves=_needles(0.16, 0.34, 0.24), bark=(0.55, 0.53, 0.50)),
    _conifer('larch', 'larch', 10.1e9, 910.0, 53.0, _SPRUCE,
             leaves=_needles(0.42, 0.58, 0.26, evergreen=False), bark=(0.50, 0.36, 0.29)),
    _species('birch', 'birch', 9.9e9, 900.0, 63.0, (1.9627, 0.881), bark=(0.86, 0.85, 0.81),
             leaves=LeafTraits(0.045, 4000.0, 0.16, 5.0, green=(0.40, 0.57, 0.22))),
    _species('oak', 'oak', 9.4e9, 1010.0, 59.0, (2.6575, 0.846), bark=(0.36, 0.31, 0.26),
             leaves=LeafTraits(0.09, 1900.0, 0.20, 3.5)),
    _species('beech', 'beech', 9.8e9, 1158.0, 65.0, (2.4141, 0.904), bark=(0.55, 0.56, 0.54),
             leaves=LeafTraits(0.065, 3000.0, 0.17, 4.5, green=(0.25, 0.48, 0.18))),
    _species('ash', 'ash', 9.5e9, 801.0, 66.0, _BROADLEAF, bark=(0.52, 0.50, 0.44),
             leaves=LeafTraits(0.06, 2700.0, 0.18, 4.5, green=(0.34, 0.55, 0.24))),
    _species('sycamore', 'sycamore', 8.4e9, 721.0, 66.0, _BROADLEAF, bark=(0.50, 0.45, 0.41),
             leaves=LeafTraits(0.13, 2600.0, 0.18, 3.0, green=(0.27, 0.45, 0.17))),
    _species('walnut', 'walnut', 11.3e9, 805.0, 66.0, _BROADLEAF, bark=(0.46, 0.43, 0.40),
             leaves=LeafTraits(0.10, 2500.0, 0.21, 3.0, green=(0.36, 0.53, 0.20))),
    _species('maple', 'maple', 10.2e9, 890.0, 59.0, _BROADLEAF, bark=(0.42, 0.38, 0.34),
             leaves=LeafTraits(0.11, 2600.0, 0.17, 3.0, green=(0.33, 0.52, 0.19))),
    _species('lime', 'lime', 7.2e9, 690.0, 34.0, _BROADLEAF, bark=(0.44, 0.41, 0.36),
             leaves=LeafTraits(0.08, 2800.0, 0.15, 4.0, green=(0.36, 0.56, 0.24))),
    _species('willow', 'willow', 5.4e9, 860.0, 33.0, _BROADLEAF, bark=(0.44, 0.40, 0.32),
             leaves=LeafTraits(0.06, 3500.0, 0.17, 5.0, green=(0.45, 0.58, 0.34))),
    _species('poplar', 'poplar', 7.0e9, 930.0, 37.0, _BROADLEAF, bark=(0.50, 0.48, 0.43),
             leaves=LeafTraits(0.07, 3000.0, 0.20, 6.0, green=(0.38, 0.57, 0.26))),
    _species('alder', 'alder', 8.1e9, 730.0, 45.0, _BROADLEAF, bark=(0.36, 0.33, 0.30),
             leaves=LeafTraits(0.07, 2800.0, 0.19, 4.5, green=(0.22, 0.42, 0.18))),
    _species('cherry', 'cherry', 9.0e9, 750.0, 55.0, _BROADLEAF, bark=(0.44, 0.29, 0.26),
             leaves=LeafTraits(0.07, 2600.0, 0.18, 4.5, green=(0.30, 0.50, 0.20))),
    _species('plane', 'plane', 7.3e9, 1010.0, 45.0, _BROADLEAF, bark=(0.68, 0.66, 0.52),
             leaves=LeafTraits(0.16, 2400.0, 0.19, 2.5, green=(0.36, 0.53, 0.22))),
    _species('eucalyptus', 'eucalyptus', 10.2e9, 1100.0, 68.0, _BROADLEAF, bark=(0.72, 0.66, 0.58),
             leaves=LeafTraits(0.07, 2400.0, 0.33, 4.0, True, green=(0.42, 0.52, 0.38))),
)}  # fmt: skip
"""Every species by its key."""

NAMES = {
    'benjamina': 'ficus, ficus benjamina, weeping fig',
    'goldcrest': 'cupressus macrocarpa, cupressus macrocarpa goldcrest, monterey cypress',
    'broadleaf': 'broadleaved, hardwood, deciduous, laubbaum',
    'conifer': 'softwood, nadelbaum, thuja, cupressus, juniperus, taxus, tsuga, cedrus, sequoia, '
    'sequoiadendron, cryptomeria, chamaecyparis, metasequoia, taxodium, araucaria',
    'spruce': 'picea, picea abies, norway spruce, ns, fi, fichte',
    'sitka': 'picea sitchensis, sitka spruce, ss',
    'pine': 'pinus, pinus sylvestris, scots pine, sp, ki, kiefer',
    'douglas_fir': 'pseudotsuga, pseudotsuga menziesii, douglas fir, df, dgl, douglasie',
    'fir': 'abies, silver fir, grand fir, gf, ta, tanne',
    'larch': 'larix, larix decidua, european larch, el, jl, lae, laerche, lärche',
    'birch': 'betula, betula pendula, silver birch, bi, birke',
    'oak': 'quercus, quercus robur, quercus petraea, english oak, ok, ei, eiche',
    'beech': 'fagus, fagus sylvatica, be, bu, buche',
    'ash': 'fraxinus, fraxinus excelsior, ah, es, esche',
    'sycamore': 'acer pseudoplatanus, sycamore maple, sy, bah, bergahorn',
    'walnut': 'juglans, juglans regia, nu, walnuss',
    'maple': 'acer, acer platanoides, acer campestre, norway maple, sah, ahorn, spitzahorn',
    'lime': 'tilia, tilia cordata, linden, basswood, li, linde',
    'willow': 'salix, salix alba, salix babylonica, weeping willow, wei, weide',
    'poplar': 'populus, populus nigra, populus tremula, aspen, cottonwood, pa, pappel',
    'alder': 'alnus, alnus glutinosa, common alder, er, erle',
    'cherry': 'prunus, prunus avium, wild cherry, gean, kir, kirsche',
    'plane': 'platanus, platanus x hispanica, platanus acerifolia, platanus occidentalis, '
    'london plane, pla, platane',
    'eucalyptus': 'eucalyptus globulus, gum, blue gum, corymbia',
}
"""What species are called besides by their keys: genus, Latin and other names, abbreviations."""
