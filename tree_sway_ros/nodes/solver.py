# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The solver node: wind in, poses of every segment out, at a fixed rate."""

from __future__ import annotations

from typing import Any

from std_srvs.srv import SetBool, Trigger

from tree_sway_ros.core.scene.demand import set_demand, set_pace
from tree_sway_ros.core.scene.make import simulators_of
from tree_sway_ros.core.simulator.live_tuning import LIVE
from tree_sway_ros.core.simulator.protocol import Simulator
from tree_sway_ros.core.simulator.season import LEAVES
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.core.wind.averaging import WindAverage
from tree_sway_ros.core.wind.gate import LARGEST_LEAD
from tree_sway_ros.core.wind.height_profile import WindProfile
from tree_sway_ros.core.wind.intake import WindIntake
from tree_sway_ros.errors import ParameterError
from tree_sway_ros.files.kept_set_ups import KeptSetUps
from tree_sway_ros.files.stands.shard import dealt
from tree_sway_ros.files.trees.placement import placed_scene
from tree_sway_ros.files.trees.source import open_scene
from tree_sway_ros.files.trees.yaml.forest_file import ForestFile
from tree_sway_ros.files.trees.yaml.species_yaml import open_species
from tree_sway_ros.nodes.state_publisher import StatePublisher
from tree_sway_ros.ros.process.node import TreeSwayNode
from tree_sway_ros.ros.process.progress import Progress
from tree_sway_ros.ros.process.topics import CAMERA, WIND_FILTERED
from tree_sway_ros.ros.reports.diagnostics import Status, WARN
from tree_sway_ros.ros.reports.sway_report import SwayReport
from tree_sway_ros.ros.timing.handshake import Reach
from tree_sway_ros.ros.timing.pacer import Pacer, Tick
from tree_sway_ros.ros.timing.stepping import Stepper
from tree_sway_ros.ros.wire.pose_stream import PoseStream
from tree_sway_ros.ros.wire.wind_messages import wind_from_message

_FARTHEST_CAMERA = 1e6
"""Along each axis [m]."""


