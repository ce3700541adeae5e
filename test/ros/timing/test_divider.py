# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import pytest

from tree_sway_ros.timing.divider import Divider


@pytest.mark.parametrize('every', [1, 2, 3, 7])
def test_the_divider_lets_one_in_n_pass(every):
    divider = Divider()
    due = [divider.is_due(index, every) for index in range(100, 100 + 10 * every)]
    assert sum(due) in (10, 11)


def test_the_divider_loses_no_frame_to_a_late_tick():
    divider = Divider()
    assert [divider.is_due(index, 3) for index in (0, 1, 4, 5, 7, 20)] == [
        True,
        False,
        True,
        False,
        True,
        True,
    ]
