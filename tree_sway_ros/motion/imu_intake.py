# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Motion sensors of the solver: topics and places by a parameter, samples to the twin."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import partial
import time
from typing import Any

from tree_sway.core.scene import Run
from tree_sway.errors import ParameterError
from tree_sway.twin import ObservedTree, sensor_reports
from tree_sway_ros.process.topics import IMU, refuse_topic_name
from tree_sway_ros.reports.diagnostics import OK, Status, WARN
from tree_sway_ros.reports.one_publisher import OnePublisher
from tree_sway_ros.solver import SolverAnnex, UNHEARD
from tree_sway_ros.wire.imu_messages import ImuSample, motion_from_message

_APART = 5_000_000_000
"""Largest difference of a stamp from the node's clock in [ns]."""

_TYPE = 'sensor_msgs/Imu'


def places_of(text: str) -> dict[str, str]:
    """
    Return the place of each topic of a text ``TOPIC@PLACE, TOPIC@PLACE``.

    A `ParameterError` refuses a text of another form, a topic given twice, and no name of one.
    """
    found: dict[str, str] = {}
    for part in filter(None, (each.strip() for each in text.split(','))):
        topic, at, place = (each.strip() for each in part.partition('@'))
        if not (topic and at and place) or topic in found:
            what = f"'{part}' is no topic with a place of its own"
            cure = "give TOPIC@PLACE, several with commas, as 'tree/imu@3.2, limb/imu@b12:0.5'"
            raise ParameterError(what, where='imu', cure=cure)
        refuse_topic_name(topic, 'imu')
        found[topic] = place
    return found


class ImuIntake(SolverAnnex):
    """
    Subscriptions of the sensors of an observed tree, which who makes it sets.

    Samples are handed to the thread of the steps, so that no callback waits for a step.
    """

    twin: ObservedTree

    def begin(self, run: Run, arrived: Callable[[], object]) -> None:
        """Subscribe to each sensor."""
        self._run = run
        self._arrived = arrived
        self._clocks_apart: dict[str, tuple[int, float]] = {}
        self._newest: dict[str, int] = {}
        self._band: dict[str, float] = {}
        self._followed = {topic: OnePublisher() for topic in self.twin.sensors}
        for topic in self.twin.sensors:
            self.node.subscription(replace(IMU, name=topic), self._callback_of(topic))

    def before_step(self, felt: float) -> None:
        """Note the time at which sensors are read."""
        self.twin.set_time(felt)

    def _callback_of(self, topic: str) -> Any:
        publishers = partial(self.node.count_publishers, topic)

        def receive(message: Any, info: Mapping[str, object]) -> None:
            if not self._followed[topic].admits(info, publishers, time.monotonic()):
                return
            sample = motion_from_message(message)
            now = int(self.node.get_clock().now().nanoseconds)
            stamp = sample.stamp or now
            limits = self.node.stamp_limits
            if not -_APART - limits['lag'] <= stamp - now <= _APART + limits['lead']:
                count, _ = self._clocks_apart.get(topic, (0, 0.0))
                self._clocks_apart[topic] = count + 1, (stamp - now) * 1e-9
                return
            self._run.request(lambda: self._offer(topic, stamp, sample, now))
            self._newest[topic] = stamp
            self._arrived()

        return receive

    def lacking(self, end: int, delay: float) -> Iterator[tuple[str, int]]:
        """Tell which sensors have not yet sent what a step reads of them."""
        # A step averages the samples within half a period about its time.
        read = end - round(1e9 * self._run.behind(delay)) + self._run.period // 2
        for topic in self.twin.sensors:
            newest = self._newest.get(topic, UNHEARD)
            if newest <= read and (newest != UNHEARD or self.node.count_publishers(topic)):
                yield topic, newest

    def _offer(self, topic: str, stamp: int, sample: ImuSample, now: int) -> None:
        """Offer a sample, in the thread of the steps."""
        sensor = self.twin.sensors[topic]
        sensor.stated_noise = sample.noise
        sensor.offer(
            stamp * 1e-9,
            acceleration=sample.acceleration,
            rate=sample.rate,
            orientation=sample.orientation,
            arrival=now * 1e-9,
        )

    def _learned_values(self) -> dict[str, float]:
        """Values of what the sensors have told about the tree; none before the first fit."""
        learned = self.twin.learned
        if learned is None:
            return {}
        return {
            'first frequency [Hz]': round(learned.frequency, 4),
            'stiffness over that of the file': round(learned.stiffness, 3),
            'damping over that of the file': round(learned.damping, 3),
            'drag over that of the file': round(learned.drag, 3),
            'learned from [h]': round(learned.hours, 2),
        }

    def _find_band(self) -> None:
        """Find how sure the motion is, in the thread of the steps."""
        if self.twin.members is not None:
            low, high = self.twin.sway_band().tolist()
            self._band = {
                'highest tip of 80 % of trees, from [m]': round(low, 4),
                'highest tip of 80 % of trees, to [m]': round(high, 4),
            }

    def statuses(self) -> list[Status]:
        """Report each sensor: in use or why not, and its counts."""
        found = []
        self._run.request(self._find_band)
        for each in sensor_reports(self.twin):
            problem = each.problem
            counts = each.counts
            others = self._followed[each.name].refused
            apart, by = self._clocks_apart.get(each.name, (0, 0.0))
            values = {
                'place': self.twin.at[each.name],
                'rate [Hz]': round(each.rate, 1),
                'residual over its expected size': round(each.residual, 2),
                'accepted': counts.accepted,
                'refused': counts.refused,
                'refused for their stamps': apart,
                'of other publishers, refused': others,
                'silent': counts.silent,
                'disagreed': counts.disagreed,
                'late [s]': round(each.late, 4),
                'share of the motion that the wind explains': round(self.twin.explained, 3),
                **self._band,
                **self._learned_values(),
            }
            if apart and not counts.accepted:
                problem = f'{apart} refused: stamps differ from this clock by {by:.1f} s: '
                problem += 'synchronise the clocks (chrony, or that of micro-ROS)'
            said = ['the tree follows it', *each.notes]
            has_changed = False
            if each.change is not None:
                said.append(str(each.change))
                has_changed = each.change.is_change
                values['frequencies over those before'] = round(each.change.ratio, 3)
                values['their error by chance and wind'] = round(each.change.error, 3)
            faults = [problem] if problem else []
            faults += self._followed[each.name].faults(self.node.publishers_of(each.name, _TYPE))
            level = WARN if faults or has_changed else OK
            text = '; '.join([*([] if problem else said), *faults])
            found.append(Status(f'imu {each.name}', level, text, values))
        return found
