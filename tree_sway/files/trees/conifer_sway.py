# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A conifer that sways unlike others of its size, which nearly always is a wrong unit.

The slowest sway of 602 measured conifers is ``f = 0.0766 + 3.1219 D / H^2`` in [Hz], D in [cm],
H in [m] (Moore & Maguire 2004).
"""

from tree_sway.core.species import Species
from tree_sway.core.tree import Tree

_FACTOR = 5.0


def sway_oddity(tree: Tree, species: Species, frequency: float) -> str:
    """Report a conifer whose sway [Hz] is far from that of others of its size; else empty."""
    if species.habit != 'conifer':
        return ''
    usual = 0.0766 + 3.1219 * 100.0 * float(tree.base_diameter[0]) / tree.height**2
    if usual / _FACTOR <= frequency <= usual * _FACTOR:
        return ''
    return (
        f'its slowest sway has {frequency:.3g} Hz, while conifers of its size have some '
        f'{usual:.2g} Hz: check --modulus, --density and the diameters (--option twig_diameter)'
    )
