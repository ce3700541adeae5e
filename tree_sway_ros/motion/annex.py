# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The annex of motion sensors: a tree that follows them, and what is learned of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
import time

from tree_sway.core.scene import Run, Scene
from tree_sway.core.settings import Settings
from tree_sway.errors import FormatError, inside, ParameterError
from tree_sway.files.motion import TreeHistory
from tree_sway.files.trees import LearnedFile
from tree_sway.twin import observed_scene, ObservedTree
from tree_sway.twin.camera import FilmedTree
from tree_sway_ros.motion.camera_intake import CameraIntake
from tree_sway_ros.motion.imu_intake import ImuIntake, places_of
from tree_sway_ros.reports.diagnostics import Status


class MotionAnnex(ImuIntake):
    """Sensors of `imu`, the camera of `camera`, and the files of `learn` and `history`."""

    _camera: CameraIntake | None = None

    _history: TreeHistory | None = None
    _learned: LearnedFile | None = None

    def simulator(self, scene: Scene, settings: Settings) -> ObservedTree:
        """Make the tree with its sensors, of the wood that was learned before."""
        values = self.node.values
        places = places_of(values['imu'])
        if values['history']:
            with inside('history'):
                self._history = TreeHistory(values['history'], list(places))
        if not places and (values['learn'] or values['history'] or not values['camera']):
            what = 'no motion sensor to learn from'
            where = 'learn' if values['learn'] else 'imu'
            raise ParameterError(what, where=where, cure='give imu, as tree/imu@3.2')
        if values['learn']:
            with inside('learn'):
                file = LearnedFile(values['learn'], scene.trees[0], settings.in_leaf)
            self._learned = file
            scene = scene.of_species(file.opened.species)
        if values['camera']:
            self._camera = CameraIntake(self.node, values['camera'], scene.trees[0].placed())
        self.twin = observed_scene(
            scene,
            settings,
            FilmedTree if self._camera else ObservedTree,
            at=places,
            rate=values['rate'],
            has_band=True,
        )
        if self._learned is not None:
            self.twin.learned_before = self._learned.opened.learned
        return self.twin

    def begin(self, run: Run, arrived: Callable[[], object]) -> None:
        """Subscribe to each sensor and to the camera."""
        super().begin(run, arrived)
        if self._camera is not None:
            assert isinstance(self.twin, FilmedTree)
            self._camera.begin(self.twin, run, arrived)

    def lacking(self, end: int, delay: float) -> Iterator[tuple[str, int]]:
        """Tell which sensors have not yet sent what a step reads of them."""
        yield from super().lacking(end, delay)
        if self._camera is not None:
            yield from self._camera.lacking(end, delay)

    def statuses(self) -> list[Status]:
        """Report each sensor and the camera."""
        return super().statuses() + ([self._camera.status()] if self._camera else [])

    def keep(self) -> None:
        """Write what the sensors have told about the tree, if anything is new."""
        try:
            if self._learned is not None:
                self._learned.keep(self.twin)
            if self._history is not None:
                self._history.note(self.twin, time.monotonic())
        except FormatError as error:
            self.node.get_logger().warning(str(error))
