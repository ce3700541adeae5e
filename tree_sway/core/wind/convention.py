# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
How to read wind: sign, unit, yaw of the mast and force plane.

ROS vectors are velocities in ENU (REP-103): a wind vector points where the air goes. Meteorology
names the wind by where it comes from. A source that does the latter has every sign the other way
round.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tree_sway.core.checks import within
from tree_sway.errors import ParameterError

Floats = NDArray[np.float64]

CALM_SPEED = 0.05
"""Speed in [m/s] below which no direction is computed: sonics repeat their last one there."""


def velocity_of_bearing(
    speed: float, bearing: float, direction_convention: str = 'from'
) -> tuple[float, float, float]:
    """
    Velocity east, north, up to which a wind blows in [m/s], by speed and bearing.

    The bearing, clockwise from north in [rad], is where it comes ``from``, as meteorology says it,
    or blows ``to``.
    """
    sign = WindConvention(direction_convention).sign
    return sign * speed * math.sin(bearing), sign * speed * math.cos(bearing), 0.0


@dataclass(frozen=True)
class WindConvention:
    """
    What the numbers of a wind source mean.

    Parameters
    ----------
    direction_convention
        ``to``: vectors point where the wind blows to; ``from``: where it comes from.
    speed_scale
        Metres per second in one unit of the source: 1, 0.514444 for knots, 0.277778 for km/h.
    yaw_offset
        Angle from east to the source's x axis, counter-clockwise seen from above, in [rad]: a mast
        that is not aligned, or magnetic declination.
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
        """Refuse what cannot be read."""
        if self.direction_convention not in ('to', 'from'):
            raise ParameterError(
                f"unknown convention '{self.direction_convention}'",
                where='direction_convention',
                cure="use 'to' (blows to, as ROS) or 'from' (comes from, as meteorology)",
            )
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
    def _unit_normal(self) -> tuple[float, float, float]:
        x, y, z = self.normal.tolist()
        return x, y, z

    def _enu(self, u: float, v: float, w: float, scale: float) -> Floats:
        # Scalars, not a matrix: infinities turn into NaN without a warning, for the gate to
        # refuse.
        sine, cosine = math.sin(self.yaw_offset), math.cos(self.yaw_offset)
        u, v, w = scale * float(u), scale * float(v), scale * float(w)
        return np.array([cosine * u - sine * v, sine * u + cosine * v, w])

    @property
    def sign(self) -> float:
        """Of a component that points where the wind blows to."""
        return 1.0 if self.direction_convention == 'to' else -1.0

    def velocity(self, u: float, v: float, w: float = 0.0) -> Floats:
        """
        Return what a source says as the velocity of the air, before any projection.

        This is what to judge a sample by: a fault in the component across the plane counts too.

        Parameters
        ----------
        u, v, w
            Components along the source's x, y, z axes, in its unit.

        Returns
        -------
        Floats
            Wind velocity, blowing to, ENU in [m/s], (3,).

        """
        return self._enu(u, v, w, self.sign * self.speed_scale)

    def velocities(self, components: Floats) -> Floats:
        """Return `velocity` of many samples at once, (n, 3)."""
        c, s = math.cos(self.yaw_offset), math.sin(self.yaw_offset)
        turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        return np.asarray(self.sign * self.speed_scale * components @ turn, dtype=np.float64)

    def components(self, velocity: ArrayLike) -> tuple[float, float, float]:
        """
        Return what a source of this convention says of a velocity; the inverse of `velocity`.

        Parameters
        ----------
        velocity
            Where the wind blows to, ENU in [m/s], (3,).

        """
        (u, v, w), scale = np.asarray(velocity).tolist(), self.sign / self.speed_scale
        c, s = math.cos(self.yaw_offset), math.sin(self.yaw_offset)
        return scale * (c * u + s * v), scale * (c * v - s * u), scale * w

    def project(self, velocity: Floats) -> Floats:
        """Return a velocity in [m/s] projected on the force plane, (3,)."""
        nx, ny, nz = self._unit_normal
        x, y, z = velocity.tolist()
        across = x * nx + y * ny + z * nz
        return np.array([x - across * nx, y - across * ny, z - across * nz])

    def vector(self, u: float, v: float, w: float = 0.0) -> Floats:
        """Return `velocity`, projected on the force plane: blowing to, ENU in [m/s], (3,)."""
        return self.project(self.velocity(u, v, w))

    def force_plane_quaternion(self, vector: Floats, previous: Floats | None = None) -> Floats:
        """
        Return the attitude of the force plane: x along the wind, z along the plane's normal.

        Parameters
        ----------
        vector
            Wind, blowing to, ENU in [m/s], (3,).
        previous
            The quaternion to keep while the wind is below `CALM_SPEED` in the plane, (4,); without
            one, x is then as near to east as the plane allows, or to north if it is across east.

        Returns
        -------
        Floats
            Unit quaternion w, x, y, z of the rotation from the plane's axes to ENU, (4,).

        """
        along = self.project(np.asarray(vector, dtype=np.float64))
        if not math.hypot(*along) >= CALM_SPEED:
            if previous is not None:
                return previous
            east, north = self.project(np.eye(3)[0]), self.project(np.eye(3)[1])
            along = east if np.linalg.norm(east) > 0.1 else north
        return quaternion_of_axes(along / math.hypot(*along), self._unit_normal)

    def describe(self) -> str:
        """Return one line that says how the wind is read."""
        sense = 'blows TO' if self.direction_convention == 'to' else 'comes FROM'
        unit = 'm/s' if self.speed_scale == 1.0 else f'{self.speed_scale:g} m/s a unit'
        text = f'reading wind as: {sense}, ENU, {unit}'
        if self.yaw_offset != 0.0:
            text += f', turned by {math.degrees(self.yaw_offset):g} degrees'
        if not np.array_equal(self.normal, (0.0, 0.0, 1.0)):
            text += ', on the plane across ({:g}, {:g}, {:g})'.format(*self.normal)
        return text


def quaternion_of_axes(along: Floats, normal: Iterable[float]) -> Floats:
    """Return the unit quaternion w, x, y, z that turns x and z into these unit vectors, (3,)."""
    (xx, xy, xz), (zx, zy, zz) = along.tolist(), normal
    yx, yy, yz = zy * xz - zz * xy, zz * xx - zx * xz, zx * xy - zy * xx
    # Four times its product with itself: each row is the quaternion times one of its components.
    rows = (
        (1.0 + xx + yy + zz, yz - zy, zx - xz, xy - yx),
        (yz - zy, 1.0 + xx - yy - zz, xy + yx, xz + zx),
        (zx - xz, xy + yx, 1.0 - xx + yy - zz, yz + zy),
        (xy - yx, xz + zx, yz + zy, 1.0 - xx - yy + zz),
    )
    row = rows[max(range(4), key=lambda i: rows[i][i])]
    return np.array(row) / math.hypot(*row)
