# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
``tree-sway record``: wind, state and description of a running tree as a bag, some 60 MB per hour.

The state is all that poses are rebuilt from; ``player`` replays it, or the wind, to be solved anew.

"""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import Any

from tree_sway_ros.files.recording.bag_writer import FORMATS, BagWriter
from tree_sway_ros.ros.process.ending import Ending
from tree_sway_ros.ros.process.spin import create, init, require_rclpy
from tree_sway_ros.ros.process.topics import (
    DIAGNOSTICS,
    FORCE_PLANE,
    MARKERS,
    SEGMENT_POSES,
    TREE_DESCRIPTION,
    TREE_STATE,
    WIND,
    WIND_FILTERED,
    Topic,
    message_class,
    qos_profile,
)
from tree_sway_ros.ros.wire.wind_messages import wind_class
from tree_sway_ros.tools.stream.watch import checked_seconds

_USUAL = (WIND, WIND_FILTERED, TREE_STATE, TREE_DESCRIPTION)
_MORE = (FORCE_PLANE, SEGMENT_POSES, MARKERS, DIAGNOSTICS)
_LOOK = 0.2


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("-o", "--output", required=True, metavar="FOLDER", help="bag to make")
    parser.add_argument(
        "--format", choices=FORMATS, default=FORMATS[0], help="of the bag (%(default)s)"
    )
    parser.add_argument("--namespace", default="", help="of the tree's nodes")
    parser.add_argument(
        "--poses", action="store_true", help="also poses, markers and diagnostics: GB per hour"
    )
    parser.add_argument(
        "--seconds", type=float, metavar="N", help="so long from the first message; else by Ctrl-C"
    )


def run(arguments: argparse.Namespace) -> int:
    """Record until the time is over or Ctrl-C."""
    seconds = checked_seconds(arguments.seconds)
    rclpy = require_rclpy()
    context = rclpy.context.Context()
    init(rclpy, [], context=context, signal_handler_options=rclpy.signals.SignalHandlerOptions.NO)
    try:
        with BagWriter(Path(arguments.output), arguments.format) as bag, Ending() as ending:
            topics = _USUAL + (_MORE if arguments.poses else ())
            recorder = Recorder(context, bag, topics, arguments.namespace)
            try:
                ending.look()
                while not ending.is_asked and recorder.recorded < seconds:
                    recorder.spin(_LOOK)
            finally:
                recorder.close()
        told = ", ".join(f"{count} of {name}" for name, count in bag.counts.items())
        print(f"{arguments.output}: {told or 'nothing was sent'}")
    finally:
        context.try_shutdown()
    return 0


class Recorder:
    """
    Writes what a tree's nodes send into a bag, message by message as bytes.

    Parameters
    ----------
    context
        Of rclpy.
    bag
        To write to.
    topics
        What to record.
    namespace
        Of the nodes.

    """

    def __init__(
        self, context: Any, bag: BagWriter, topics: tuple[Topic, ...], namespace: str = ""
    ) -> None:
        from rclpy.executors import SingleThreadedExecutor
        from rclpy.node import Node

        self._bag = bag
        self._node: Any = create(
            lambda **given: Node("tree_sway_record", **given), context=context, namespace=namespace
        )
        self._executor = SingleThreadedExecutor(context=context)
        self._executor.add_node(self._node)
        self._began: float | None = None
        self._wanted = {self._node.resolve_topic_name(topic.name): topic for topic in topics}

    @property
    def recorded(self) -> float:
        """Time since the first message in [s]."""
        return 0.0 if self._began is None else time.monotonic() - self._began

    def spin(self, seconds: float) -> None:
        """Record for a time [s]; topics that are new are joined first."""
        for name, kinds in self._node.get_topic_names_and_types() if self._wanted else ():
            if name in self._wanted:
                self._join(name, self._wanted.pop(name), kinds[0])
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0.0:
            self._executor.spin_once(timeout_sec=left)

    def close(self) -> None:
        """Leave the graph."""
        self._executor.shutdown(timeout_sec=1.0)
        self._node.destroy_node()

    def _join(self, name: str, topic: Topic, kind: str) -> None:
        self._bag.add(name, kind, reliable=topic.reliable, latched=topic.latched, depth=topic.depth)

        def write(data: bytes) -> None:
            self._bag.write(name, time.time_ns(), data)
            if self._began is None:
                self._began = time.monotonic()

        of_wind = topic is WIND
        message = wind_class(kind.replace("/msg/", "/")) if of_wind else message_class(topic)
        self._node.create_subscription(message, name, write, qos_profile(topic), raw=True)
