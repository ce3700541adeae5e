# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Annexes of the solver: what belongs to its steps without being known to the node."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

from tree_sway.core.scene import Run, Scene, Simulator
from tree_sway.core.settings import Settings
from tree_sway.errors import ParameterError
from tree_sway.extras import loaded
from tree_sway_ros.parameters.annexes import ANNEXES
from tree_sway_ros.process.node import TreeSwayNode
from tree_sway_ros.reports.diagnostics import Status


class SolverAnnex:
    """
    Hooks that do nothing; an annex has those that it needs.

    It is made where one of its parameters is not at its default, before the simulator is.

    Parameters
    ----------
    node
        The solver; it has the values of the parameters, and makes subscriptions.

    """

    def __init__(self, node: TreeSwayNode) -> None:
        self.node = node

    def simulator(self, scene: Scene, settings: Settings) -> Simulator | None:
        """Make a simulator of its own for a scene; None for that of the scene."""
        return None

    def begin(self, run: Run, arrived: Callable[[], object]) -> None:
        """
        Subscribe to topics.

        Parameters
        ----------
        run
            Runtime of the simulator; `Run.request` hands samples to the thread of the steps.
        arrived
            Function to call after each sample, for which a replay may wait.

        """

    def before_step(self, end: float, late: float) -> None:
        """
        Prepare for a step, in its thread.

        It has an end, less the delay of wind and sensors, and its wind is late by a time [s].
        """

    def lacking(self, end: int, delay: float) -> Iterable[tuple[str, int]]:
        """
        Tell which topics have not yet sent what a step of a replay reads of them.

        Parameters
        ----------
        end
            End of the step in [ns].
        delay
            Delay of wind and sensors in [s], as for `Run.advance`.

        Yields
        ------
        tuple[str, int]
            Topic, and the stamp of its newest sample in [ns] or `UNHEARD`.

        """
        return ()

    def statuses(self) -> list[Status]:
        """Report to `/diagnostics`, once a second."""
        return []

    def keep(self) -> None:
        """Write what is to be kept: every five seconds, and at the end."""


def annexes_of(node: TreeSwayNode) -> list[SolverAnnex]:
    """Make the annexes that the parameters of a solver ask for."""
    values = node.values
    return [
        loaded(point)(node)
        for point, table in ANNEXES.items()
        if any(values[each.name] != each.default for each in table)
    ]


def simulator_by(
    annexes: Sequence[SolverAnnex], scene: Scene, settings: Settings, **options: Any
) -> Simulator:
    """Return the simulator that an annex makes, or that of the scene with options."""
    made = [annex.simulator(scene, settings) for annex in annexes]
    own = [each for each in made if each is not None]
    if len(own) > 1:
        raise ParameterError(f'{len(own)} annexes, each with a simulator of its own')
    return own[0] if own else scene.simulator(settings, **options)
