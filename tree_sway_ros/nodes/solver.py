# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The solver node: wind in, poses of every segment out, at a fixed rate."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields
import time
from typing import Any

from tree_sway.core.run import Tuning
from tree_sway.core.scene import Run, Scene, Simulator
from tree_sway.core.settings import Settings
from tree_sway.core.wind import WindAverage, WindIntake
from tree_sway.errors import LONGEST_NOTE, ParameterError, shown
from tree_sway.fidelity import measure_costs
from tree_sway_ros.process.node import TreeSwayNode
from tree_sway_ros.process.topics import SEGMENT_POSES, WIND_FILTERED
from tree_sway_ros.reports.diagnostics import OK, Status, WARN
from tree_sway_ros.reports.refusals import Refusals
from tree_sway_ros.reports.sway_report import SwayReport
from tree_sway_ros.solver import (
    annexes_of,
    answer_questions,
    Demand,
    offer_services,
    SampleWait,
    scene_of,
    settings_of,
    simulator_by,
    StatePublisher,
    take_pushes_and_pulls,
    UNHEARD,
)
from tree_sway_ros.timing.pacer import Tick
from tree_sway_ros.wire.pose_stream import PoseStream
from tree_sway_ros.wire.wind_messages import wind_from_message

_LEAF_CLUSTERS = 1000
"""Clusters of leaves in `tree_description`, of a tree in leaf."""

_KEPT_EVERY = 5.0
"""Interval [s] at which annexes write what is to be kept."""

_LIVE = frozenset(each.name for each in fields(Tuning))
"""Parameters that change the trees while they sway."""


