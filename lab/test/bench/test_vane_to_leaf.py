# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Which frame shows a jump of the wind, and how late it is."""

import numpy as np
import pytest
from tree_sway_lab.bench.vane_to_leaf import lateness, time_vane_to_leaf

MARKS = [(0.0, 8.0), (1.0, 5.0), (2.0, 8.0)]


def test_the_first_frame_that_has_gone_a_tenth_of_the_jump_counts():
    rows = [
        (0.02, 0.2, 5.0),  # still the wind before
        (0.04, 0.22, 5.2),
        (0.06, 0.24, 5.6),  # shows it
        (0.08, 0.26, 8.0),
        (1.01, 1.19, 8.0),
        (1.03, 1.21, 6.0),  # shows the next
        (2.05, 2.2, 8.0),  # of the last, whose end is not known
    ]
    np.testing.assert_allclose(lateness(MARKS, np.array(rows)), [[0.06, 0.24], [0.03, 0.21]])


def test_a_jump_that_no_frame_shows_is_left_out():
    rows = np.array([(0.5, 0.6, 5.0), (1.04, 1.2, 5.0)])
    np.testing.assert_allclose(lateness(MARKS, rows), [[0.04, 0.2]])
    assert lateness(MARKS, np.zeros((0, 3))).shape == (0, 2)


@pytest.mark.long
@pytest.mark.ros
def test_the_chain_is_within_a_tenth_of_a_second():
    pytest.importorskip('rclpy', reason='ROS 2 is not installed')
    found = {each.name: each.value for each in time_vane_to_leaf(seconds=10.0)}
    for way in ('by state', 'by wind'):
        shares = [found[f'vane to leaf {way}, p{share}'] for share in (50, 95, 99)]
        assert 20.0 < shares[0] <= shares[1] <= shares[2] < 100.0
        # The playout shows it later than it arrives; steady frames shorten its delay.
        assert 0.0 < found[f'vane to leaf {way}, shown, p50'] - shares[0] < 150.0
