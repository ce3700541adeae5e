# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Launch a tree that sways: a source of wind, the wind node, the solver, and RViz if asked for.

    ros2 launch tree_sway_ros sway.launch.py tree:=oak.yaml wind_source:=player wind_file:=wind.csv

``params_file`` sets any parameter of any node; the other arguments are for the values that change
from start to start, and override it. Every name is relative: two launches with different
``namespace`` are two trees side by side. With ``shard_count`` the trees of a stand are shared out
among this number of solvers, on one host or on several.
"""

from difflib import get_close_matches
import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, LogInfo, OpaqueFunction
from launch_ros.actions import Node
import yaml

from tree_sway.errors import ParameterError
from tree_sway_ros.parameters import ANNEXES, NODE_PARAMETERS

PACKAGE = 'tree_sway_ros'
WIND = 'wind/filtered'
SOURCES = {
    'simulated': ['anemometer', 'wind'],
    'player': ['player', 'wind'],
    'sensor': ['sensor', 'wind'],
    'topic': ['wind'],
    'remote': [],
}
"""Nodes of each source of wind."""

PARAMETERS = {node: {each.name: each for each in table} for node, table in NODE_PARAMETERS.items()}

OF_PARAMETERS = {
    'tree': ('solver', 'tree'),
    'species': ('solver', 'species'),
    'leaves': ('solver', 'leaves'),
    'model': ('solver', 'model'),
    'solver_rate': ('solver', 'rate'),
    'wind_delay': ('solver', 'wind_delay'),
    'pose': ('solver', 'pose'),
    'anemometer_distance': ('solver', 'anemometer_distance'),
    'anemometer_bearing': ('solver', 'anemometer_bearing'),
    'gusts': ('solver', 'gusts'),
    'gust_seed': ('solver', 'gust_seed'),
    **{each.name: ('solver', each.name) for table in ANNEXES.values() for each in table},
    'mean_speed': ('anemometer', 'mean_speed'),
    'sensor_address': ('sensor', 'address'),
    'wind_file': ('player', 'file'),
    'reader_options': ('player', 'reader_options'),
    'playback_start': ('player', 'start'),
    'playback_rate': ('player', 'rate'),
    'playback_loop': ('player', 'loop'),
    'frame_id': ('', 'frame_id'),
    'autostart': ('', 'autostart'),
}
"""Parameter of a node, or of every node that has it, by the argument; as configured if empty."""

ARGUMENTS = (
    (
        'wind_source',
        'simulated',
        'Where the wind comes from: simulated, player (a record), sensor (an anemometer), topic '
        '(of its driver), or remote (wind/filtered of another host).',
    ),
    *(
        (name, '', PARAMETERS[node or 'solver'][key].description)
        for name, (node, key) in OF_PARAMETERS.items()
    ),
    ('wind_topic', 'wind', 'Topic of the driver, for wind_source:=topic.'),
    ('namespace', '', 'Namespace of all nodes and topics: one per tree.'),
    ('params_file', '', 'ROS parameter file, whose values override those of config/.'),
    ('use_sim_time', '', 'Follow /clock, which the player of wind_source:=player publishes.'),
    ('shard_count', '1', "Number of solvers that share the trees of a stand, in 'shard<n>'."),
    ('local_shards', '', 'Shards that run on this host, such as 0,1; all of them if empty.'),
    ('use_viewer', 'false', 'Serve a page for the browser.'),
    ('use_rviz', 'false', 'Start RViz.'),
)


def generate_launch_description():
    """Declare the arguments and start what they ask for."""
    declared = [
        DeclareLaunchArgument(name, default_value=default, description=text)
        for name, default, text in ARGUMENTS
    ]
    return LaunchDescription([*declared, OpaqueFunction(function=start_nodes)])


def start_nodes(context):
    """Make the nodes that the arguments ask for, and warnings of the others."""
    given, warnings = arguments_given(context.launch_configurations)
    config = os.path.join(get_package_share_directory(PACKAGE), 'config')
    if given['params_file']:
        refuse_params_file(given['params_file'])
    viewer = ['viewer'] if is_true('use_viewer', given['use_viewer']) else []
    nodes = [make_node(name, given, config) for name in SOURCES[given['wind_source']]]
    if given['shard_count'] in ('', '1'):
        nodes += [make_node(name, given, config) for name in ('solver', *viewer)]
    elif viewer:
        raise ValueError(
            "launch argument 'use_viewer': start a viewer in the namespace of each shard"
        )
    else:
        around = context.launch_configurations.get('ros_namespace', '')
        nodes += [make_shard(shard, given, config, around) for shard in shards_here(given)]
    if is_true('use_rviz', given['use_rviz']):
        sim_time = {}
        if given['use_sim_time']:
            sim_time['use_sim_time'] = is_true('use_sim_time', given['use_sim_time'])
        nodes.append(
            Node(
                package='rviz2',
                executable='rviz2',
                namespace=given['namespace'],
                arguments=['-d', os.path.join(config, 'tree_sway.rviz')],
                parameters=[sim_time],
            )
        )
    return [*(LogInfo(msg=f'warning: {text}') for text in warnings), *nodes]


def arguments_given(configurations):
    """Values of the arguments, and a warning for each that changes nothing."""
    given = {name: configurations.get(name, default) for name, default, _ in ARGUMENTS}
    source = given['wind_source']
    if source not in SOURCES:
        raise ValueError(
            f"launch argument 'wind_source': '{source}' is none of {', '.join(SOURCES)}"
        )
    return given, misspelled(configurations) + unused(given)


def unused(given):
    """Return warnings for arguments of a source of wind that is not started."""
    nodes = {name: node for name, (node, _) in OF_PARAMETERS.items()} | {'wind_topic': 'topic'}
    usual = {name: default for name, default, _ in ARGUMENTS}
    chosen = given['wind_source']
    return [
        f"launch argument '{name}' has no effect with wind_source:={chosen}; give {source}"
        for name, node in nodes.items()
        for source in SOURCES
        if node in (source, *SOURCES[source][:-1]) and source != chosen
        if given[name] not in ('', usual[name])
    ]


def misspelled(configurations):
    """Return warnings for unknown arguments near a known one: launch itself ignores them."""
    known = [name for name, _, _ in ARGUMENTS]
    warnings = []
    for name in configurations:
        if name not in known:
            words = [each for each in known if name in each.split('_')]
            for near in get_close_matches(name, known, 1, 0.85) or words[:1]:
                warnings.append(f"no launch argument '{name}'; did you mean '{near}'?")
    return warnings


def is_true(name, text):
    """Return whether an argument is True, true or 1; refuse what is neither true nor false."""
    if text.lower() in ('true', '1'):
        return True
    if text.lower() in ('', 'false', '0'):
        return False
    raise ValueError(f"launch argument '{name}': '{text}' is neither true nor false")


def overrides_of(name, given):
    """Values of a node's parameters that arguments ask for; nothing where nothing was given."""
    overrides = {
        key: value_of(argument, given[argument], PARAMETERS[name][key])
        for argument, (node, key) in OF_PARAMETERS.items()
        if given[argument] and node in (name, '') and key in PARAMETERS[name]
    }
    if given['use_sim_time']:
        with_clock = is_true('use_sim_time', given['use_sim_time'])
        overrides['use_sim_time'] = with_clock and name != 'player'
        if name == 'player':
            overrides['publish_clock'] = with_clock
    if name == 'player' and given['shard_count'] not in ('', '1'):
        overrides['subscribers'] = whole('shard_count', given['shard_count'])
    return overrides


