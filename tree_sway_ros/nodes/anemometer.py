# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The anemometer node: a simulated wind, as any driver would publish it."""

from __future__ import annotations

from typing import Any

from tree_sway.core.wind.simulated.anemometer import AnemometerModel
from tree_sway.core.wind.simulated.gust_event import GustEvent
from tree_sway.core.wind.simulated.sensor_faults import SensorFaults
from tree_sway.errors import ParameterError
from tree_sway_ros.process.node import TreeSwayNode
from tree_sway_ros.process.topics import WIND
from tree_sway_ros.reports.diagnostics import OK, Status
from tree_sway_ros.timing.pacer import Tick
from tree_sway_ros.wire.wind_messages import WindWriter


class AnemometerNode(TreeSwayNode):
    """Publishes `wind` at a fixed rate."""

    def configure(self) -> None:
        """Make the wind."""
        self._writer = WindWriter(**self.values('output_type', 'direction_convention', 'frame_id'))
        self._model = self._make_model()
        self._faults = self._make_faults()
        self._ticks = self._faulty_since = 0
        self._publisher = self.publisher(WIND, self._writer.message_class)
        self.report_with('simulated anemometer', self._report)
        self._pacer = self.pacer_of(self._tick)

    def activate(self) -> None:
        """Blow."""
        self.run_worker(self._pacer)

    def check_values(self, values: dict[str, Any]) -> None:
        """Refuse gusts and faults that overlap."""
        for what in ('gust', 'fault'):
            duration, every = values[f'{what}_duration'], values[f'{what}_every']
            if values[what] != 'none' and 0.0 < every < duration:
                raise ParameterError(
                    f'{what}s of {duration:g} s every {every:g} s overlap',
                    where=f"parameters '{what}_duration' and '{what}_every'",
                    cure=f'give {what}_every not less than {what}_duration, both at once',
                )

    def on_change(self, values: dict[str, Any]) -> None:
        """Blow otherwise from the next sample on; the gusts of a seed keep their pattern."""
        self._model = self._make_model()
        if any(name.startswith('fault') for name in values):
            self._faults, self._faulty_since = self._make_faults(), self._ticks

    def _make_faults(self) -> SensorFaults:
        values = self.values
        if values['fault'] == 'none':
            return SensorFaults()
        return SensorFaults(values['fault'], values['fault_every'], values['fault_duration'])

    def _make_model(self) -> AnemometerModel:
        names = ('mean_speed', 'bearing_to', 'height', 'intensity', 'rate', 'seed')
        return AnemometerModel(events=self._events(), **self.values(*names))

    def _events(self) -> tuple[GustEvent, ...]:
        values = self.values
        kind = values['gust']
        if kind == 'none':
            return ()
        is_angle = kind in ('direction_change', 'turn')
        amplitude = values['gust_angle' if is_angle else 'gust_speed']
        every, duration = values['gust_every'], values['gust_duration']
        return (GustEvent(kind, amplitude, duration, start=every or 1.0, every=every),)

    def _tick(self, tick: Tick) -> None:
        self._ticks += tick.periods
        since = (self._ticks - self._faulty_since) / self.values['rate']
        for sample in self._faults.sent(since, tick.time, self._model.sample(self._ticks)):
            self._publisher.publish(self._writer.message(*sample))

    def _report(self) -> list[Status]:
        timing = self._pacer.timing()
        values = {'fault': self.values['fault'], **timing._asdict()}
        return [Status('output', OK, f'{timing.rate:.1f} Hz', values)]
