# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Motion sensors of the solver: topics and places by a parameter, samples to the twin."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any

from tree_sway.core.scene import Run
from tree_sway.errors import ParameterError
from tree_sway.twin import ObservedTree, sensor_reports
from tree_sway_ros.motion.followed_topic import FollowedTopic
from tree_sway_ros.process.topics import IMU, refuse_topic_name
from tree_sway_ros.reports.diagnostics import OK, Status, WARN
from tree_sway_ros.solver import SolverAnnex
from tree_sway_ros.wire.imu_messages import ImuSample, motion_from_message

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
        self._band: dict[str, float] = {}
        self._followed = {
            topic: FollowedTopic(self.node, topic, _TYPE) for topic in self.twin.sensors
        }
        for topic in self.twin.sensors:
            self.node.subscription(replace(IMU, name=topic), self._callback_of(topic))

    def before_step(self, end: float, late: float) -> None:
        """Note the time at which sensors are read, and by how much the wind is later."""
        self.twin.set_time(end)
        self.twin.late_wind.known_late = late
        self.twin.late_wind.is_silent = self._run.is_wind_silent

    def _callback_of(self, topic: str) -> Any:
        followed = self._followed[topic]

        def receive(message: Any, info: Mapping[str, object]) -> None:
            sample = motion_from_message(message)
            stamp = followed.admitted(sample.stamp, info)
            if stamp is None:
                return
            now = int(self.node.get_clock().now().nanoseconds)
            self._run.request(lambda: self._offer(topic, stamp, sample, now))
            followed.newest = stamp
            self._arrived()

        return receive

    def lacking(self, end: int, delay: float) -> Iterator[tuple[str, int]]:
        """Tell which sensors have not yet sent what a step reads of them."""
        # A step averages the samples within half a period about its time.
        read = end - round(1e9 * delay) + self._run.period // 2
        for topic, followed in self._followed.items():
            if followed.lacks(read):
                yield topic, followed.newest

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
        tracks = self.twin.observer.tracks
        for each, track in zip(sensor_reports(self.twin), tracks, strict=True):
            problem = each.problem
            counts = each.counts
            followed = self._followed[each.name]
            values = {
                'place': self.twin.at[each.name],
                'rate [Hz]': round(each.rate, 1),
                'residual over its expected size': round(each.residual, 2),
                'accepted': counts.accepted,
                'refused': counts.refused,
                'refused for their stamps': followed.apart,
                'of other publishers, refused': followed.of_others,
                'silent': counts.silent,
                'disagreed': counts.disagreed,
                'late [s]': round(each.late, 4),
                'share of the motion that the wind explains': round(self.twin.explained, 3),
                **self._band,
                **self._learned_values(),
            }
            if track.is_silent or not counts.accepted:
                problem = followed.clock_problem or problem
            said = ['the tree follows it', *each.notes]
            has_changed = False
            if each.change is not None:
                said.append(str(each.change))
                has_changed = each.change.is_change
                values['frequencies over those before'] = round(each.change.ratio, 3)
                values['their error by chance and wind'] = round(each.change.error, 3)
            faults = [problem] if problem else []
            faults += followed.faults()
            level = WARN if faults or has_changed else OK
            text = '; '.join([*([] if problem else said), *faults])
            found.append(Status(f'imu {each.name}', level, text, values))
        return found
