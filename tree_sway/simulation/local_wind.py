# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The wind at any place of a running scene, for what flies there.

It is the wind that a tree at the place would have: that of the anemometer, later by the way that
gusts travel where they do (`GustHistory`), times the profile over the height. Neither wakes
of trees nor the turbulence within a crown are in it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import three_numbers
from tree_sway.core.scene import Simulator
from tree_sway.errors import ParameterError


def wind_at(simulator: Simulator, place: ArrayLike) -> Floats:
    """
    Return the wind at a place after the last step of a simulator; from any thread.

    Parameters
    ----------
    simulator
        A tree or a scene.
    place
        x, y, z in the frame of its poses in [m], (3,); the ground of the wind profile is that of
        the settings, z = 0 if they have none.

    Returns
    -------
    Floats
        Wind, the way the air goes, east, north, up in [m/s], (3,).

    Raises
    ------
    ParameterError
        A place that is not finite.

    """
    x, y, z = three_numbers('place', place)
    if not np.isfinite([x, y, z]).all():
        raise ParameterError(f'({x}, {y}, {z}) is no place', where='place', cure='give metres')
    gusts = simulator.gusts
    wind = np.array(simulator.wind) if gusts is None else gusts.wind_at(x, y)
    return wind * simulator.settings.profile.over_anemometer(np.array(z))
