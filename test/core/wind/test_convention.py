# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import math
import warnings

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

from tree_sway.core.wind.convention import velocity_of_bearing, WindConvention
from tree_sway.errors import ParameterError

speeds = st.floats(-40.0, 40.0)
angles = st.floats(-math.pi, math.pi)
normals = st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda n: np.linalg.norm(n) > 0.01)


def vector(convention, *components):
    return convention.project(convention.velocity(components))


def test_a_westerly_blows_to_the_east_from_every_kind_of_source():
    east = (5.0, 0.0, 0.0)
    np.testing.assert_allclose(vector(WindConvention('to'), 5.0, 0.0, 0.0), east)
    np.testing.assert_allclose(vector(WindConvention('from'), -5.0, 0.0, 0.0), east)
    np.testing.assert_allclose(velocity_of_bearing(5.0, 1.5 * math.pi), east, atol=1e-14)
    np.testing.assert_allclose(velocity_of_bearing(5.0, 0.5 * math.pi, 'to'), east, atol=1e-14)


@pytest.mark.parametrize(
    ('bearing', 'blows_to'),
    [
        (0.0, (0, -1, 0)),
        (90.0, (-1, 0, 0)),
        (180.0, (0, 1, 0)),
        (270.0, (1, 0, 0)),
        (360.0, (0, -1, 0)),
    ],
)
def test_meteorological_bearings(bearing, blows_to):
    wind = velocity_of_bearing(1.0, math.radians(bearing))
    np.testing.assert_allclose(wind, blows_to, atol=1e-14)


@pytest.mark.parametrize(('scale', 'kmh'), [(0.514444, 1.852), (0.277778, 1.0)])
def test_units(scale, kmh):
    wind = vector(WindConvention(speed_scale=scale), 10.0, 0.0, 0.0)
    assert wind[0] == pytest.approx(10.0 * kmh / 3.6, rel=1e-5)


def test_a_mast_turned_to_the_left_reads_an_easterly_component_on_its_axes():
    # The x axis of the mast points north: wind along it blows north.
    convention = WindConvention(yaw_offset=0.5 * math.pi)
    np.testing.assert_allclose(vector(convention, 3.0, 0.0, 0.0), (0.0, 3.0, 0.0), atol=1e-14)
    np.testing.assert_allclose(vector(convention, 0.0, 3.0, 0.0), (-3.0, 0.0, 0.0), atol=1e-14)


def test_the_vertical_is_projected_out_but_kept_in_the_velocity():
    convention = WindConvention()
    np.testing.assert_array_equal(vector(convention, 1.0, 2.0, 3.0), (1.0, 2.0, 0.0))
    np.testing.assert_array_equal(convention.velocity((1.0, 2.0, 3.0)), (1.0, 2.0, 3.0))


@given(u=speeds, v=speeds, w=speeds, yaw=angles, normal=normals)
def test_the_vector_lies_in_the_plane_and_projecting_twice_changes_nothing(u, v, w, yaw, normal):
    convention = WindConvention('from', 0.5, yaw, normal)
    wind = vector(convention, u, v, w)
    assert abs(wind @ convention.normal) < 1e-13 * 40
    np.testing.assert_allclose(convention.project(wind), wind, atol=1e-13 * 40)


@given(u=speeds, v=speeds, w=speeds, yaw=angles, normal=normals, k=st.floats(0.1, 10.0))
def test_linear_and_mirrored_by_the_other_convention(u, v, w, yaw, normal, k):
    to, other = WindConvention('to', k, yaw, normal), WindConvention('from', k, yaw, normal)
    wind = vector(to, u, v, w)
    np.testing.assert_allclose(vector(other, u, v, w), -wind, atol=1e-10)
    np.testing.assert_allclose(vector(other, -u, -v, -w), wind, atol=1e-10)
    unit = WindConvention('to', 1.0, yaw, normal)
    np.testing.assert_allclose(k * vector(unit, u, v, w), wind, atol=1e-10)


@given(u=speeds, v=speeds, w=speeds, yaw=angles)
def test_velocity_keeps_its_magnitude(u, v, w, yaw):
    velocity = WindConvention(yaw_offset=yaw).velocity((u, v, w))
    assert np.linalg.norm(velocity) == pytest.approx(math.hypot(u, v, w), abs=1e-12)


@pytest.mark.parametrize('bad', [math.nan, math.inf, -math.inf])
def test_a_bad_number_comes_out_as_not_finite_and_without_a_warning(bad):
    convention = WindConvention(yaw_offset=0.3)
    with warnings.catch_warnings():
        warnings.simplefilter('error')
        assert not np.isfinite(convention.velocity((1.0, bad, 0.0))).all()
        assert not np.isfinite(convention.velocity((1.0, 0.0, bad))).all()


@pytest.mark.parametrize(
    ('options', 'match'),
    [
        ({'direction_convention': 'towards'}, "direction convention 'towards'; .*to, from"),
        ({'speed_scale': 0.0}, 'speed_scale'),
        ({'speed_scale': -1.0}, 'speed_scale'),
        ({'speed_scale': math.nan}, 'speed_scale'),
        ({'yaw_offset': math.inf}, 'yaw_offset'),
        ({'plane_normal': (0.0, 0.0, 0.0)}, 'plane_normal.*no direction'),
        ({'plane_normal': (0.0, math.nan, 1.0)}, 'plane_normal'),
        ({'plane_normal': (0.0, 1.0)}, 'plane_normal'),
    ],
)
def test_what_cannot_be_read_is_refused(options, match):
    with pytest.raises(ParameterError, match=match):
        WindConvention(**options)


def test_a_normal_of_any_length_will_do():
    for length in (1e-11, 1.0, 1e200):
        np.testing.assert_allclose(WindConvention(plane_normal=(0, length, 0)).normal, (0, 1, 0))
