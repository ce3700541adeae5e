# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import importlib.util
from pathlib import Path
import re
import sys
from unittest.mock import MagicMock
from xml.etree import ElementTree

import pytest
import yaml

from tree_sway_ros.process.topics import TOPICS  # noqa: I100

ROOT = Path(__file__).parents[2]
HAS_LAUNCH = importlib.util.find_spec('launch_ros') is not None


def require_launch():
    if not HAS_LAUNCH:
        pytest.skip('launch_ros is not installed')


@pytest.fixture
def launch_file(monkeypatch):
    """Load the launch file as a module; without ROS's launch, its functions of values alone."""
    if not HAS_LAUNCH:
        for name in ('launch', 'launch.actions', 'launch_ros', 'launch_ros.actions'):
            monkeypatch.setitem(sys.modules, name, MagicMock())
    path = ROOT / 'launch' / 'sway.launch.py'
    spec = importlib.util.spec_from_file_location('sway_launch', path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def overrides_of(launch_file):
    """Give the overrides of a node by some arguments."""
    defaults = {name: default for name, default, _ in launch_file.ARGUMENTS}
    return lambda node, **given: launch_file.overrides_of(node, defaults | given)


def start(launch_file, monkeypatch, **given):
    require_launch()
    from launch import LaunchContext

    monkeypatch.setattr(launch_file, 'get_package_share_directory', lambda _: str(ROOT))
    context = LaunchContext()
    context.launch_configurations.update({name: d for name, d, _ in launch_file.ARGUMENTS} | given)
    actions = launch_file.start_nodes(context)
    return {each.node_executable: each for each in actions if hasattr(each, 'node_executable')}


def test_parameters_of_annexes_are_arguments(launch_file, overrides_of):
    assert {'imu', 'learn', 'history'} <= {name for name, _, _ in launch_file.ARGUMENTS}
    assert overrides_of('solver', imu='tree/imu@3.2') == {'imu': 'tree/imu@3.2'}


@pytest.mark.parametrize(
    ('source', 'executables'),
    [
        ('simulated', {'anemometer', 'wind', 'solver'}),
        ('player', {'player', 'wind', 'solver'}),
        ('topic', {'wind', 'solver'}),
        ('sensor', {'sensor', 'wind', 'solver'}),
        ('remote', {'solver'}),
    ],
)
def test_the_source_chooses_the_nodes(launch_file, monkeypatch, source, executables):
    assert set(start(launch_file, monkeypatch, wind_source=source)) == executables


def test_shards_hear_one_wind_and_speak_in_namespaces_of_their_own(launch_file):
    given = {name: default for name, default, _ in launch_file.ARGUMENTS}
    given |= {'shard_count': '3', 'namespace': 'wood'}
    assert launch_file.shards_here(given) == [0, 1, 2]
    assert launch_file.shards_here(given | {'local_shards': '2,0'}) == [2, 0]
    for wrong in ({'local_shards': '3'}, {'local_shards': '-1'}, {'shard_count': '0'}):
        with pytest.raises(ValueError, match="'local_shards'"):
            launch_file.shards_here(given | wrong)
    require_launch()
    node = launch_file.make_shard(2, given, str(ROOT / 'config'), '/north')
    assert node.expanded_node_namespace in ('wood/shard2', node.UNSPECIFIED_NODE_NAMESPACE)


def test_a_host_that_hears_the_wind_of_another_starts_solvers_alone(launch_file, monkeypatch):
    nodes = start(
        launch_file, monkeypatch, wind_source='remote', shard_count='2', local_shards='1'
    )
    assert set(nodes) == {'solver'}
    with pytest.raises(ValueError, match='use_viewer'):
        start(launch_file, monkeypatch, shard_count='2', use_viewer='true')


def test_page_and_rviz_are_started_if_asked_for(launch_file, monkeypatch):
    assert 'viewer' in start(launch_file, monkeypatch, use_viewer='1')
    assert 'rviz2' in start(launch_file, monkeypatch, use_rviz='true')


@pytest.mark.parametrize('word', ['True', 'true', '1'])
def test_yes_is_yes_however_it_is_written(launch_file, overrides_of, monkeypatch, word):
    nodes = start(launch_file, monkeypatch, use_sim_time=word, use_rviz=word, wind_source='player')
    assert 'rviz2' in nodes
    assert overrides_of('solver', use_sim_time=word) == {'use_sim_time': True}
    assert overrides_of('player', use_sim_time=word) == {
        'use_sim_time': False,
        'publish_clock': True,
    }


def test_neither_yes_nor_no_is_refused(overrides_of):
    with pytest.raises(ValueError, match="'use_sim_time': 'maybe' is neither true nor false"):
        overrides_of('wind', use_sim_time='maybe')


def test_arguments_that_are_not_given_override_nothing(overrides_of):
    for name in ('anemometer', 'player', 'wind', 'solver'):
        assert overrides_of(name) == {}
    placed = overrides_of('solver', pose='3 0 0 1.57')
    assert placed == {'pose': [3.0, 0.0, 0.0, 1.57]}


def test_the_player_learns_how_to_read_and_where_to_begin(overrides_of):
    given = {'reader_options': 'topic=/mast/wind yaw=1.57'}
    given |= {'playback_start': '30', 'playback_rate': '2', 'playback_loop': 'False'}
    overrides = overrides_of('player', **given)
    assert overrides == {
        'reader_options': 'topic=/mast/wind yaw=1.57',
        **{'start': 30.0, 'rate': 2.0, 'loop': False},
    }
    assert overrides_of('solver', **given) == {}


def test_what_is_shipped_in_config_overrides_no_default():
    for name in ('anemometer', 'player', 'sensor', 'wind', 'solver'):
        content = yaml.safe_load((ROOT / 'config' / f'{name}.yaml').read_text())
        assert content == {f'/**/{name}': {'ros__parameters': {}}}


def test_a_misspelled_argument_is_told(launch_file):
    typed = {'wind_sorce': 'player', 'ros_namespace': '/elm', 'other_package': 'x'}
    _, warnings = launch_file.arguments_given(typed)
    assert warnings == ["no launch argument 'wind_sorce'; did you mean 'wind_source'?"]
    _, warnings = launch_file.arguments_given({'speed': '12'})
    assert warnings == ["no launch argument 'speed'; did you mean 'mean_speed'?"]


@pytest.mark.parametrize(
    ('name', 'value', 'source'),
    [
        ('wind_file', 'storm.csv', 'player'),
        ('sensor_address', 'udp://:10110', 'sensor'),
        ('wind_topic', '/mast/wind', 'topic'),
        ('mean_speed', '12', 'simulated'),
    ],
)
def test_an_argument_of_a_source_that_is_not_started_is_told(launch_file, name, value, source):
    for chosen in launch_file.SOURCES:
        _, warnings = launch_file.arguments_given({name: value, 'wind_source': chosen})
        said = f"'{name}' has no effect with wind_source:={chosen}; give {source}"
        assert warnings == ([] if chosen == source else [f'launch argument {said}'])


@pytest.mark.parametrize(
    'given', [{'shard_count': 'two'}, {'shard_count': '2', 'local_shards': 'a'}]
)
def test_a_number_of_shards_that_is_none_is_named(launch_file, given):
    with pytest.raises(
        ValueError, match=r"launch argument '(shard_count|local_shards)': '(two|a)'"
    ):
        launch_file.shards_here({'local_shards': ''} | given)


@pytest.mark.parametrize(
    ('node', 'name'),
    [
        ('player', 'playback_rate'),
        ('player', 'playback_start'),
        ('solver', 'solver_rate'),
        ('solver', 'pose'),
    ],
)
def test_a_number_that_is_none_is_named(overrides_of, node, name):
    with pytest.raises(ValueError, match=f"launch argument '{name}': 'fast' is no number"):
        overrides_of(node, **{name: 'fast'})


def test_an_argument_is_checked_as_the_parameter_that_it_is(overrides_of):
    given = {'model': 'full', 'species': 'ash', 'leaves': 'on', 'wind_delay': '0.5'}
    assert overrides_of('solver', **given) == {**given, 'wind_delay': 0.5}
    assert overrides_of('wind', **given, mean_speed='9') == {}
    assert overrides_of('anemometer', mean_speed='9') == {'mean_speed': 9.0}
    apart = {'anemometer_distance': '12', 'anemometer_bearing': '4.7', 'gust_seed': '7'}
    assert overrides_of('solver', **apart) == {name: float(text) for name, text in apart.items()}
    assert overrides_of('player', shard_count='3') == {'subscribers': 3}
    with pytest.raises(ValueError, match=r"argument 'wind_delay': 3 is out of range; give 0 .. 2"):
        overrides_of('solver', wind_delay='3')
    with pytest.raises(ValueError, match=r"argument 'model': 'ful' is not .*'full'"):
        overrides_of('solver', model='ful')


@pytest.mark.parametrize(
    ('content', 'reason'),
    [
        (None, 'No such file'),
        ('solver: [1', 'while parsing'),
        (b'\xff\xfe', 'decode'),
        ('', 'has no section ros__parameters'),
        ('solver:\n  rate: 30.0\n', 'has no section ros__parameters'),
    ],
)
def test_a_parameter_file_that_cannot_be_used_is_named(launch_file, tmp_path, content, reason):
    path = tmp_path / 'mine.yaml'
    if content is not None:
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(ValueError, match=rf"argument 'params_file': .*mine[.]yaml:? .*{reason}"):
        launch_file.refuse_params_file(str(path))


def test_a_parameter_file_of_any_namespace_is_used(launch_file, tmp_path):
    path = tmp_path / 'mine.yaml'
    for heading in ('solver:', '/**:', '/park:\n solver:'):
        path.write_text(f'{heading}\n  ros__parameters:\n    rate: 30.0\n')
        launch_file.refuse_params_file(str(path))


def test_a_source_that_does_not_exist_is_refused(launch_file):
    with pytest.raises(ValueError, match="'wind_source': 'mast' is none of simulated, player"):
        launch_file.arguments_given({'wind_source': 'mast'})


def test_every_argument_is_declared(launch_file):
    require_launch()
    declared = {action.name for action in launch_file.generate_launch_description().entities[:-1]}
    assert declared == {name for name, *_ in launch_file.ARGUMENTS}


def test_the_pages_give_arguments_that_exist(launch_file):
    declared = {name for name, *_ in launch_file.ARGUMENTS}
    pages = ''.join(path.read_text(encoding='utf-8') for path in (ROOT / 'doc').rglob('*.md'))
    given = re.findall(r'launch_arguments=\{(.*?)\}', pages, re.DOTALL)
    typed = re.findall(r'sway\.launch\.py((?: +\S+:=\S+)+)', pages)
    names = re.findall(r'"(\w+)":', ' '.join(given)) + re.findall(r'(\w+):=', ' '.join(typed))
    assert {'wind_source', 'pose'} <= {*names}
    assert {*names} <= declared


def test_rviz_shows_our_topics():
    config = yaml.safe_load((ROOT / 'config' / 'tree_sway.rviz').read_text())
    manager = config['Visualization Manager']
    shown = [d['Topic'] for d in manager['Displays'] if 'Topic' in d]
    by_name = {topic.name: topic for topic in TOPICS}
    assert {topic['Value'] for topic in shown} == {'markers', 'segment_poses', 'wind/force_plane'}
    for topic in shown:
        assert by_name[topic['Value']].reliable == (topic['Reliability Policy'] == 'Reliable')
    assert manager['Global Options']['Fixed Frame'] == 'map'


def test_the_transport_profile_has_room():
    root = ElementTree.parse(ROOT / 'config' / 'fastdds.xml').getroot()
    space = '{http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles}'
    assert int(root.find(f'.//{space}segment_size').text) == 32 * 2**20
    assert int(root.find(f'.//{space}receiveBufferSize').text) == 4_194_304
    transports = {item.text for item in root.iterfind(f'.//{space}transport_id')}
    assert transports == {'large_shared_memory', 'large_sockets'}
