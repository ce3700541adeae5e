# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Convention of a wind source: sign, unit, yaw of the mast and force plane.

ROS vectors are velocities in ENU (REP-103): a wind vector points where the air goes. Meteorology
names the wind by where it comes from, with opposite signs.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
import math

import numpy as np
from numpy.typing import ArrayLike

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import one_of, within
from tree_sway.core.rotation import about_up
from tree_sway.errors import ParameterError


def velocity_of_bearing(
    speed: float, bearing: float, direction_convention: str = 'from'
) -> tuple[float, float, float]:
    """
    Velocity east, north, up of a wind in [m/s], by speed and bearing.

    The bearing, clockwise from north in [rad], is where it comes ``from``, as in meteorology, or
    blows ``to``.
    """
    sign = WindConvention(direction_convention).sign
    return sign * speed * math.sin(bearing), sign * speed * math.cos(bearing), 0.0


@dataclass(frozen=True)
class WindConvention:
    """
    Meaning of the numbers of a wind source.

    Parameters
    ----------
    direction_convention
        ``to``: vectors point where the wind blows to; ``from``: where it comes from.
    speed_scale
        Metres per second in one unit of the source: 1, 0.514444 for knots, 0.277778 for km/h.
    yaw_offset
        Angle from east to the source's x axis, counter-clockwise seen from above, in [rad]: for a
        mast that is not aligned, or magnetic declination.
    plane_normal
        Normal of the force plane, of any length, (3,): the wind is projected on that plane.

    Raises
    ------
    ParameterError
        If a value is out of its range or the normal has no direction.

    """

    direction_convention: str = 'to'
    speed_scale: float = 1.0
    yaw_offset: float = 0.0
    plane_normal: Sequence[float] = (0.0, 0.0, 1.0)

    def __post_init__(self) -> None:
        """Check the values."""
        one_of('direction convention', self.direction_convention, ('to', 'from'))
        within('speed_scale', self.speed_scale, 0.0, 1e3, 'm/s', above=True)
        within('yaw_offset', self.yaw_offset, -4.0 * math.pi, 4.0 * math.pi, 'rad')
        normal = np.asarray(self.plane_normal, dtype=np.float64)
        if normal.shape != (3,) or not np.isfinite(normal).all() or np.abs(normal).max() < 1e-12:
            raise ParameterError(
                f'{tuple(self.plane_normal)} has no direction',
                where='plane_normal',
                cure='use three numbers that are not all zero, such as (0, 0, 1)',
            )
        object.__setattr__(self, 'plane_normal', tuple(normal.tolist()))

    @cached_property
    def normal(self) -> Floats:
        """Return the unit normal of the force plane, (3,)."""
        normal = np.asarray(self.plane_normal)
        normal = normal / np.abs(normal).max()  # so that no square vanishes or overflows
        return np.asarray(normal / np.linalg.norm(normal))

    @cached_property
    def sign(self) -> float:
        """Sign of a component that points where the wind blows to."""
        return 1.0 if self.direction_convention == 'to' else -1.0

    @cached_property
    def _enu_from_source(self) -> Floats:
        return about_up(self.yaw_offset)

    def velocity(self, components: ArrayLike) -> Floats:
        """
        Convert components of a source to the velocity of the air, before any projection.

        Samples are checked by this velocity: a fault in the component across the plane counts too.

        Parameters
        ----------
        components
            Along the source's x, y, z axes, in its unit, (3,), or of many samples, (n, 3).

        Returns
        -------
        Floats
            Wind velocity, blowing to, ENU in [m/s], of the same shape.

        """
        with np.errstate(invalid='ignore', over='ignore'):  # the gate refuses it
            scaled = self.sign * self.speed_scale * np.asarray(components, dtype=np.float64)
            return np.asarray(scaled @ self._enu_from_source.T)

    def components(self, velocity: ArrayLike) -> tuple[float, float, float]:
        """
        Convert a velocity to components of a source; the inverse of `velocity`.

        Parameters
        ----------
        velocity
            Velocity of the wind, ENU in [m/s], (3,).

        """
        scale = self.sign / self.speed_scale
        u, v, w = (scale * np.asarray(velocity) @ self._enu_from_source).tolist()
        return u, v, w

    def project(self, velocity: Floats) -> Floats:
        """Return a velocity in [m/s] projected on the force plane, (3,)."""
        return velocity - (velocity @ self.normal) * self.normal
