# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The solver node: wind in, poses of every segment out, at a fixed rate."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
import math
import threading
import time
from typing import Any

from geometry_msgs.msg import Vector3Stamped
from rclpy.clock import Clock, ClockType
from scipy.spatial.transform import Rotation
from std_srvs.srv import SetBool, Trigger

from tree_sway.core.model.settings import Settings
from tree_sway.core.run.tuning import LIVE
from tree_sway.core.scene.demand import set_cost_scale, set_demand
from tree_sway.core.scene.run import Run
from tree_sway.core.scene.scene import Scene
from tree_sway.core.scene.scene_simulator import Simulator
from tree_sway.core.scene.shard import shard_of
from tree_sway.core.scene.wind_at import wind_at
from tree_sway.core.setup.season import LEAVES
from tree_sway.core.tree.species import species_named
from tree_sway.core.wind.averaging import WindAverage
from tree_sway.core.wind.height_profile import WindProfile
from tree_sway.core.wind.intake import WindIntake
from tree_sway.errors import FormatError, inside, LONGEST_NOTE, ParameterError, shown
from tree_sway.files.motion.tree_history import TreeHistory
from tree_sway.files.trees.learned_file import LearnedFile
from tree_sway.files.trees.source import open_scene
from tree_sway.stream.controls import ControlPanel, Refused
from tree_sway.twin.observed_scene import observed_scene
from tree_sway.twin.observed_tree import ObservedTree
from tree_sway.worker import submit_beside
from tree_sway_ros.nodes.imu_intake import ImuIntake, places_of, UNHEARD
from tree_sway_ros.nodes.state_publisher import StatePublisher
from tree_sway_ros.process.node import TreeSwayNode
from tree_sway_ros.process.topics import (
    CAMERA,
    PULL,
    PUSH,
    SEGMENT_POSES,
    WIND_AT,
    WIND_FILTERED,
    WIND_THERE,
)
from tree_sway_ros.reports.diagnostics import OK, Status, WARN
from tree_sway_ros.reports.refusals import Refusals
from tree_sway_ros.reports.sway_report import SwayReport
from tree_sway_ros.timing.pacer import Tick
from tree_sway_ros.wire.pose_stream import PoseStream
from tree_sway_ros.wire.wind_messages import wind_from_message

_LEAF_CLUSTERS = 1000
"""Clusters of leaves in `tree_description`, of a tree in leaf."""

_FARTHEST_CAMERA = 1e6
"""Distance along each axis [m]."""

_STRONGEST_PUSH = 1e5
"""Largest force of a push [N]."""
_PUSH_LASTS = 0.5
"""Time [s] after which a push ends if it is not repeated."""

_PATIENCE, _PATIENCE_AT_FIRST = 3.0, 10.0
"""
Times [s] of the machine for which a replay waits for a sample or a publisher, and from when a
publisher is found for its first sample.

"""

_KEPT_EVERY = 5.0
"""Interval [s] at which what was learned is written, if it is new."""

_STOP_CHECK = 0.05
"""Interval [s] of checks whether the node is ended while it waits."""


