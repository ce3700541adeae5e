# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Values of no use for every parameter of running nodes: a reason, and the nodes go on."""

from __future__ import annotations

import math

import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')

from rcl_interfaces.srv import SetParameters  # noqa: E402
from rclpy.parameter import Parameter  # noqa: E402

from tree_sway_ros.process.topics import SEGMENT_POSES  # noqa: E402

pytestmark = pytest.mark.ros

BAD = [math.nan, math.inf, -math.inf, 1e300, -1e300, -(2**63), 2**63 - 1, 'nan', '', 'x' * 9999,
       True, [b'x'], [math.nan, 1.0, 2.0], [1, 2], ['a'], [True]]  # fmt: skip
NODES = 'anemometer', 'wind', 'solver', 'viewer'


def test_no_value_of_a_parameter_ends_a_node(compose, observer, tree_file):
    nodes = compose(
        anemometer={}, wind={}, solver={'tree': tree_file, 'model': '4'}, viewer={'port': 0}
    )
    frames = observer.listen(SEGMENT_POSES)
    observer.until(lambda: frames, 'poses')
    for name in NODES:
        values = nodes[name].values
        for parameter in list(values._by_name):
            asked = [Parameter(parameter, value=bad).to_parameter_msg() for bad in BAD]
            request = SetParameters.Request(parameters=asked)
            answer = observer.call(SetParameters, f'{name}/set_parameters', request)
            for result in answer.results:
                assert result.successful or result.reason
                assert 'cannot be checked' not in result.reason
            value = values[parameter]
            assert not isinstance(value, float) or math.isfinite(value)
    number = len(frames)
    observer.until(lambda: len(frames) > number + 5, 'poses')
    assert all(math.isfinite(each.position.x) for each in frames[-1].poses)
