# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Another launch file: two trees side by side, one mast, values set for every node."""

import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node, PushRosNamespace, SetParameter, SetRemap


def generate_launch_description():
    """Start the mast and both trees."""
    share = get_package_share_directory('tree_sway_ros')
    sway = PythonLaunchDescriptionSource(os.path.join(share, 'launch', 'sway.launch.py'))

    def tree(name, pose):
        parameters = {
            'tree': LaunchConfiguration('tree'),
            'params_file': LaunchConfiguration('parameters'),
        }
        return GroupAction(
            [
                PushRosNamespace(name),
                SetRemap('wind', '/mast/wind'),
                IncludeLaunchDescription(
                    sway,
                    launch_arguments={
                        **parameters,
                        'wind_source': 'topic',
                        'pose': pose,
                    }.items(),
                ),
            ]
        )

    mast = Node(
        package='tree_sway_ros',
        executable='anemometer',
        namespace='mast',
        name='anemometer',
        parameters=[{'mean_speed': 9.0}],
    )
    return LaunchDescription(
        [
            DeclareLaunchArgument('tree'),
            DeclareLaunchArgument('parameters'),
            SetParameter('exposure', 0.1),
            SetParameter('gravity', 9.0),
            mast,
            tree('elm', '0 0 0 0'),
            tree('oak', '5 0 0 0'),
        ]
    )