class SolverNode(TreeSwayNode):
    """
    Subscribes to `wind/filtered`; publishes poses, markers and state.

    It answers questions for the wind at a place, and takes pushes, pulls and motion sensors.
    """

    _hears_wind = False

    def configure(self) -> None:
        """Open the tree, and reduce it."""
        began = time.monotonic()
        log = self.get_logger().info
        log(f"opening tree '{shown(self.values['tree'])}'")
        source = self._open()
        log(f'reducing {source.tree.n_segments} segments')
        self._make_run(source)
        self._make_interfaces(source)
        for warning in source.warnings:
            self.get_logger().warning(shown(warning, LONGEST_NOTE))
        for note in source.notes:
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
        if self._learned is not None:
            self.on_close(self._keep_learned)
        self.run_worker(self.pacer)

    def _open(self) -> Scene:
        """Open the trees that this node sways, where they stand."""
        named = self.values['species']
        source = open_scene(
            self.values['tree'],
            wood=lambda found: species_named(named) if named else found,
            in_leaf=LEAVES[self.values['leaves']],
            warn=False,
        )
        x, y, z, yaw = self.values['pose']
        moved = source.moved(x=x, y=y, z=z, yaw=yaw)
        return shard_of(moved, self.values['shard.index'], self.values['shard.count'])

    def _settings(self) -> Settings:
        """Return the settings of the model by the parameters."""
        return Settings(
            **self.values.subset('model', 'gravity', 'anemometer_distance', 'gusts'),
            volume_stiffness=self.values['volume_rule.stiffness'],
            volume_damping=self.values['volume_rule.damping'],
            in_leaf=LEAVES[self.values['leaves']],
            damping_ratio=self.values['damping_ratio'] or None,
            profile=WindProfile(self.values['profile'], self.values['anemometer_height']),
        )

    def _make_run(self, source: Scene) -> None:
        """Make the simulator and what steps it."""
        self._camera: tuple[float, float, float] | None = None
        self._tuned: dict[str, float] = {}
        self._arrived = threading.Event()
        self._missed: set[tuple[str, int]] = set()
        places = places_of(self.values['imu'])
        settings = self._settings()
        self._learned: LearnedFile | None = None
        self._history: TreeHistory | None = None
        if self.values['history']:
            with inside('history'):
                self._history = TreeHistory(self.values['history'], list(places))
        if self.values['learn']:
            source = self._open_learned(source, places)
        self.simulator: Simulator = (
            observed_scene(
                source,
                settings,
                at=places,
                rate=self.values['rate'],
                has_band=True,
                submit=submit_beside,
            )
            if places
            else source.simulator(settings, **self.values.subset('tolerance'))
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
        if self._learned is not None and isinstance(self.simulator, ObservedTree):
            self.simulator.learned_before = self._learned.opened.learned
        set_cost_scale(self.simulator.simulators, self._run.warm_up())
        self._set_demand()
        self.simulator.reset()  # on the requested model

    def _open_learned(self, source: Scene, places: Mapping[str, str]) -> Scene:
        """Return the tree with the wood that was learned before; what is learned is kept."""
        if not places:
            what = 'no motion sensor to learn from'
            raise ParameterError(what, where='learn', cure='give imu, as tree/imu@3.2')
        with inside('learn'):
            file = LearnedFile(
                self.values['learn'], source.trees[0], LEAVES[self.values['leaves']]
            )
        self._learned = file
        return source.of_species(file.opened.species)

    def _keep_learned(self) -> None:
        """Write what the sensors have told about the tree, if anything is new."""
        if not isinstance(self.simulator, ObservedTree):
            return
        try:
            if self._learned is not None:
                self._learned.keep(self.simulator)
            if self._history is not None:
                self._history.note(self.simulator, time.monotonic())
        except FormatError as error:
            self.get_logger().warning(str(error))

    def _make_interfaces(self, source: Scene) -> None:
        """Make publishers, subscriptions, services and the report."""
        self.refusals = Refusals(('camera', 'push', 'pull', 'wind_at', 'change'))
        self._sway_report = SwayReport()
        leaves = source.leaves(LEAVES[self.values['leaves']], _LEAF_CLUSTERS)
        self.stream = PoseStream(self, source.tree, leaves)
        self._state = StatePublisher(self, self.simulator, _LEAF_CLUSTERS)
        self._topic = self.resolve_topic_name(WIND_FILTERED.name)
        self._hears_wind = False
        self.subscription(CAMERA, self._see)
        self._imu: ImuIntake | None = None
        if isinstance(self.simulator, ObservedTree):
            self._imu = ImuIntake(self, self._run, self.simulator, self._arrived.set)
        if self._learned is not None or self._history is not None:
            steady = Clock(clock_type=ClockType.STEADY_TIME)
            self.create_timer(_KEPT_EVERY, self._keep_learned, clock=steady)
        self._hands = ControlPanel(pull=self._pull)
        self.subscription(PUSH, self._take_push)
        self.subscription(PULL, self._take_pull)
        self._wind_there = self.publisher(WIND_THERE)
        self.subscription(WIND_AT, self._answer)
        self.create_service(Trigger, '~/reset', self._reset)
        self.create_service(SetBool, '~/pause', self._pause)
        self._warnings = source.warnings
        self.report_with(source.tree.name, self._statuses)

    def _starting(self, felt: float) -> None:
        """Note the time [s] of the wind of the next step, at which sensors are read."""
        if isinstance(self.simulator, ObservedTree):
            self.simulator.set_time(felt)

    def _receive(self, message: Any, info: Mapping[str, Any]) -> None:
        self._sway_report.gaps.note(info)
        sample = wind_from_message(message)
        arrival = int(self.get_clock().now().nanoseconds)
        components = (sample.u, sample.v, sample.w)
        self._run.offer(sample.stamp, components, arrival, **self.stamp_limits)
        self._arrived.set()

    def _see(self, message: Any) -> None:
        at = message.pose.position
        camera = (at.x, at.y, at.z)
        if not all(abs(each) <= _FARTHEST_CAMERA for each in camera):  # false for NaN
            self.refusals.note('camera', 'not finite or too far away')
            return
        self._camera = camera
        self._request_demand()

    def _answer(self, message: Any) -> None:
        """Publish the wind at the place of a question, with its stamp."""
        frame_id = message.header.frame_id
        known = self.values['frame_id']
        if frame_id not in ('', known):
            self.refusals.note('wind_at', f"'{frame_id}' is not the frame of the poses, '{known}'")
            return
        at = message.point
        try:
            wind = wind_at(self.simulator, (at.x, at.y, at.z))
        except ParameterError as error:
            self.refusals.note('wind_at', str(error))
            return
        answer = Vector3Stamped(header=message.header)
        answer.header.frame_id = known
        answer.vector.x, answer.vector.y, answer.vector.z = wind.tolist()
        self._wind_there.publish(answer)

    def _row(self, frame_id: str, request: str) -> int | None:
        """Return the row of the segment with a frame; without one the request is refused."""
        frames = self.stream.tree_frames
        row = frames.row(frame_id)
        if row is None:
            why = f"'{frame_id}' is the frame of no segment: one is '{frames.example}'"
            self.refusals.note(request, why)
        return row

    def _take_push(self, message: Any) -> None:
        segment = self._row(message.header.frame_id, 'push')
        force = message.wrench.force
        components = (force.x, force.y, force.z)
        if segment is None:
            return
        if not math.hypot(*components) <= _STRONGEST_PUSH:  # false for NaN
            self.refusals.note('push', f'not finite or above {_STRONGEST_PUSH:g} N')
        else:
            self.stream.tree_frames.show(segment)
            self._run.request(
                lambda: self._push(segment, components),
                lambda why: self.refusals.note('push', why),
            )

    def _push(self, segment: int, components: tuple[float, float, float]) -> None:
        """Push at the origin of a segment's frame, by a force [N] in its axes."""
        axes = Rotation.from_quat(self.simulator.place()[segment, 3:])
        self.simulator.push(segment, axes.apply(components), _PUSH_LASTS, along=0.0)

    def _take_pull(self, message: Any) -> None:
        parts = message.joint_names, message.transforms, message.wrench
        if len({*map(len, parts)}) > 1:
            self.refusals.note('pull', 'not one of transforms and wrench for each of joint_names')
            return
        for frame_id, wanted, spring in zip(*parts, strict=True):
            if (segment := self._row(frame_id, 'pull')) is None:
                continue
            at = wanted.translation
            pull = {'segment': segment, 'to': [at.x, at.y, at.z], 'stiffness': spring.force.x}
            why = self._hands.pull(pull, lambda why: self.refusals.note('pull', why))
            if why is not None:
                self.refusals.note('pull', why)

    def _pull(
        self, segment: int, to: tuple[float, ...], stiffness: float, refused: Refused
    ) -> None:
        self._run.pull(segment, to, stiffness, refused)

    def check_values(self, values: dict[str, Any]) -> None:
        """Refuse a change that is impossible while the trees sway."""
        if not self.is_active:
            return
        changes = {k: v for k, v in values.items() if k in LIVE and v != self.values[k]}
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
        changes = {name: values[name] for name in LIVE if name in values}
        if changes and self.is_active:
            self._tuned |= changes
            self._run.request(
                lambda: self.simulator.tune(**changes),
                lambda why: self.refusals.note('change', why),
            )
        self._request_demand()

    def _request_demand(self) -> None:
        """Ask for the demand of the model ``auto`` to be set before the next step."""
        if self.values['model'] == 'auto':
            self._run.request(self._set_demand, lambda why: self.refusals.note('change', why))

    def _set_demand(self) -> None:
        set_demand(
            self.simulator.simulators,
            camera=self._camera,
            **self.values.subset('tolerance', 'tolerance_angle', 'budget'),
        )

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
                    self._await_samples(to)
                self._frame(to, 1, may_join=False)
        else:
            self._frame(tick.time, tick.periods, may_join=True)

    def _await_samples(self, to: int) -> None:
        """Wait for the samples that act before a time in [ns], once for each that is lost."""
        end = time.monotonic() + _PATIENCE
        found: set[str] = set()
        clock = self.get_clock()
        while not self.pacer.is_stopping and clock.now().nanoseconds >= to:  # or was set back
            self._arrived.clear()
            lacking = set(self._lacking(to))
            if lacking <= self._missed:
                return
            unheard = {topic for topic, newest in lacking - self._missed if newest == UNHEARD}
            published = {topic for topic in unheard if self.count_publishers(topic)}
            if published - found:
                found |= published
                end = time.monotonic() + _PATIENCE_AT_FIRST
            if (left := end - time.monotonic()) <= 0.0:
                self._missed = lacking
                return
            self._arrived.wait(min(left, _STOP_CHECK))

    def _lacking(self, to: int) -> Iterator[tuple[str, int]]:
        """Tell which topics have yet to send what a step reads, and their newest stamps [ns]."""
        delay = self.values['wind_delay']
        newest = self._run.newest
        if newest is None:
            yield self._topic, UNHEARD
        elif self._run.lacks_wind(to, delay=delay):
            yield self._topic, newest
        if self._imu is not None:
            yield from self._imu.lacking(to, delay)

    def _frame(self, now: int, periods: int, *, may_join: bool) -> None:
        """Solve up to a time in [ns], and publish due messages."""
        delay = self.values['wind_delay']
        self._run.advance(now, delay=delay, most=periods, may_join=may_join)
        index = now // self.pacer.period
        self.stream.publish(self.simulator, index, now, self.values['publish_every'])
        self._state.publish(index, now, self._run)

    def _reset(self, _request: Any, response: Any) -> Any:
        self._run.request(self.simulator.reset)
        response.success = True
        response.message = 'at rest'
        return response

    def _pause(self, request: Any, response: Any) -> Any:
        self._run.is_paused = bool(request.data)
        response.success = True
        response.message = 'paused' if request.data else 'running'
        return response

    def _statuses(self) -> list[Status]:
        wind = self.publishers_of(self._topic, 'geometry_msgs/Vector3Stamped')
        poses = self.publishers_of(
            self.resolve_topic_name(SEGMENT_POSES.name), 'geometry_msgs/PoseArray'
        )
        replay = self.clock_rate.rate if self.is_simulated else None
        statuses = self._sway_report.statuses(
            self._run, self.pacer, self.stream.frames, replay, wind, poses
        )
        statuses += self.refusals.statuses()
        level, text = (WARN, '; '.join(self._warnings)) if self._warnings else (OK, 'as stated')
        statuses.append(Status('tree', level, shown(text, LONGEST_NOTE), {}))
        return statuses if self._imu is None else [*statuses, *self._imu.statuses()]
