# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import math

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
from scipy.spatial.transform import Rotation

from tree_sway.core.wind import WindConvention
from tree_sway_ros.wire.force_plane import CALM_SPEED, ForcePlane

winds = st.tuples(*[st.floats(-40.0, 40.0)] * 3)
normals = st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda n: np.linalg.norm(n) > 0.01)


def axes_of(quaternion):
    return Rotation.from_quat(np.roll(quaternion, -1)).as_matrix().T


@given(components=winds, normal=normals)
def test_it_is_a_right_handed_frame_with_x_along_the_wind(components, normal):
    convention = WindConvention(plane_normal=normal)
    wind = convention.project(convention.velocity(components))
    x, y, z = axes_of(ForcePlane(convention).turn(wind))
    np.testing.assert_allclose(z, convention.normal, atol=1e-12)
    np.testing.assert_allclose(np.cross(x, y), z, atol=1e-12)
    if np.linalg.norm(wind) >= CALM_SPEED:
        np.testing.assert_allclose(x, wind / np.linalg.norm(wind), atol=1e-11)


def test_the_quaternion_is_w_first():
    quaternion = ForcePlane(WindConvention()).turn(np.array([0.0, 2.0, 0.0]))
    half = math.sqrt(0.5)
    np.testing.assert_allclose(np.abs(quaternion), (half, 0.0, 0.0, half), atol=1e-15)


def test_calm_keeps_the_last_direction_or_takes_east():
    plane = ForcePlane(WindConvention())
    calm = np.array([0.03, 0.0, 0.0])
    np.testing.assert_allclose(axes_of(plane.turn(calm))[0], (1, 0, 0))
    north = plane.turn(np.array([0.0, 2.0, 0.0])).copy()
    np.testing.assert_array_equal(plane.turn(calm), north)


def test_calm_on_a_plane_across_east_takes_north():
    plane = ForcePlane(WindConvention(plane_normal=(2.0, 0.0, 0.0)))
    np.testing.assert_allclose(axes_of(plane.turn(np.zeros(3)))[0], (0, 1, 0), atol=1e-15)
