# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The anemometer node: a simulated wind, published as by a driver."""

from __future__ import annotations

from typing import Any

from tree_sway.errors import ParameterError
from tree_sway.simulation.wind import AnemometerModel, SensorFaults
from tree_sway_ros.process.node import TreeSwayNode
from tree_sway_ros.process.topics import WIND
from tree_sway_ros.reports.diagnostics import OK, Status
from tree_sway_ros.timing.pacer import Tick
from tree_sway_ros.wire.wind_messages import WindWriter


class AnemometerNode(TreeSwayNode):
    """Publishes `wind` at a fixed rate."""

    def configure(self) -> None:
        """Make the wind."""
        self._writer = WindWriter(
            **self.values.subset('output_type', 'direction_convention', 'frame_id')
        )
        self._model = self._make_model()
        self._faults = self._make_faults()
        self._ticks = self._faulty_since = 0
        self._publisher = self.publisher(WIND, self._writer.message_class)
        self.report_with('simulated anemometer', self._report)
        self._pacer = self.pacer_of(self._tick)

    def activate(self) -> None:
        """Publish the next sample."""
        self.run_worker(self._pacer)

    def check_values(self, values: dict[str, Any]) -> None:
        """Refuse overlapping faults."""
        duration = values['fault_duration']
        every = values['fault_every']
        if values['fault'] != 'none' and every < duration:
            raise ParameterError(
                f'faults of {duration:g} s every {every:g} s overlap',
                where="parameters 'fault_duration' and 'fault_every'",
                cure='give fault_every of at least fault_duration, both at once',
            )

    def on_change(self, values: dict[str, Any]) -> None:
        """Change the wind from the next sample on; the gusts of a seed keep their pattern."""
        self._model = self._make_model()
        if any(name.startswith('fault') for name in values):
            self._faults = self._make_faults()
            self._faulty_since = self._ticks

    def _make_faults(self) -> SensorFaults:
        values = self.values
        if values['fault'] == 'none':
            return SensorFaults()
        return SensorFaults(values['fault'], values['fault_every'], values['fault_duration'])

    def _make_model(self) -> AnemometerModel:
        names = ('mean_speed', 'bearing_to', 'height', 'intensity', 'rate', 'seed')
        return AnemometerModel(**self.values.subset(*names))

    def _tick(self, tick: Tick) -> None:
        self._ticks += tick.periods
        since = (self._ticks - self._faulty_since) / self.values['rate']
        for sample in self._faults.sent(since, tick.time, self._model.sample(self._ticks)):
            self._publisher.publish(self._writer.message(*sample))

    def _report(self) -> list[Status]:
        timing = self._pacer.timing()
        values = {'fault': self.values['fault'], **timing._asdict()}
        return [Status('output', OK, f'{timing.rate:.1f} Hz', values)]
