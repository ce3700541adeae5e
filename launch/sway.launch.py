# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Launch a tree that sways: a source of wind, the wind node, the solver, and RViz if asked for.

    ros2 launch tree_sway_ros sway.launch.py tree:=goldcrest source:=player file:=wind.csv

Every name is relative: two launches with different ``namespace`` are two trees side by side. With
``shards`` the trees of a stand are shared out among this number of solvers, on one host or on
several.
"""

import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

PACKAGE = 'tree_sway_ros'
WIND = 'wind/filtered'
SOURCES = {
    'simulated': ['anemometer'],
    'player': ['player'],
    'sensor': ['sensor'],
    'live': [],
    'elsewhere': [],
}
ARGUMENTS = (
    ('tree', '', 'The solver opens this built-in tree, or file; as configured if empty.'),
    ('source', 'simulated', 'The wind comes from here.', [*SOURCES]),
    ('file', '', 'The player plays this wind record, for source:=player.'),
    ('reader_options', '', "Options for the reader of the file: 'topic=/mast/wind yaw=1.57'."),
    ('start', '', 'Time skipped at the beginning of the record [s].'),
    ('playback_rate', '', 'Playback rate of the record; as configured if empty.'),
    ('loop', '', 'The record is played over and over; as configured if empty.'),
    ('address', '', 'The instrument of source:=sensor is here, such as tcp://host:port.'),
    ('wind_topic', 'wind', 'The wind of source:=live is on this topic.'),
    ('rate', '', 'Frames per second of the solver; as configured if empty.'),
    ('pose', '', "Place of the tree in its frame: '3 0 0 1.57' for x y z [m] and yaw [rad]."),
    ('frame_id', '', 'All that is published is in this frame; as configured if empty.'),
    ('namespace', '', 'All nodes and topics are in this namespace: one per tree.'),
    ('params_file', '', 'The values of this ROS parameter file override those of config/.'),
    ('use_sim_time', '', 'Nodes follow /clock, which the player of source:=player publishes.'),
    ('autostart', '', 'False leaves the start of nodes to a lifecycle manager.'),
    ('shards', '1', "Number of solvers that share the trees of a stand, in 'shard<n>'."),
    ('here', '', 'These shards run on this host, such as 0,1; all of them if empty.'),
    ('page', 'false', 'The viewer serves a page for the browser.'),
    ('rviz', 'false', 'RViz is started.'),
)


def generate_launch_description():
    """Declare the arguments and start what they ask for."""
    declared = [
        DeclareLaunchArgument(
            name, default_value=default, description=text, choices=(more or [None])[0]
        )
        for name, default, text, *more in ARGUMENTS
    ]
    return LaunchDescription([*declared, OpaqueFunction(function=start_nodes)])


def start_nodes(context):
    """Make the nodes that the arguments ask for."""
    given = {name: LaunchConfiguration(name).perform(context) for name, *_ in ARGUMENTS}
    config = os.path.join(get_package_share_directory(PACKAGE), 'config')
    source = SOURCES[given['source']]
    viewer = ['viewer'] if is_true('page', given['page']) else []
    wind = ['wind'] if given['source'] != 'elsewhere' else []
    nodes = [make_node(name, given, config) for name in (*source, *wind)]
    if given['shards'] in ('', '1'):
        nodes += [make_node(name, given, config) for name in ('solver', *viewer)]
    elif viewer:
        raise ValueError("launch argument 'page': start a viewer in the namespace of each shard")
    else:
        around = context.launch_configurations.get('ros_namespace', '')
        nodes += [make_shard(shard, given, config, around) for shard in shards_here(given)]
    if is_true('rviz', given['rviz']):
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
    return nodes


def is_true(name, text):
    """Return whether an argument is True, true or 1; refuse what is neither true nor false."""
    if text.lower() in ('true', '1'):
        return True
    if text.lower() in ('', 'false', '0'):
        return False
    raise ValueError(f"launch argument '{name}': '{text}' is neither true nor false")


def overrides_of(name, given):
    """Values of a node's parameters that arguments ask for; nothing where nothing was given."""
    overrides = {}
    if given['frame_id'] and name != 'viewer':
        overrides['frame_id'] = given['frame_id']
    if given['use_sim_time']:
        with_clock = is_true('use_sim_time', given['use_sim_time'])
        overrides['use_sim_time'] = with_clock and name != 'player'
        if name == 'player':
            overrides['publish_clock'] = with_clock
    if given['autostart']:
        overrides['autostart'] = is_true('autostart', given['autostart'])
    if name == 'sensor' and given['address']:
        overrides['address'] = given['address']
    if name == 'player':
        names = ('file', 'reader_options')
        overrides.update({each: given[each] for each in names if given[each]})
        numbers = {'start': 'start', 'rate': 'playback_rate'}
        overrides.update({to: float(given[each]) for to, each in numbers.items() if given[each]})
        if given['loop']:
            overrides['loop'] = is_true('loop', given['loop'])
    if name == 'solver':
        if given['tree']:
            overrides['tree'] = given['tree']
        if given['rate']:
            overrides['rate'] = float(given['rate'])
        if given['pose']:
            overrides['pose'] = [float(number) for number in given['pose'].split()]
    return overrides


def shards_here(given):
    """Return the numbers of the shards that run on this host."""
    shards = int(given['shards'])
    here = [int(each) for each in given['here'].split(',')] if given['here'] else range(shards)
    if shards < 1 or not all(0 <= each < shards for each in here):
        raise ValueError(f"launch argument 'here': '{given['here']}' of {shards} shards")
    return list(here)


def make_shard(shard, given, config, around):
    """Make the solver of one shard: it receives the common wind, and is restarted if it ends."""
    wind = '/' + '/'.join(filter(None, (around.strip('/'), given['namespace'].strip('/'), WIND)))
    return make_node(
        'solver',
        {**given, 'namespace': '/'.join(filter(None, (given['namespace'], f'shard{shard}')))},
        config,
        more={'shard.index': shard, 'shard.count': int(given['shards'])},
        remappings=[(WIND, wind)],
        respawn=True,
        respawn_delay=0.2,
    )


def make_node(name, given, config, more=None, **options):
    """Make one node: its file in config/, then the user's file, then the arguments."""
    files = [os.path.join(config, f'{name}.yaml')]
    if given['params_file']:
        files.append(given['params_file'])
    is_live = name == 'wind' and given['source'] == 'live'
    return Node(
        package=PACKAGE,
        executable=name,
        name=name,
        namespace=given['namespace'],
        parameters=[*files, overrides_of(name, given) | (more or {})],
        **{'remappings': [('wind', given['wind_topic'])] if is_live else []} | options,
        output='screen',
    )
