# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Wind, state and description of a running tree as a bag, some 60 MB per hour.

All poses follow from the state; ``player`` replays it, or the wind, to be solved again.
"""

from __future__ import annotations

import argparse
from pathlib import Path
import time
from typing import Any

from tree_sway.commands import Ending, say, waiting
from tree_sway.core.wind import shorter_than
from tree_sway.files.recording import BagWriter
from tree_sway_ros.process.listener import Listener
from tree_sway_ros.process.topics import (
    DIAGNOSTICS,
    MARKERS,
    message_class,
    qos_profile,
    SEGMENT_POSES,
    Topic,
    TREE_DESCRIPTION,
    TREE_STATE,
    WIND,
    WIND_FILTERED,
    WIND_FORCE_PLANE,
)

_USUAL = (WIND, WIND_FILTERED, TREE_STATE, TREE_DESCRIPTION)
_MORE = (WIND_FORCE_PLANE, SEGMENT_POSES, MARKERS, DIAGNOSTICS)
_LOOK = 0.2


def record_bag(arguments: argparse.Namespace, seconds: float) -> int:
    """Record to the folder ``--output`` until the time [s] is over or Ctrl-C."""
    topics = _USUAL + (_MORE if arguments.poses else ())
    with (
        BagWriter(Path(arguments.output), arguments.format) as bag,
        Ending() as ending,
        Recorder(None, bag, topics, arguments.namespace) as recorder,
    ):
        ending.look()
        with waiting('waiting for a running tree, in this ROS_DOMAIN_ID; Ctrl-C ends it'):
            while not ending.is_asked and not recorder.recorded:
                recorder.spin(_LOOK)
        while not ending.is_asked and recorder.recorded < seconds:
            recorder.spin(_LOOK)
    if short := shorter_than(recorder.covered, seconds, arguments.output):
        say(short)
    if recorder.missing:
        say(f'nobody published {", ".join(recorder.missing)}')
    written = ', '.join(f'{count} of {name}' for name, count in bag.counts.items())
    print(f'{arguments.output}: {written or "nothing was sent"}')
    return 0


class Recorder(Listener):
    """Recording of some topics of a tree's nodes into a bag, message by message as bytes."""

    def __init__(
        self, context: Any, bag: BagWriter, topics: tuple[Topic, ...], namespace: str = ''
    ) -> None:
        super().__init__('tree_sway_record', namespace, context)
        self._bag = bag
        self._began: float | None = None
        self.covered = 0.0
        """Time from the first message to the last [s]."""
        self._wanted = {self.node.resolve_topic_name(topic.name): topic for topic in topics}

    @property
    def recorded(self) -> float:
        """Time since the first message in [s]."""
        return 0.0 if self._began is None else time.monotonic() - self._began

    @property
    def missing(self) -> list[str]:
        """Topics that nobody has published so far."""
        return list(self._wanted)

    def spin(self, seconds: float) -> None:
        """Record for a time [s]; subscribe to new topics first."""
        for name, kinds in self.node.get_topic_names_and_types() if self._wanted else ():
            if name in self._wanted:
                self._join(name, self._wanted.pop(name), kinds[0])
        super().spin(seconds)

    def _join(self, name: str, topic: Topic, kind: str) -> None:
        self._bag.add(
            name, kind, reliable=topic.reliable, latched=topic.latched, depth=topic.depth
        )

        def write(data: bytes) -> None:
            self._bag.write(name, time.time_ns(), data)
            if self._began is None:
                self._began = time.monotonic()
            self.covered = self.recorded

        message = message_class(topic, kind)
        profile = qos_profile(topic, is_input=True)
        self.node.create_subscription(message, name, write, profile, raw=True)
