# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The one way in: units and sign before the gate, the force plane after it, one set of limits."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

from tree_sway.core.settings import Settings
from tree_sway.core.wind.convention import WindConvention
from tree_sway.core.wind.gate import SECOND, WindGate
from tree_sway.core.wind.intake import WindIntake
from tree_sway.core.wind.limits import FASTEST_WIND, is_wind
from tree_sway.errors import ParameterError

KNOTS = 1852.0 / 3600.0


def test_a_sample_is_read_judged_and_projected():
    intake = WindIntake(WindConvention('from', speed_scale=KNOTS, plane_normal=(0.0, 1.0, 0.0)))
    good = intake.offer(5 * SECOND, (10.0, 4.0, 2.0))
    assert good is not None
    assert good.time == 5 * SECOND
    assert good.velocity == pytest.approx([-10.0 * KNOTS, 0.0, -2.0 * KNOTS])
    assert intake.left_out == pytest.approx(-4.0 * KNOTS)


def test_it_is_judged_in_metres_per_second_before_it_is_projected():
    intake = WindIntake(WindConvention(speed_scale=KNOTS))
    assert intake.offer(SECOND, (70.0, 0.0, 0.0)) is not None  # 36 m/s
    assert intake.offer(2 * SECOND, (70.0, 0.0, 60.0)) is None
    assert (intake.counts.accepted, intake.counts.too_fast) == (1, 1)


def test_velocities_are_taken_as_they_are():
    intake = WindIntake.of_velocities()
    good = intake.offer(SECOND, (30.0, -120.0, 40.0))
    assert good is not None
    assert good.velocity == pytest.approx([30.0, -120.0, 40.0])
    assert intake.offer(2 * SECOND, (150.1, 0.0, 0.0)) is None
    assert intake.offer(3 * SECOND, (float('nan'), 0.0, 0.0)) is None


def test_one_limit_behind_every_door():
    above = 1.001 * FASTEST_WIND
    assert is_wind(FASTEST_WIND, 0.0, 0.0)
    assert not is_wind(above, 0.0, 0.0)
    WindGate(max_speed=FASTEST_WIND)
    Settings(max_wind=FASTEST_WIND)
    with pytest.raises(ParameterError, match='max_speed'):
        WindGate(max_speed=above)
    with pytest.raises(ParameterError, match='max_wind'):
        Settings(max_wind=above)


@given(
    st.tuples(*[st.floats(-100.0, 100.0)] * 3),
    st.sampled_from(['to', 'from']),
    st.floats(0.1, 10.0),
    st.floats(-3.0, 3.0),
)
def test_what_is_written_is_what_is_read(velocity, sign, scale, yaw):
    convention = WindConvention(sign, scale, yaw)
    components = convention.components(velocity)
    np.testing.assert_allclose(convention.velocity(components), velocity, atol=1e-9)
    np.testing.assert_allclose(
        convention.velocity(np.array([components, components])), [velocity] * 2, atol=1e-9
    )
