# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Pushes and pulls at segments, which messages name by their frames."""

from __future__ import annotations

from functools import partial
import math
from typing import Any

from scipy.spatial.transform import Rotation

from tree_sway.core.scene import Run
from tree_sway.stream import ControlPanel, Refused
from tree_sway_ros.process.node import TreeSwayNode
from tree_sway_ros.process.topics import PULL, PUSH
from tree_sway_ros.reports.refusals import Refusals
from tree_sway_ros.wire.tree_frames import TreeFrames

_STRONGEST_PUSH = 1e5
"""Largest force of a push [N]."""
_PUSH_LASTS = 0.5
"""Time [s] after which a push ends if it is not repeated."""


def take_pushes_and_pulls(
    node: TreeSwayNode, run: Run, frames: TreeFrames, refusals: Refusals
) -> None:
    """Push and pull the trees of a run by `~/push` and `~/pull`."""
    refuse_push = partial(refusals.note, 'push')
    refuse_pull = partial(refusals.note, 'pull')
    panel = ControlPanel(pull=run.pull)

    def row(frame_id: str, refuse: Refused) -> int | None:
        """Return the row of the segment with a frame; without one the request is refused."""
        found = frames.row(frame_id)
        if found is None:
            refuse(f"'{frame_id}' is the frame of no segment: one is '{frames.example}'")
        return found

    def take_push(message: Any) -> None:
        """Push at the origin of a segment's frame, by a force [N] in its axes."""
        force = message.wrench.force
        components = (force.x, force.y, force.z)
        if (segment := row(message.header.frame_id, refuse_push)) is None:
            return

        def push() -> None:
            axes = Rotation.from_quat(run.simulator.place()[segment, 3:])
            run.simulator.push(segment, axes.apply(components), _PUSH_LASTS, along=0.0)

        if not math.hypot(*components) <= _STRONGEST_PUSH:  # false for NaN
            refuse_push(f'not finite or above {_STRONGEST_PUSH:g} N')
        else:
            frames.show(segment)
            run.request(push, refuse_push)

    def take_pull(message: Any) -> None:
        parts = message.joint_names, message.transforms, message.wrench
        if len({*map(len, parts)}) > 1:
            refuse_pull('not one of transforms and wrench for each of joint_names')
            return
        for frame_id, wanted, spring in zip(*parts, strict=True):
            if (segment := row(frame_id, refuse_pull)) is None:
                continue
            at = wanted.translation
            pull = {'segment': segment, 'to': [at.x, at.y, at.z], 'stiffness': spring.force.x}
            if why := panel.pull(pull, refuse_pull):
                refuse_pull(why)

    node.subscription(PUSH, take_push)
    node.subscription(PULL, take_pull)
