"""
Launch a tree that sways: a source of wind, the wind node, the solver, and RViz if asked for.

    ros2 launch tree_sway_ros sway.launch.py tree:=goldcrest source:=player file:=wind.csv

Every name is relative: two launches with different ``namespace`` are two trees side by side.

"""

import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

PACKAGE = "tree_sway_ros"
ARGUMENTS = (
    ("tree", "", "benjamina, goldcrest, broadleaf, or a file of trees; as configured if empty"),
    ("source", "simulated", "where the wind comes from", ["simulated", "player", "live"]),
    ("file", "", "wind record for source:=player"),
    ("wind_topic", "wind", "topic of the wind for source:=live"),
    ("rate", "", "frames a second; as configured if empty"),
    ("namespace", "", "of all nodes and topics: one a tree"),
    ("params_file", "", "ROS parameter file whose values override those of config/"),
    ("use_sim_time", "false", "follow /clock; with source:=player the player publishes it"),
    ("rviz", "false", "start RViz", ["true", "false"]),
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
    config = os.path.join(get_package_share_directory(PACKAGE), "config")
    source = {"simulated": ["anemometer"], "player": ["player"], "live": []}[given["source"]]
    nodes = [make_node(name, given, config) for name in (*source, "wind", "solver")]
    if given["rviz"] == "true":
        arguments = ["-d", os.path.join(config, "tree_sway.rviz")]
        nodes.append(
            Node(
                package="rviz2",
                executable="rviz2",
                namespace=given["namespace"],
                arguments=arguments,
                parameters=[{"use_sim_time": given["use_sim_time"] == "true"}],
            )
        )
    return nodes


def make_node(name, given, config):
    """Make one node: its file in config/, then the user's file, then the arguments."""
    with_clock = given["use_sim_time"] == "true"
    overrides = {"use_sim_time": with_clock and name != "player"}
    if name == "solver" and given["tree"]:
        overrides["tree"] = given["tree"]
    if name == "solver" and given["rate"]:
        overrides["rate"] = float(given["rate"])
    if name == "player":
        overrides.update(publish_clock=with_clock)
        if given["file"]:
            overrides["file"] = given["file"]
    files = [os.path.join(config, f"{name}.yaml")]
    if given["params_file"]:
        files.append(given["params_file"])
    is_live = name == "wind" and given["source"] == "live"
    return Node(
        package=PACKAGE,
        executable=name,
        name=name,
        namespace=given["namespace"],
        parameters=[*files, overrides],
        remappings=[("wind", given["wind_topic"])] if is_live else [],
        output="screen",
    )
