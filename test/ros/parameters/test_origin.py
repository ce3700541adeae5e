# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import pytest

from tree_sway_ros.parameters.origin import own_names

FILE = """
/**:
  ros__parameters: {shared: 1}
/**/solver:
  ros__parameters: {rate: 30.0, qos_overrides: {/wind: {depth: 3}}}
wind:
  ros__parameters: {max_speed: 5.0}
oak:
  solver:
    ros__parameters: {tree: oak.yaml}
"""


@pytest.fixture
def file(tmp_path):
    path = tmp_path / 'params.yaml'
    path.write_text(FILE)
    return str(path)


def test_sections_of_the_nodes_own_name_are_its_own(file):
    told = own_names(['solver', '--ros-args', '--params-file', file], 'solver')
    assert told == {'rate', 'qos_overrides./wind.depth', 'tree'}


def test_what_is_typed_for_one_process_is_its_own():
    assert own_names(['x', '--ros-args', '-p', 'rats:=40'], 'solver') == {'rats'}


def test_what_a_launch_file_sets_for_every_node_is_shared():
    launched = [
        'x',
        '--ros-args',
        '-r',
        '__node:=solver',
        '-p',
        'rats:=40',
        '-p',
        'solver:cats:=1',
    ]
    assert own_names(launched, 'solver') == {'cats'}


@pytest.mark.parametrize('content', ['[1, 2', '- 1', '', 'solver: 3'])
def test_what_is_no_parameter_file_tells_nothing(tmp_path, content):
    path = tmp_path / 'odd.yaml'
    path.write_text(content)
    assert own_names(['x', '--ros-args', '--params-file', str(path)], 'solver') == frozenset()
    assert own_names(['x', '--params-file', 'nowhere'], 'solver') == frozenset()
