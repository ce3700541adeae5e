# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Launch a tree that sways: a source of wind, the wind node, the solver, and RViz if asked for.

    ros2 launch tree_sway_ros sway.launch.py tree:=goldcrest source:=player file:=wind.csv

Every name is relative: two launches with different ``namespace`` are two trees side by side. With
``shards`` the trees of a stand are dealt over so many solvers, on this host or on several.

"""

import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

PACKAGE = "tree_sway_ros"
WIND = "wind/filtered"
CHAIN = f"wind {WIND}"
SOURCES = {
    "simulated": ["anemometer"],
    "player": ["player"],
    "sensor": ["sensor"],
    "live": [],
    "elsewhere": [],
}
ARGUMENTS = (
    ("tree", "", "benjamina, goldcrest, broadleaf, or a file of trees; as configured if empty"),
    ("source", "simulated", "where the wind comes from", [*SOURCES]),
    ("file", "", "wind record for source:=player"),
    ("topic", "", "topic of the wind in a bag; as configured if empty"),
    ("reader_options", "", "more for the reader of the file: 'rate=20 yaw=1.57'"),
    ("address", "", "of the instrument for source:=sensor, such as tcp://host:port"),
    ("wind_topic", "wind", "topic of the wind for source:=live"),
    ("rate", "", "frames per second; as configured if empty"),
    ("x", "", "where the tree stands in the frame, to the east [m]; as configured if empty"),
    ("y", "", "the same to the north [m]"),
    ("z", "", "the same upwards [m]"),
    ("yaw", "", "turn of the tree, counterclockwise from above [rad]"),
    ("frame_id", "", "frame of all that is published; as configured if empty"),
    ("namespace", "", "of all nodes and topics: one per tree"),
    ("params_file", "", "ROS parameter file whose values override those of config/"),
    ("use_sim_time", "", "follow /clock; with source:=player the player publishes it"),
    ("lifecycle", "", "nodes wait for a lifecycle manager; as configured if empty"),
    ("shards", "1", "solvers that the trees of a stand are dealt over; each in 'shard<n>'"),
    ("here", "", "which shards run on this host, such as 0,1; all if empty"),
    ("page", "false", "serve a page for the browser: start the viewer"),
    ("rviz", "false", "start RViz"),
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
    source = SOURCES[given["source"]]
    viewer = ["viewer"] if is_true("page", given["page"]) else []
    wind = ["wind"] if given["source"] != "elsewhere" else []
    nodes = [make_node(name, given, config) for name in (*source, *wind)]
    if given["shards"] in ("", "1"):
        nodes += [make_node(name, given, config) for name in ("solver", *viewer)]
    elif viewer:
        raise ValueError("launch argument 'page': start a viewer in the namespace of each shard")
    else:
        around = context.launch_configurations.get("ros_namespace", "")
        nodes += [make_shard(shard, given, config, around) for shard in shards_here(given)]
    if is_true("rviz", given["rviz"]):
        sim_time = {}
        if given["use_sim_time"]:
            sim_time["use_sim_time"] = is_true("use_sim_time", given["use_sim_time"])
        nodes.append(
            Node(
                package="rviz2",
                executable="rviz2",
                namespace=given["namespace"],
                arguments=["-d", os.path.join(config, "tree_sway.rviz")],
                parameters=[sim_time],
            )
        )
    return nodes


def is_true(name, text):
    """Return whether an argument says yes: True, true and 1 do; refuse what is neither."""
    if text.lower() in ("true", "1"):
        return True
    if text.lower() in ("", "false", "0"):
        return False
    raise ValueError(f"launch argument '{name}': '{text}' is neither true nor false")


def overrides_of(name, given):
    """Values of a node's parameters that arguments ask for; nothing where nothing was given."""
    overrides = {}
    if given["frame_id"] and name != "viewer":
        overrides["frame_id"] = given["frame_id"]
    if given["use_sim_time"]:
        with_clock = is_true("use_sim_time", given["use_sim_time"])
        overrides["use_sim_time"] = with_clock and name != "player"
        if name == "player":
            overrides["publish_clock"] = with_clock
    if given["lifecycle"] and name != "viewer":
        overrides["lifecycle"] = is_true("lifecycle", given["lifecycle"])
    if name == "sensor" and given["address"]:
        overrides["address"] = given["address"]
    if name == "player":
        names = ("file", "topic", "reader_options")
        overrides.update({each: given[each] for each in names if given[each]})
    if name == "solver":
        if given["tree"]:
            overrides["tree"] = given["tree"]
        numbers = ("rate", "x", "y", "z", "yaw")
        overrides.update({each: float(given[each]) for each in numbers if given[each]})
    return overrides


def shards_here(given):
    """Return the numbers of the shards that run on this host."""
    shards = int(given["shards"])
    here = [int(each) for each in given["here"].split(",")] if given["here"] else range(shards)
    if shards < 1 or not all(0 <= each < shards for each in here):
        raise ValueError(f"launch argument 'here': '{given['here']}' of {shards} shards")
    return list(here)


def make_shard(shard, given, config, around):
    """Make the solver of one shard: it hears the one wind of all, and comes back if it ends."""
    wind = "/" + "/".join(filter(None, (around.strip("/"), given["namespace"].strip("/"), WIND)))
    return make_node(
        "solver",
        {**given, "namespace": "/".join(filter(None, (given["namespace"], f"shard{shard}")))},
        config,
        more={"shard": shard, "shards": int(given["shards"])},
        remappings=[(WIND, wind)],
        respawn=True,
        respawn_delay=0.2,
    )


def make_node(name, given, config, more=None, **options):
    """Make one node: its file in config/, then the user's file, then the arguments."""
    files = [os.path.join(config, f"{name}.yaml")]
    if given["params_file"]:
        files.append(given["params_file"])
    # The player begins when the whole chain listens; a file of the user's may say otherwise.
    with_clock = " /clock:2" if given["use_sim_time"] in ("true", "True", "1") else ""
    chain = [{"wait_for": CHAIN + with_clock}] if name == "player" else []
    if name == "solver" and given["source"] == "player" and with_clock:
        chain = [{"exact_replay": True}]
    is_live = name == "wind" and given["source"] == "live"
    return Node(
        package=PACKAGE,
        executable=name,
        name=name,
        namespace=given["namespace"],
        parameters=[*chain, *files, overrides_of(name, given) | (more or {})],
        **{"remappings": [("wind", given["wind_topic"])] if is_live else []} | options,
        output="screen",
    )
