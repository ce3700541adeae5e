# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A receiver that solves the scene itself, from frames with the wind alone."""

from __future__ import annotations

import math

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.stream.check_description import Json
from tree_sway.stream.protocol import Description, Frame, PAUSED, RESTARTED
from tree_sway.stream.received_scene import ReceivedScene

STEP = 1.0 / 60.0
"""Time step of a scene that is solved by its wind in [s]."""

_MOST_STEPS = 60
_NEWEST = 0.05


class ByWind:
    """
    A described scene, solved by the wind of each frame and corrected by states among them.

    For lost frames the wind is interpolated. ``static/by_wind.js`` does the same.
    """

    def __init__(self, description: Description, scene: ReceivedScene) -> None:
        """Wait for the first state."""
        self._description = description
        self._scene = scene
        self._last: Frame | None = None
        self._spacing = STEP
        self._heard = 0
        self.corrections = 0
        """Number of states that corrected the scene."""

    def go_on(self, gusts: Json) -> None:
        """Set the wind of the time before the first frame, as in `SceneState.gusts`."""
        self._heard = gusts['sequence']
        self._scene.gusts.go_on(gusts['mean'], gusts['delay'], gusts['wind'])

    def take(self, frame: Frame) -> Floats | None:
        """Advance to a frame; return its coordinates, (M,), None before the first state."""
        scene = self._scene
        last = self._last
        values = self._description.coordinates(frame)
        is_whole = len(values) == len(self._description.scale)
        if last is None:
            if not is_whole:
                return None
            scene.correct(values)
            missed = (frame.sequence - self._heard) % 2**32
            for _ in range(missed if missed <= _MOST_STEPS else 0):
                scene.gusts.push(frame.wind, STEP)
        elif frame.flags & RESTARTED:
            scene.reset()
        elif not frame.flags & PAUSED:
            self._step(last, frame)
        if last is not None and len(values):
            span = 1e-9 * (frame.stamp - last.stamp) if is_whole and self.corrections == 0 else 0.0
            scene.correct(values, frame.first, span / STEP if span > 0.0 else math.inf)
            self.corrections += 1
        self._last = frame
        return scene.state()

    def _step(self, last: Frame, frame: Frame) -> None:
        """Advance by the steps between two frames."""
        count = max((frame.sequence - last.sequence) % 2**32, 1)
        spacing = 1e-9 * (frame.stamp - last.stamp) / count
        self._spacing += _NEWEST * (min(max(spacing, 0.0), 1.0) - self._spacing)
        steps = min(count * max(1, round(self._spacing / STEP)), _MOST_STEPS)
        for share in (np.arange(steps) + 1.0) / steps:
            self._scene.step(last.wind + share * (frame.wind - last.wind))
