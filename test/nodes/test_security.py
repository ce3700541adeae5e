# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What comes from outside is never run, and the policy for SROS2 names what nodes say and hear."""

import ast
from pathlib import Path
from xml.etree import ElementTree

import pytest

from tree_sway_ros.parameters.node_parameters import NODE_PARAMETERS
from tree_sway_ros.process.topics import TOPICS

ROOT = Path(__file__).parents[2]
POLICY = ElementTree.parse(ROOT / 'config' / 'sros2_policy.xml').getroot()
RUN = {'eval', 'exec', 'compile', '__import__'}
UNSAFE = {'load', 'load_all', 'full_load', 'unsafe_load', 'Loader', 'FullLoader', 'UnsafeLoader'}


def runs_what_it_reads(source):
    """Names by which a module might run what it reads."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import | ast.ImportFrom):
            names = [getattr(node, 'module', None) or '', *(each.name for each in node.names)]
            yield from {'pickle', 'marshal', 'shelve', 'dill'} & set(names)
        elif isinstance(node, ast.Name) and node.id in RUN:
            yield node.id
        elif isinstance(node, ast.Attribute) and getattr(node.value, 'id', '') == 'yaml':
            yield from {node.attr} & UNSAFE
        elif isinstance(node, ast.keyword) and node.arg == 'allow_pickle':
            yield 'allow_pickle'


def test_no_file_and_no_message_is_run():
    found = {
        path.name: set(runs_what_it_reads(path.read_text(encoding='utf-8')))
        for package in ('tree_sway', 'tree_sway_ros')
        for path in (ROOT / package).rglob('*.py')
    }
    assert not {name: names for name, names in found.items() if names}


@pytest.mark.parametrize(
    'text', ['import pickle', "eval('1')", 'yaml.load(f, Loader)', 'np.load(f, allow_pickle=True)']
)
def test_the_check_sees_what_it_looks_for(text):
    assert list(runs_what_it_reads(text))


@pytest.mark.parametrize('name', ['tree', 'file', 'species', 'certificate', 'private_key'])
def test_nobody_in_the_graph_names_a_file(name):
    named = [each for table in NODE_PARAMETERS.values() for each in table if each.name == name]
    assert named
    assert not any(each.live for each in named)


def test_no_parameter_is_a_secret():
    """Whoever is in the graph may read parameters: a token is in a file of its owner's."""
    names = {each.name for table in NODE_PARAMETERS.values() for each in table}
    assert 'token_file' in names
    assert not {name for name in names if name.endswith(('token', 'password', 'secret'))}


def test_every_node_has_an_enclave():
    assert {each.get('node') for each in POLICY.iter('profile')} == set(NODE_PARAMETERS)
    paths = {each.get('path') for each in POLICY.iter('enclave')}
    assert paths == {f'/tree_sway/{name}' for name in NODE_PARAMETERS}


def test_every_topic_may_be_said_by_somebody():
    allowed = {
        topic.text for topics in POLICY.iter('topics') if topics.get('publish') for topic in topics
    }
    assert {topic.name for topic in TOPICS} - allowed == {
        'camera',
        'imu',
        'image',
        '~/push',
        '~/pull',
        '~/wind_at',
    }  # of others


@pytest.mark.ros
def test_what_nodes_say_and_hear_is_allowed(compose, tree_file):
    pytest.importorskip('rclpy', reason='ROS 2 is not installed')
    parameters = {'solver': {'tree': tree_file}, 'wind': {}, 'anemometer': {}, 'sensor': {}}
    parameters['player'] = {
        'file': 'canopy',
        'publish_clock': True,
    }
    nodes = compose(**parameters).nodes
    assert {node.get_name() for node in nodes} >= set(parameters)
    for node in nodes:
        profile = next(p for p in POLICY.iter('profile') if p.get('node') == node.get_name())
        for way, made in (('publish', node.publishers), ('subscribe', node.subscriptions)):
            allowed = {t.text for topics in profile if topics.get(way) for t in topics}
            allowed = {f'/{name.replace("~", node.get_name()).lstrip("/")}' for name in allowed}
            assert {each.topic_name for each in made} <= allowed, (node.get_name(), way)
