# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Questions for the wind at a place, and their answers."""

from __future__ import annotations

from typing import Any

from geometry_msgs.msg import Vector3Stamped

from tree_sway.core.scene import Simulator
from tree_sway.errors import ParameterError
from tree_sway.simulation import wind_at
from tree_sway_ros.process.node import TreeSwayNode
from tree_sway_ros.process.topics import WIND_AT, WIND_THERE
from tree_sway_ros.reports.refusals import Refusals


def answer_questions(node: TreeSwayNode, simulator: Simulator, refusals: Refusals) -> None:
    """Answer each place on `~/wind_at` by the wind there on `~/wind_there`, with its stamp."""
    known = node.values['frame_id']
    publisher = node.publisher(WIND_THERE)

    def answer(message: Any) -> None:
        frame_id = message.header.frame_id
        if frame_id not in ('', known):
            refusals.note('wind_at', f"'{frame_id}' is not the frame of the poses, '{known}'")
            return
        at = message.point
        try:
            wind = wind_at(simulator, (at.x, at.y, at.z))
        except ParameterError as error:
            refusals.note('wind_at', str(error))
            return
        reply = Vector3Stamped(header=message.header)
        reply.header.frame_id = known
        reply.vector.x, reply.vector.y, reply.vector.z = wind.tolist()
        publisher.publish(reply)

    node.subscription(WIND_AT, answer)