def value_of(name, text, parameter):
    """Return the value of an argument for a parameter; refuse what that does not accept."""
    kind = type(parameter.default)
    try:
        if kind is tuple:
            return list(parameter.checked([number(name, each) for each in text.split()]))
        return parameter.checked(number(name, text) if kind in (int, float) else text)
    except ParameterError as error:
        raise ValueError(str(error.at(f"launch argument '{name}'"))) from None


def refuse_params_file(path):
    """Refuse a file without parameters: a missing one would be left out with a mere warning."""
    try:
        with open(path, encoding='utf-8') as file:
            content = yaml.safe_load(file)
    except (OSError, ValueError, yaml.YAMLError) as error:
        reason = ' '.join(str(error).split())
        raise ValueError(f"launch argument 'params_file': {path}: {reason}") from None
    if not has_parameters(content):
        raise ValueError(
            f"launch argument 'params_file': {path} has no section ros__parameters; write\n"
            'solver:\n  ros__parameters:\n    rate: 60.0'
        )


def has_parameters(content):
    """Return whether a section of a parameter file, or one within it, has parameters."""
    return isinstance(content, dict) and (
        'ros__parameters' in content or any(map(has_parameters, content.values()))
    )


def number(name, text):
    """Return the number of an argument; refuse what is none."""
    try:
        return float(text)
    except ValueError:
        raise ValueError(f"launch argument '{name}': '{text}' is no number") from None


def whole(name, text):
    """Return the whole number of an argument; refuse what is none."""
    try:
        return int(text)
    except ValueError:
        raise ValueError(f"launch argument '{name}': '{text}' is no whole number") from None


def shards_here(given):
    """Return the numbers of the shards that run on this host."""
    local = given['local_shards']
    count = whole('shard_count', given['shard_count'])
    here = [whole('local_shards', each) for each in local.split(',')] if local else range(count)
    if count < 1 or not all(0 <= each < count for each in here):
        raise ValueError(f"launch argument 'local_shards': '{local}' of {count} shards")
    return list(here)


def make_shard(shard, given, config, around):
    """Make the solver of one shard: it receives the common wind, and is restarted if it ends."""
    wind = '/' + '/'.join(filter(None, (around.strip('/'), given['namespace'].strip('/'), WIND)))
    return make_node(
        'solver',
        {**given, 'namespace': '/'.join(filter(None, (given['namespace'], f'shard{shard}')))},
        config,
        more={'shard.index': shard, 'shard.count': int(given['shard_count'])},
        remappings=[(WIND, wind)],
        respawn=True,
        respawn_delay=0.2,
    )


def make_node(name, given, config, more=None, **options):
    """Make one node: its file in config/, then the user's file, then the arguments."""
    files = [os.path.join(config, f'{name}.yaml')]
    if given['params_file']:
        files.append(given['params_file'])
    has_driver = name == 'wind' and given['wind_source'] == 'topic'
    return Node(
        package=PACKAGE,
        executable=name,
        name=name,
        namespace=given['namespace'],
        parameters=[*files, overrides_of(name, given) | (more or {})],
        **{'remappings': [('wind', given['wind_topic'])] if has_driver else []} | options,
        output='screen',
    )
