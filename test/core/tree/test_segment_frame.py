# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The frame of a segment: along it, and turned the least."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest

from tree_sway.core.rotation import quaternion_rotated
from tree_sway.core.tree.segment_frame import quaternions_from_x

vectors = st.tuples(*[st.floats(-3.0, 3.0)] * 3)


@settings(deadline=None)
@given(vectors.filter(lambda v: np.linalg.norm(v) > 1e-3))
def test_orientations_from_x_point_along_and_turn_the_least(v):
    u = np.array(v) / np.linalg.norm(v)
    (q,) = quaternions_from_x(u[None])
    assert quaternion_rotated(q[None], np.eye(3)[:1])[0] == pytest.approx(u, abs=1e-9)
    assert 2.0 * np.arccos(np.clip(q[0], -1, 1)) == pytest.approx(np.arccos(u[0]), abs=1e-6)


def test_the_direction_against_x_has_an_orientation_too():
    against = np.array([[-1.0, 0.0, 0.0], [-1.0, 1e-9, 0.0], [1.0, 0.0, 0.0]])
    q = quaternions_from_x(against)
    assert np.linalg.norm(q, axis=1) == pytest.approx(1.0)
    assert quaternion_rotated(q, np.eye(3)[[0, 0, 0]]) == pytest.approx(against, abs=1e-6)
