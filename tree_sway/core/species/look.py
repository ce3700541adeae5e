# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""How a species looks: its colours, its bark, and the sprays that its leaves are drawn as."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from tree_sway.core.species.foliage_traits import LeafTraits

Color = tuple[float, float, float]
"""Red, green and blue, sRGB from 0 to 1."""


@dataclass(frozen=True)
class Spray:
    """
    Cards that show the leaves of one cluster, crossed about its x axis.

    Parameters
    ----------
    length
        Length of a card over the diameter of the cluster [-].
    width
        Width of a card over its length [-].
    rolls
        Angle of each card about the x axis in [rad]; the first ones are drawn where few are.

    """

    length: float
    width: float
    rolls: tuple[float, ...]


FORMS = (
    'ovate',
    'pointed',
    'heart',
    'lobed',
    'palmate',
    'compound',
    'digitate',
    'needles',
    'bunches',
    'fronds',
    'tufts',
)
"""Outlines of leaves, and the ways that needles stand."""

_LEVEL = (0.0, 1.35, -0.75)
_CROSSED = (0.2, -0.9, 1.3)
_FILLED, _FILLED_BY_NEEDLES = 1.5, 1.25
"""Length of a spray as wide as it is long over the diameter of its cluster [-]."""


@dataclass(frozen=True)
class Look:
    """
    Look of a species; the defaults are those of an average broadleaf.

    Parameters
    ----------
    green, fresh
        Colours of a leaf and of the youngest ones.
    autumn
        Colour before leaves fall; None for evergreen species.
    form
        Outline of a leaf, or how needles stand: one of `FORMS`.
    slenderness
        Width of a leaf over its length [-].
    shoot_angle
        Angle between a leafy shoot and the twig that it grows on in [rad].
    droop
        How far shoots hang down (or point up, below 0) [-]; 1 is half-way.
    spray_width
        Width of a spray over its length [-].
    spray_size
        Size of a spray over that of the others for the same leaf area [-].
    depth
        Depth of a cluster of leaves over its width [-]: small where leaves lie in layers.
    bark, twig
        Colours of the stem and of thin twigs.
    bark_pattern
        Pattern of the bark: furrows, plates, scales, smooth, dashes or flakes.

    """

    green: Color = (0.24, 0.39, 0.12)
    fresh: Color = (0.46, 0.58, 0.20)
    autumn: Color | None = (0.72, 0.50, 0.13)
    form: str = 'ovate'
    slenderness: float = 0.5
    shoot_angle: float = 0.85
    droop: float = 0.1
    spray_width: float = 0.75
    spray_size: float = 1.0
    depth: float = 0.8
    bark: Color = (0.42, 0.35, 0.28)
    twig: Color = (0.34, 0.28, 0.20)
    bark_pattern: str = 'furrows'

    @property
    def spray(self) -> Spray:
        """Cards of a cluster of leaves, of about the same area however slender they are."""
        is_flat = self.form in ('needles', 'bunches', 'fronds')
        length = self.spray_size * (_FILLED_BY_NEEDLES if is_flat else _FILLED)
        rolls = _LEVEL if is_flat else _CROSSED
        return Spray(length / self.spray_width**0.5, self.spray_width, rolls)

    def described(self, leaves: LeafTraits, habit: str) -> dict[str, Any]:
        """Return everything that a page needs to draw the species, for JSON."""
        own = {'leaf_size': leaves.size, 'has_needles': leaves.are_needles}
        return {**asdict(self), 'spray': asdict(self.spray), **own, 'is_potted': habit == 'pot'}
