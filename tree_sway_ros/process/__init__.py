# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Processes: start, spin and end a node; several nodes in one process; topics and their QoS.

Exceptions in callbacks do not end an executor. Nodes are in ``nodes``.
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway_ros.process.composition import Composition as Composition
    from tree_sway_ros.process.node import TreeSwayNode as TreeSwayNode
    from tree_sway_ros.process.topics import DIAGNOSTICS as DIAGNOSTICS
    from tree_sway_ros.process.topics import message_class as message_class
    from tree_sway_ros.process.topics import qos_profile as qos_profile
    from tree_sway_ros.process.topics import Topic as Topic
    from tree_sway_ros.process.topics import TOPICS as TOPICS
else:
    __getattr__, __dir__, __all__ = face(__name__)
