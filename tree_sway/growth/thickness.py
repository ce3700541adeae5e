# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Diameters of branches: the pipe model, scaled to one measured diameter.

A cross-section carries the conduits of all wood beyond it (Shinozaki et al. 1964). With W the
length of all shoots beyond a node, its diameter is ``d = d_tip (1 + W / w)^(1/p)``. Exponent p is
2 where areas add up (da Vinci) and 3 for Murray's law; trees without their finest twigs, as here,
are between. The length w follows from the given diameter, at the base or at breast height.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.tree import Tree
from tree_sway.errors import ParameterError
from tree_sway.growth.crown_allometry import BREAST_HEIGHT
from tree_sway.growth.skeleton import Shoot, Skeleton

_INSERTION_RATIO = 0.76
"""Largest ratio of a branch's diameter to its parent's at its base, in [-]."""


def carried_length(skeleton: Skeleton) -> list[Floats]:
    """Length of all shoots beyond each node in [m], one (k + 1,) per shoot."""
    shoots = skeleton.shoots
    added = [np.zeros(len(shoot.nodes)) for shoot in shoots]
    beyond: list[Floats] = [np.empty(0)] * len(shoots)
    for i in range(len(shoots) - 1, -1, -1):
        shoot = shoots[i]
        added[i][:-1] += np.linalg.norm(np.diff(shoot.nodes, axis=0), axis=1)
        beyond[i] = np.cumsum(added[i][::-1])[::-1]
        if shoot.parent >= 0:
            added[shoot.parent][shoot.at] += beyond[i][0]
    return beyond


def node_diameters(
    skeleton: Skeleton, diameter: float, *, at_height: float, tip_diameter: float,
    exponent: float = 2.5, stem_taper: float | None = None, bole_taper: float = 0.0,
) -> list[Floats]:  # fmt: skip
    """
    Diameter of every node in [m] by the pipe model, one (k + 1,) per shoot, the stem first.

    Parameters
    ----------
    skeleton
        The shoots, the stem first.
    diameter, at_height
        Diameter of the stem in [m], at a height above the root in [m].
    tip_diameter
        Diameter of a shoot's tip in [m].
    exponent
        p above in [-].
    stem_taper
        Exponent of the distance from the top in the diameter of the stem, if it does not follow
        the pipe model.
    bole_taper
        Exponent of the distance from the top of the tree in a further taper of the stem, above the
        height of the given diameter: pipes of lost branches stay in the wood below (Shinozaki et
        al. 1964).

    Raises
    ------
    ParameterError
        If the stem is to be thinner than twice its tips.

    """
    if not diameter > 2.0 * tip_diameter:
        raise ParameterError(
            f'diameter {diameter:.4g} m is too thin for a stem with tips of {tip_diameter:.4g} m',
            where='diameter',
            cure=f'give more than {2.0 * tip_diameter:.4g} m',
        )
    beyond = carried_length(skeleton)
    stem = skeleton.shoots[0]
    carried = _at_height(stem, beyond[0], at_height)
    w = carried / ((diameter / tip_diameter) ** exponent - 1.0)
    diameters = [tip_diameter * (1.0 + each / w) ** (1.0 / exponent) for each in beyond]
    if stem_taper is not None:
        z = stem.nodes[:, 2] - stem.nodes[0, 2]
        own = diameter * ((1.0 - z / z[-1]) / (1.0 - at_height / z[-1])) ** stem_taper
        diameters[0] = np.maximum(own, tip_diameter)
    top = max(float(shoot.nodes[:, 2].max()) for shoot in skeleton.shoots)
    below_top = (top - stem.nodes[:, 2]) / (top - stem.nodes[0, 2] - at_height)
    own = diameters[0] * np.clip(below_top, 0.0, 1.0) ** bole_taper
    diameters[0] = np.maximum(own, tip_diameter)
    # Thicken every shoot that is too thin for its children, and below.
    for shoot, own in zip(reversed(skeleton.shoots), reversed(diameters), strict=True):
        own[:] = np.maximum.accumulate(own[::-1])[::-1]
        if shoot.parent >= 0:
            below = diameters[shoot.parent]
            below[shoot.at] = max(below[shoot.at], own[0] / _INSERTION_RATIO)
    # Between two nodes a segment is a straight cone, not the law's curve: correct that difference.
    diameters[0] *= diameter / _at_height(stem, diameters[0], at_height)
    for shoot, own in zip(skeleton.shoots[1:], diameters[1:], strict=True):
        limit = _INSERTION_RATIO * diameters[shoot.parent][shoot.at]
        own *= min(1.0, limit / own[0])
    return diameters


def finished_tree(
    skeleton: Skeleton,
    height: float,
    diameter: float,
    species: str,
    *,
    pot: float = 0.0,
    **law: Any,
) -> Tree:
    """
    Return the tree of a skeleton, of a height and a diameter in [m].

    The diameter is at breast height, or at the base of a tree below twice that height and of a pot
    plant, whose tips have the diameter ``pot`` times its height. The rest is of `node_diameters`.
    """
    skeleton.scale_to_height(height)
    diameters = node_diameters(
        skeleton,
        diameter,
        at_height=0.0 if pot or height <= 2.0 * BREAST_HEIGHT else BREAST_HEIGHT,
        tip_diameter=pot * height if pot else 0.003 * (height / 8.0) ** 0.5,
        **law,
    )
    return skeleton.to_tree(diameters, species, species)


def _at_height(stem: Shoot, values: Floats, height: float) -> float:
    return float(np.interp(height, stem.nodes[:, 2] - stem.nodes[0, 2], values))
