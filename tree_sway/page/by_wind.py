# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Frames of the wind alone, to whole ones: a receiver that solves the scene by itself."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.page.protocol import Description, Frame, PAUSED, RESTARTED

if TYPE_CHECKING:
    from tree_sway.core.scene.received_scene import ReceivedScene

STEP = 1.0 / 60.0
"""Time step of a scene that is solved by its wind in [s]."""

_MOST_STEPS = 60
_NEWEST = 0.05


class ByWind:
    """
    Solves a described scene by the wind of each frame, and follows the states among them.

    Frames that are lost are bridged by a wind between the two that came. ``static/by_wind.js``
    does the same.
    """

    def __init__(self, description: Description, scene: ReceivedScene) -> None:
        """Wait for the first state."""
        self._description, self._scene = description, scene
        self._last: Frame | None = None
        self._spacing = STEP
        self.corrections = 0
        """States that the scene was brought to."""

    def take(self, frame: Frame) -> Floats | None:
        """Go on to a frame; coordinates of its time, (M,), None before the first state."""
        scene, last, values = self._scene, self._last, self._description.coordinates(frame)
        is_whole = len(values) == len(self._description.scale)
        if last is None:
            if not is_whole:
                return None
            scene.correct(values)
        elif frame.flags & RESTARTED:
            scene.reset()
        elif not frame.flags & PAUSED:
            self._step(last, frame)
        if last is not None and len(values):
            if self.corrections == 0 and is_whole and frame.stamp > last.stamp:
                rate = (values - self._description.coordinates(last)) / (
                    1e-9 * (frame.stamp - last.stamp)
                )
                scene.correct(rate, 0, 'rate')
            scene.correct(values, frame.first)
            self.corrections += 1
        self._last = frame
        return scene.state()

    def _step(self, last: Frame, frame: Frame) -> None:
        """Go on by the steps between two frames."""
        count = max((frame.sequence - last.sequence) % 2**32, 1)
        spacing = 1e-9 * (frame.stamp - last.stamp) / count
        self._spacing += _NEWEST * (min(max(spacing, 0.0), 1.0) - self._spacing)
        steps = min(count * max(1, round(self._spacing / STEP)), _MOST_STEPS)
        for share in (np.arange(steps) + 1.0) / steps:
            self._scene.step(last.wind + share * (frame.wind - last.wind))
