# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Motion sensors of ``tree-sway show``: the tree that it names follows them, and learns."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from contextlib import ExitStack
from dataclasses import replace
import time
from weakref import WeakKeyDictionary

from tree_sway.commands import say
from tree_sway.core.scene import Scene, Simulator
from tree_sway.core.settings import model_of, Settings
from tree_sway.errors import FormatError, inside, ParameterError
from tree_sway.files.commands import opened_scene
from tree_sway.files.motion import refuse_no_history, TreeHistory
from tree_sway.files.trees import LearnedFile
from tree_sway.live.commands import add_live_motion_arguments, sensing
from tree_sway.page import Choices, RATE
from tree_sway.page.commands import PageAddition
from tree_sway.stream import Control
from tree_sway.twin import observed_scene, ObservedTree
from tree_sway.twin.camera import FilmedTree
from tree_sway.twin.commands.camera_arguments import filming
from tree_sway.twin.commands.learn_argument import add_learn_argument, check_learn_argument


class SensorsOnThePage(PageAddition):
    """What live sensors on the real tree tell the one on the page."""

    places: Mapping[str, str] = {}
    """Place of each sensor by its name."""

    @staticmethod
    def add_arguments(parser: argparse.ArgumentParser) -> None:
        """Add the sensors, and files of what they tell."""
        add_live_motion_arguments(parser)
        add_learn_argument(parser)
        parser.add_argument(
            '--history', metavar='FILE',
            help='table (.csv) to which a row is added every ten minutes: wind, residuals, the '
            'band, and what the sensors have told',
        )  # fmt: skip

    def __init__(self, arguments: argparse.Namespace) -> None:
        super().__init__(arguments)
        check_learn_argument(arguments)
        if arguments.motion and arguments.stand > 1:
            what = f'motion sensors on a stand of {arguments.stand} trees'
            raise ParameterError(what, where='--motion', cure='leave --stand out')
        self._history: TreeHistory | None = None
        # Of each simulator, which viewers exchange: another tree learns nothing.
        self._learned = WeakKeyDictionary[Simulator, LearnedFile]()

    def open(self, stack: ExitStack) -> None:  # noqa: A003
        """Listen to the sensors."""
        arguments = self.arguments
        film = stack.enter_context(
            filming(arguments, lambda: opened_scene(arguments).trees[0].placed())
        )
        self.motion = stack.enter_context(sensing(arguments))
        self.motion.film = film
        self.places = self.motion.places
        if (path := arguments.history) is not None:
            with inside('--history'):
                refuse_no_history(path, list(self.places))
            self._history = TreeHistory(path, list(self.places))

    def controls(self) -> tuple[Control, ...]:
        """Make the control of where a single sensor sits."""
        if len(self.places) != 1:
            return ()
        what = (
            "A height on the stem in m, '3.2', or a branch and a share of its length, 'b12:0.5'."
        )
        return (Control('sensor_at', 'Sensor at', next(iter(self.places.values())), what),)

    def simulator(self, scene: Scene, settings: Settings, choices: Choices) -> Simulator | None:
        """Make an observed tree; None without sensors and camera, and for a stand."""
        film = self.motion.film if self.motion else None
        if not (self.places or film) or int(choices.count) != 1:
            return None
        places = self.places
        if choices.sensor_at:
            places = dict.fromkeys(places, choices.sensor_at)
        settings = replace(settings, model=model_of(choices.model))
        file = None
        if (path := self.arguments.learn) is not None:
            file = LearnedFile(path, scene.trees[0], settings.in_leaf)
            scene = scene.of_species(file.opened.species)
        kind = FilmedTree if film else ObservedTree
        twin = observed_scene(scene, settings, kind, at=places, rate=RATE, has_band=True)
        if file is not None:
            twin.learned_before = file.opened.learned
            self._learned[twin] = file
        return twin

    def note(self, simulator: Simulator) -> None:
        """Write what was learned if anything is new, and a row of the history if one is due."""
        if not isinstance(simulator, ObservedTree):
            return
        for write in (self._keep, self._note_history):
            try:
                write(simulator)
            except FormatError as error:
                say(error, 'warning')

    def _keep(self, twin: ObservedTree) -> None:
        if twin in self._learned:
            self._learned[twin].keep(twin)

    def _note_history(self, twin: ObservedTree) -> None:
        if self._history is not None:
            self._history.note(twin, time.monotonic())

    def tell(self, simulator: Simulator) -> None:
        """Say what was learned, and where it is."""
        if isinstance(simulator, ObservedTree) and simulator in self._learned:
            learned = simulator.learned or 'nothing was learned'
            print(f'{self._learned[simulator].path}: {learned}')