class SolverNode(TreeSwayNode):
    """Subscribes `wind/filtered`; publishes poses, markers and state, and their description."""

    def __init__(self, **options: Any) -> None:
        super().__init__('solver', **options)

    def configure(self) -> None:
        """Open the tree, reduce it and make its kernels ready."""
        with Progress(self.get_logger().info) as progress:
            progress.stage(f"opening tree '{self.values['tree']}'")
            source = self._open()
            progress.stage(
                f'reducing {source.tree.n_segments} segments and making the kernels ready '
                '(where none are kept they are compiled, up to a minute)'
            )
            self._make(source)
        for doubt in source.warnings:
            self.get_logger().warning(doubt)
        for note in source.notes:
            self.get_logger().info(note)
        self.get_logger().info(
            f'ready after {progress.elapsed:.1f} s: {source.tree.name}, {self.simulator.model}, '
            f'{self.values["rate"]:g} Hz'
        )

    def activate(self) -> None:
        """Sway, from rest."""
        self.pacer = self._make_pacer()
        self.on_close(self.pacer.stop)
        self._reach = Reach()
        self.on_close(self._reach.end)
        self.pacer.start()

    def _make_pacer(self) -> Pacer:
        return Pacer(self.get_clock(), self.values['rate'], self._tick, self.fail, self.slip)

    def _open(self) -> Any:
        source = open_scene(self.values['tree'])
        if self.values['species']:
            source = source.of_species(open_species(self.values['species'])).checked()
        placed = placed_scene(source, **self.values('x', 'y', 'z', 'yaw'))
        return dealt(placed, **self.values('shard', 'shards'))

    def _make(self, source: Any) -> None:
        settings = Settings(
            n_modes=self.values['modes'] or None,
            **self.values('stiffness', 'integrator', 'gravity', 'crown_coherence'),
            **self.values('volume_stiffness', 'volume_damping'),
            model=self.values['fidelity'],
            in_leaf=LEAVES[self.values['leaves']],
            damping_ratio=self.values['damping_ratio'] or None,
            root_stiffness=self.values['root_stiffness'] or None,
            profile=WindProfile(
                self.values['profile'],
                self.values['anemometer_height'],
                self.values['profile_exponent'],
                self.values['roughness'],
                ground=0.0 if isinstance(source, ForestFile) else self.values['z'],
            ),
        )
        self.simulator: Simulator = source.simulator(
            settings, kept=KeptSetUps(), **self.values('tolerance')
        )
        if self.values['stiffness_factor'] != 1.0:
            self.simulator.tune(**self.values('stiffness_factor'))
        self._camera: Any = None
        self._refused_cameras = 0
        self.pacer = self._make_pacer()
        self._stepper = Stepper(self.simulator, self._make_wind, self.pacer.period)
        set_pace(simulators_of(self.simulator), self._stepper.warm_up())
        self._set_demand()
        self.simulator.reset()  # on the model that is asked for
        self._intake = WindIntake.of_velocities()
        self._reach = Reach()
        self._sway_report = SwayReport()
        leaves = source.leaves(settings.in_leaf, self.values['leaf_clusters'])
        self.stream = PoseStream(self, source.tree, leaves)
        self._state = StatePublisher(self, self.simulator, self.values['leaf_clusters'])
        self._new_wind = self.polled(WIND_FILTERED)
        self.subscription(CAMERA, self._see)
        self.create_service(Trigger, '~/reset', self._reset)
        self.create_service(SetBool, '~/pause', self._pause)
        self.report_with(source.tree.name, self._statuses)

    def _make_wind(self) -> WindAverage:
        return WindAverage(**self.values('interpolation', 'timeout', 'decay'))

    def _receive(self, message: Any) -> None:
        sample = wind_from_message(message)
        arrival = self._now()
        if self.pacer.is_simulated and sample.stamp > arrival + LARGEST_LEAD:
            return  # of before the clock was set back
        self._reach.add(sample.stamp)
        components = (sample.u, sample.v, sample.w)
        good = self._intake.offer(sample.stamp, components, arrival, lead=self.clock_lead)
        if good is not None:
            self._stepper.add_wind(*good)

    def _see(self, message: Any) -> None:
        at = message.pose.position
        camera = (at.x, at.y, at.z)
        if not all(abs(each) <= _FARTHEST_CAMERA for each in camera):  # NaN is not, either
            self._refused_cameras += 1
            return
        self._camera = camera
        self.on_change({})

    def check_values(self, values: dict[str, Any]) -> None:
        """Refuse a change that the trees could not take while they sway."""
        if not self.is_active:
            return
        changes = {k: values[k] for k in LIVE if k in values and values[k] != self.values[k]}
        if changes.get('damping_ratio') == 0.0:
            raise ParameterError(
                "the species' own damping while the tree sways",
                where='damping_ratio',
                cure='give the ratio itself; 0 is for the start',
            )
        if changes:
            self.simulator.check_tuning(**changes)

    def on_change(self, values: dict[str, Any]) -> None:
        """Take new values before the next step."""
        changes = {k: v for k, v in values.items() if k in LIVE}
        if changes and self.is_active:
            self._stepper.request(lambda: self.simulator.tune(**changes))
        if self.values['fidelity'] == 'auto':
            self._stepper.request(self._set_demand)

    def _set_demand(self) -> None:
        wanted = self.values('tolerance', 'tolerance_pixels', 'focal_length', 'budget')
        set_demand(simulators_of(self.simulator), camera=self._camera, **wanted)

    def slip(self, error: Exception) -> None:
        """Go on from rest: what was amid a step is not to be trusted."""
        super().slip(error)
        self._stepper.request(self.simulator.reset)

    def _tick(self, tick: Tick) -> None:
        if tick.restarted:
            self._stepper.restart(tick.time)
            self._intake.gate.reset()
            self._reach.forget()
        if self.pacer.is_simulated:  # of a replay every frame comes, however late
            for later in range(tick.periods - 1, -1, -1):
                time = tick.time - later * self.pacer.period
                if self.values['exact_replay']:
                    felt = time - round(1e9 * self.values['wind_delay'])
                    self._reach.wait(felt, self._take, self._now)
                else:
                    self._take()
                self._frame(time, 1, may_join=False)
        else:
            self._take()
            self._frame(tick.time, tick.periods, may_join=True)

    def _now(self) -> int:
        return int(self.get_clock().now().nanoseconds)

    def _take(self) -> None:
        for message in self._new_wind():
            self._receive(message)

    def _frame(self, time: int, periods: int, *, may_join: bool) -> None:
        """Solve up to a time in [ns], and publish what is due then."""
        self._stepper.advance(time, periods, self.values['wind_delay'], may_join=may_join)
        index = time // self.pacer.period
        self.stream.publish(self.simulator, index, time, self.values['publish_every'])
        self._state.publish(index, time)

    def _reset(self, _request: Any, response: Any) -> Any:
        self._stepper.request(self.simulator.reset)
        response.success, response.message = True, 'at rest'
        return response

    def _pause(self, request: Any, response: Any) -> Any:
        self._stepper.is_paused = bool(request.data)
        response.success, response.message = True, 'paused' if request.data else 'running'
        return response

    def _statuses(self) -> list[Status]:
        statuses = self._sway_report.statuses(
            self._stepper, self.pacer, self.stream.frames, self._intake.counts
        )
        if self._refused_cameras:
            text = (
                f'{self._refused_cameras} poses of the camera refused: not finite or too far away'
            )
            statuses.append(Status('camera', WARN, text, {'refused': self._refused_cameras}))
        return statuses
