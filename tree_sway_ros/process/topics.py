# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The topics of ``topics.yaml``: name, type and quality of service of each.

Each is a name of this module, as `WIND_FILTERED` is the topic ``wind/filtered``.
"""

from __future__ import annotations

from dataclasses import dataclass
import importlib
from pathlib import Path
from typing import Any

import yaml

from tree_sway.errors import ParameterError


@dataclass(frozen=True)
class Topic:
    """
    One topic: its relative name, remapped by launch files, and its type ``package/msg/Name``.

    ``reliable``: lost samples are sent again; ``latched``: a late subscriber receives the last one
    (TRANSIENT_LOCAL); ``depth``: number of stored samples; ``any_input``: our subscriptions accept
    best effort as well, as of drivers of sensors; ``replay_depth``: number of stored samples in a
    replay, where every sample counts. With it, our subscriptions are reliable in simulated time,
    and fall back to best effort once a publisher offers no more.
    """

    name: str
    type_name: str
    description: str
    reliable: bool = True
    latched: bool = False
    depth: int = 1
    any_input: bool = False
    replay_depth: int = 0


_TABLE = yaml.safe_load(Path(__file__).with_name('topics.yaml').read_text(encoding='utf-8'))
TOPICS = tuple(Topic(name, **keys) for name, keys in _TABLE.items())
_NAMED = {each.name.lstrip('~/').replace('/', '_').upper(): each for each in TOPICS}


def __getattr__(name: str) -> Topic:
    """Return the topic of a constant's name."""
    if name not in _NAMED:
        raise AttributeError(f'no topic {name} in topics.yaml')
    return _NAMED[name]


def qos_profile(topic: Topic, *, is_input: bool = False, is_replay: bool = False) -> Any:
    """
    Quality of service of a topic's publishers, or subscriptions, as rclpy's object.

    Of the wind in a replay it is deep and reliable.
    """
    from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

    is_strict = is_replay and topic.replay_depth > 0
    is_reliable = topic.reliable and (is_strict or not (is_input and topic.any_input))
    return QoSProfile(
        depth=max(topic.depth, topic.replay_depth if is_replay else 0),
        reliability=ReliabilityPolicy['RELIABLE' if is_reliable else 'BEST_EFFORT'],
        durability=DurabilityPolicy['TRANSIENT_LOCAL' if topic.latched else 'VOLATILE'],
    )


def refuse_topic_name(name: str, where: str) -> None:
    """Raise a `ParameterError` for a name that is none of a topic, from a parameter."""
    from rclpy.exceptions import InvalidTopicNameException
    from rclpy.validate_full_topic_name import validate_full_topic_name
    from rclpy.validate_topic_name import validate_topic_name

    try:
        validate_topic_name(name)
        validate_full_topic_name(f'/{name.lstrip("~/")}')
    except InvalidTopicNameException as error:
        reason = str(error).split('\n', 1)[0].removeprefix('Invalid topic name: ').rstrip(':')
        raise ParameterError(f"'{name}' is no name of a topic: {reason}", where=where) from None


def message_class(topic: Topic, type_name: str = '') -> Any:
    """Class of a topic's messages, or of a type that a program chose for it."""
    package, _, name = (type_name or topic.type_name).split('/')
    return getattr(importlib.import_module(f'{package}.msg'), name)
