# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The topics: name, type and quality of service of each, for the nodes and for the README.

Names are relative, so that a namespace holds one tree. Poses and markers are RELIABLE because RViz
and Unity ask for that and see nothing otherwise; queues are short because a reliable queue replays
everything it holds once a broken link is back.
"""

from __future__ import annotations

from dataclasses import dataclass
import importlib
from typing import Any


@dataclass(frozen=True)
class Topic:
    """
    One topic: its relative name, remapped by launch files, and its type ``package/msg/Name``.

    ``reliable``: a sample that was lost is sent again; ``latched``: a late subscriber receives the
    last one (TRANSIENT_LOCAL); ``depth``: samples kept; ``any_input``: our own subscriptions take
    best effort as well, which is all that drivers of sensors offer.
    """

    name: str
    type_name: str
    description: str
    reliable: bool = True
    latched: bool = False
    depth: int = 1
    any_input: bool = False


WIND = Topic(
    'wind',
    'geometry_msgs/msg/Vector3Stamped',
    'The wind as measured; the type is chosen by `input_type` or `output_type`.',
    depth=50,
    any_input=True,
)
WIND_FILTERED = Topic(
    'wind/filtered',
    'geometry_msgs/msg/Vector3Stamped',
    'The wind that the trees feel, blowing TO, ENU [m/s]: bad samples refused.',
    depth=40,
)
FORCE_PLANE = Topic(
    'wind/force_plane',
    'geometry_msgs/msg/PoseStamped',
    "The plane of the force: x along the wind, z the plane's normal.",
)
SEGMENT_POSES = Topic(
    'segment_poses',
    'geometry_msgs/msg/PoseArray',
    'One pose per segment: its origin is the root-side node, x points along the segment [m].',
    depth=2,
)
MARKERS = Topic(
    'markers',
    'visualization_msgs/msg/MarkerArray',
    'The tree for RViz: one LINE_LIST per class of radii, with fixed ids.',
)
TREE_DESCRIPTION = Topic(
    'tree_description',
    'std_msgs/msg/String',
    'The tree as JSON: name, parent, length, radii and branch of each segment; repeated each 5 s.',
    latched=True,
)
TREE_STATE = Topic(
    'tree_state',
    'sensor_msgs/msg/JointState',
    'The wind [m/s] and the few coordinates that, with `tree_description`, all poses follow from.',
    depth=10,
)
DIAGNOSTICS = Topic(
    '/diagnostics',
    'diagnostic_msgs/msg/DiagnosticArray',
    'Rates, age and refusals of the wind, jitter, overruns and the model in use.',
    depth=10,
)
CAMERA = Topic(
    'camera',
    'geometry_msgs/msg/PoseStamped',
    "Where the tree is seen from, in the tree's frame: `auto` keeps its error below "
    '`tolerance_angle`.',
    reliable=False,
)
CLOCK = Topic(
    '/clock',
    'rosgraph_msgs/msg/Clock',
    "The time of the record, where the player's `publish_clock` asks for it.",
    reliable=False,
)
TF = Topic(
    '/tf',
    'tf2_msgs/msg/TFMessage',
    'One frame per segment, where `publish_tf` asks for it; read where the wind is in another '
    'frame.',
    depth=10,
)
TF_STATIC = Topic(
    '/tf_static',
    'tf2_msgs/msg/TFMessage',
    'Read where the wind is in another frame.',
    latched=True,
    depth=100,
)

TOPICS = (
    WIND,
    WIND_FILTERED,
    FORCE_PLANE,
    SEGMENT_POSES,
    MARKERS,
    TREE_DESCRIPTION,
    TREE_STATE,
    CAMERA,
    DIAGNOSTICS,
    CLOCK,
    TF,
    TF_STATIC,
)


def qos_profile(topic: Topic, *, is_input: bool = False) -> Any:
    """Quality of service of a topic's publishers, or subscriptions, as rclpy's object."""
    from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=topic.depth,
        reliability=ReliabilityPolicy.RELIABLE
        if topic.reliable and not (is_input and topic.any_input)
        else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL
        if topic.latched
        else DurabilityPolicy.VOLATILE,
    )


def message_class(topic: Topic) -> Any:
    """Class of a topic's messages."""
    package, _, name = topic.type_name.split('/')
    return getattr(importlib.import_module(f'{package}.msg'), name)
