# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from pathlib import Path
import subprocess
import sys

import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytest.importorskip('launch_ros', reason='launch_ros is not installed')
pytest.importorskip('launch_testing', reason='launch_testing is not installed')
pytestmark = pytest.mark.ros

CHAIN = Path(__file__).with_name('chain_under_launch_testing.py')


def test_the_chain_streams_and_ends_well(environment, tree_file):
    command = [
        sys.executable,
        '-m',
        'launch_testing.launch_test',
        str(CHAIN),
        f'tree:={tree_file}',
    ]
    run = subprocess.run(
        command, env=environment, capture_output=True, text=True, timeout=240.0, check=False
    )
    assert run.returncode == 0, run.stdout + run.stderr
    assert 'test_every_node_ended_well' in run.stdout + run.stderr
