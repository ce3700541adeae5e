# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A camera of the solver: pictures of a topic, points of the tree in them to the twin."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any

from tree_sway.core.scene import Run
from tree_sway.core.tree import Tree
from tree_sway.errors import inside, ParameterError, TreeSwayError
from tree_sway.live import CameraView, Sighting
from tree_sway.twin.camera import FilmedTree
from tree_sway_ros.motion.followed_topic import FollowedTopic
from tree_sway_ros.process.node import TreeSwayNode
from tree_sway_ros.process.topics import IMAGE, message_class, refuse_topic_name
from tree_sway_ros.reports.diagnostics import OK, Status, WARN
from tree_sway_ros.wire.picture_messages import picture_from_message
from tree_sway_ros.wire.wind_messages import stamp_to_ns

_COMPRESSED = 'compressed'


class CameraIntake:
    """
    The subscription of a camera.

    A picture is followed in the callback, which takes some milliseconds and waits for no step;
    its points are handed to the thread of the steps.

    Parameters
    ----------
    node
        The solver.
    text
        ``TOPIC@CLICKS``, the clicks as `CameraView` takes them.
    tree
        The tree at rest.

    """

    def __init__(self, node: TreeSwayNode, text: str, tree: Tree) -> None:
        topic, at, clicks = text.partition('@')
        self.topic = topic.strip()
        if not (self.topic and at and clicks.strip()):
            cure = "give TOPIC@CLICKS, as 'tree/image_raw@oak.clicks'"
            raise ParameterError(f"'{text}' is no topic with clicks", where='camera', cure=cure)
        refuse_topic_name(self.topic, 'camera')
        self._node = node
        with inside('camera'):
            self._view = CameraView(tree, clicks.strip(), self._say)
        kind = 'CompressedImage' if self.topic.endswith(_COMPRESSED) else 'Image'
        self._kind = f'sensor_msgs/msg/{kind}'
        self._followed = FollowedTopic(node, self.topic, f'sensor_msgs/{kind}')
        self._refused, self._cause = 0, ''

    def _say(self, text: str) -> None:
        self._node.get_logger().info(f'camera {self.topic}: {text}')

    def begin(self, twin: FilmedTree, run: Run, arrived: Callable[[], object]) -> None:
        """Subscribe; the arguments are the tree, and those of `SolverAnnex.begin`."""
        self._twin, self._run, self._arrived = twin, run, arrived
        kind = message_class(IMAGE, self._kind)
        self._node.subscription(replace(IMAGE, name=self.topic), self._receive, kind)

    def _receive(self, message: Any, info: Mapping[str, object]) -> None:
        stamp = self._followed.admitted(stamp_to_ns(message.header.stamp), info)
        if stamp is None:
            return
        late = self._view.told.late
        try:
            picture = picture_from_message(self._view.cv2, message)
            seen = self._view.follow(stamp * 1e-9 - late, picture)
        except TreeSwayError as error:
            self._refused, self._cause = self._refused + 1, str(error)
        else:
            self._run.request(lambda: self._film(seen))
        self._followed.newest = stamp
        self._arrived()

    def _film(self, seen: Sighting) -> None:
        """Offer the points of a picture, in the thread of the steps."""
        self._twin.camera = self._view.camera
        self._twin.film(*seen)

    def lacking(self, end: int, delay: float) -> Iterator[tuple[str, int]]:
        """Tell whether the picture that a step reads has yet to come."""
        if self._followed.lacks(end - round(1e9 * delay)):
            yield self.topic, self._followed.newest

    def status(self) -> Status:
        """Report what it tells, or why it tells nothing, and its counts."""
        followed, twin, refused = self._followed, self._twin, self._refused
        values = {
            'points on the tree': len(twin.points.row),
            'motion in the picture [px]': round(twin.motion, 2),
            'refused': refused,
            'refused for their times or points': twin.refused,
            'refused for their stamps': followed.apart,
            'of other publishers, refused': followed.of_others,
        }
        faults = [f'{refused} refused: {self._cause}'] if refused else []
        faults += filter(None, [followed.clock_problem, *followed.faults()])
        said = '; '.join([twin.said, *faults])
        return Status(
            f'camera {self.topic}', WARN if faults or not twin.sees else OK, said, values
        )
