# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C on a launch ends every process well, before launch would have to insist."""

import signal
import urllib.request

import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytestmark = pytest.mark.ros

NAMES = ('anemometer', 'wind', 'solver')


def assert_ended_well(said, names=NAMES):
    assert 'escalating' not in said, said
    assert 'Traceback' not in said, said
    for name in names:
        assert f'[{name}-' in said
    assert said.count('process has finished cleanly') == len(names), said


def test_while_it_sways_and_serves_its_page(launched, tmp_path):
    parameters = tmp_path / 'parameters.yaml'
    parameters.write_text('/**/viewer: {ros__parameters: {port: 0}}\n')
    run = launched('sway.launch.py', tree='goldcrest', use_viewer='true', params_file=parameters)
    page = run.until(r'the page is at (http://\S+)')[1]
    with urllib.request.urlopen(page, timeout=10.0) as answer:
        assert b'<canvas' in answer.read()
    run.until('ready after')
    assert_ended_well(run.end()[1], (*NAMES, 'viewer'))


def test_while_the_tree_is_reduced(launched, tmp_path):
    cold = {'TREE_SWAY_CACHE': str(tmp_path / 'cold')}
    run = launched('sway.launch.py', tree='goldcrest', environment=cold)
    run.until('reducing ')
    assert_ended_well(run.end()[1])


def test_as_a_service(launched, tree_file):
    """Nobody sends the signal to the nodes but launch itself."""
    run = launched('sway.launch.py', mode='service', tree=tree_file)
    run.until('ready after')
    run.process.send_signal(signal.SIGINT)
    assert_ended_well(run.ended()[1])
