# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import os

import pytest

# An int in a float field can end the process: have every field checked.
os.environ['ROS_PYTHON_CHECK_FIELDS'] = '1'
os.environ.setdefault('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')


@pytest.fixture
def context(domain):
    """Make a ROS context in a domain of its own."""
    rclpy = pytest.importorskip('rclpy')
    from rclpy.context import Context

    context = Context()
    rclpy.init(args=[], context=context, domain_id=domain)
    yield context
    context.try_shutdown()