class SolverNode(TreeSwayNode):
    """
    Subscribes to `wind/filtered`; publishes poses, markers and state.

    What else it hears and answers is in `tree_sway_ros.solver`, each in a module of its own.
    """

    _hears_wind = False
    _demand: Demand | None = None

    def configure(self) -> None:
        """Open the tree, and reduce it."""
        began = time.monotonic()
        log = self.get_logger().info
        log(f"opening tree '{shown(self.values['tree'])}'")
        source = scene_of(self.values)
        settings = settings_of(self.values)
        log(f'reducing {source.tree.n_segments} segments')
        self.refusals = Refusals(('camera', 'push', 'pull', 'wind_at', 'change'))
        self._make_run(source, settings)
        self._make_interfaces(source, settings)
        for warning in source.warnings:
            self.get_logger().warning(shown(warning, LONGEST_NOTE))
        for note in (f'gusts: {self.simulator.wind_told}', *source.notes):
            log(shown(note, LONGEST_NOTE))
        log(
            f'ready after {time.monotonic() - began:.1f} s: {shown(source.tree.name)}, '
            f'{self.simulator.model}, {self.values["rate"]:g} Hz'
        )

    def activate(self) -> None:
        """Start the steps and the stream."""
        self._state.start()
        if not self._hears_wind:  # a replay begins once there is a subscription
            self.subscription(WIND_FILTERED, self._receive)
            self._hears_wind = True
        for annex in self._annexes:
            self.on_close(annex.keep)
        self.run_worker(self.pacer)

    def _make_run(self, source: Scene, settings: Settings) -> None:
        """Make the simulator and what steps it."""
        self._annexes = annexes_of(self)
        self.simulator: Simulator = simulator_by(
            self._annexes, source, settings, **self.values.subset('tolerance')
        )
        if self.values['stiffness_factor'] != 1.0:
            self.simulator.tune(**self.values.subset('stiffness_factor'))
        self.pacer = self.pacer_of(self._tick)
        self._run = Run(
            self.simulator,
            self.values['rate'],
            intake=WindIntake.of_velocities(),
            make_wind=WindAverage,
            timer=time.perf_counter,
            starting=self._starting,
        )
        self._samples = SampleWait(self, self._lacking)
        self._tuned: dict[str, float] = {}
        self._demand = Demand(self, self._run, self.refusals)
        measure_costs(self.simulator, 1.0 / self.values['rate'], time.perf_counter)
        self._demand.set()
        self.simulator.reset()  # on the requested model

    def _make_interfaces(self, source: Scene, settings: Settings) -> None:
        """Make publishers, subscriptions, services and the report."""
        self._sway_report = SwayReport()
        leaves = source.leaves(settings.in_leaf, _LEAF_CLUSTERS)
        self.stream = PoseStream(self, source.tree, leaves)
        self._state = StatePublisher(self, self.simulator, _LEAF_CLUSTERS)
        self._topic = self.resolve_topic_name(WIND_FILTERED.name)
        self._hears_wind = False
        take_pushes_and_pulls(self, self._run, self.stream.tree_frames, self.refusals)
        answer_questions(self, self.simulator, self.refusals)
        offer_services(self, self._run)
        for annex in self._annexes:
            annex.begin(self._run, self._samples.note_arrival)
            self.create_steady_timer(_KEPT_EVERY, annex.keep)
        self._warnings = source.warnings
        self.report_with(source.tree.name, self._statuses)

    def _receive(self, message: Any, info: Mapping[str, Any]) -> None:
        """Offer a sample of the wind to the steps."""
        self._sway_report.gaps.note(info)
        sample = wind_from_message(message)
        arrival = int(self.get_clock().now().nanoseconds)
        components = (sample.u, sample.v, sample.w)
        self._run.offer(sample.stamp, components, arrival, **self.stamp_limits)
        self._samples.note_arrival()

    def check_values(self, values: dict[str, Any]) -> None:
        """Refuse a change that is impossible while the trees sway."""
        if not self.is_active:
            return
        changes = {k: v for k, v in values.items() if k in _LIVE and v != self.values[k]}
        if changes.get('damping_ratio') == 0.0:
            raise ParameterError(
                "the species' own damping while the tree sways",
                where='damping_ratio',
                cure='give the ratio itself; 0 is for the start',
            )
        if changes:
            # Beside those accepted before, which may still wait for the next step.
            self.simulator.check_tuning(**self._tuned | changes)

    def on_change(self, values: dict[str, Any]) -> None:
        """Apply new values before the next step."""
        changes = {name: values[name] for name in _LIVE & {*values}}
        if changes and self.is_active:
            self._tuned |= changes
            self._run.request(
                lambda: self.simulator.tune(**changes),
                lambda why: self.refusals.note('change', why),
            )
        if self._demand is not None:
            self._demand.request()

    def note_failure(self, error: Exception) -> None:
        """Continue from rest, as the state within a step is invalid."""
        super().note_failure(error)
        self._run.request(self.simulator.reset)

    def _tick(self, tick: Tick) -> None:
        if tick.restarted:
            self._run.restart(tick.time)
        if self.pacer.is_simulated:  # in a replay every frame is published, however late
            for later in range(tick.periods - 1, -1, -1):
                to = tick.time - later * self.pacer.period
                if not tick.restarted:  # before the record begins its clock stands
                    self._samples.wait(to)
                self._frame(to, 1, may_join=False)
        else:
            self._frame(tick.time, tick.periods, may_join=True)

    def _frame(self, now: int, periods: int, *, may_join: bool) -> None:
        """Solve up to a time in [ns], and publish due messages."""
        delay = self.values['wind_delay']
        self._run.advance(now, delay=delay, most=periods, may_join=may_join)
        index = now // self.pacer.period
        self.stream.publish(self.simulator, index, now, self.values['publish_every'])
        self._state.publish(index, now, self._run)

    def _starting(self, end: float, late: float) -> None:
        """Prepare annexes for a step, as `SolverAnnex.before_step`."""
        for annex in self._annexes:
            annex.before_step(end, late)

    def _lacking(self, to: int) -> Iterator[tuple[str, int]]:
        """Tell which topics have yet to send what a step reads, and their newest stamps [ns]."""
        delay, newest = self.values['wind_delay'], self._run.newest
        if newest is None:
            yield self._topic, UNHEARD
        elif self._run.lacks_wind(to, delay=delay):
            yield self._topic, newest
        for annex in self._annexes:
            yield from annex.lacking(to, delay)

    def _statuses(self) -> list[Status]:
        wind = self.publishers_of(self._topic, 'geometry_msgs/Vector3Stamped')
        poses = self.publishers_of(SEGMENT_POSES.name, 'geometry_msgs/PoseArray')
        replay = self.clock_rate.rate if self.is_simulated else None
        statuses = self._sway_report.statuses(
            self._run, self.pacer, self.stream.frames, replay, wind, poses
        )
        statuses += self.refusals.statuses()
        level, text = (WARN, '; '.join(self._warnings)) if self._warnings else (OK, 'as stated')
        statuses.append(Status('tree', level, shown(text, LONGEST_NOTE), {}))
        for annex in self._annexes:
            statuses += annex.statuses()
        return statuses
