"""The player node: a recorded wind, as it was, faster, or around and around."""

from __future__ import annotations

from typing import Any

from tree_sway_ros.errors import ParameterError
from tree_sway_ros.files.wind.wind_file import read_wind
from tree_sway_ros.ros.process.node import TreeSwayNode
from tree_sway_ros.ros.process.topics import CLOCK, WIND
from tree_sway_ros.ros.reports.diagnostics import OK, Status
from tree_sway_ros.ros.timing.playback import LONGEST_CLOCK_STEP, Playback, is_ros_time
from tree_sway_ros.ros.timing.playback_thread import PlaybackThread
from tree_sway_ros.ros.wire.wind_messages import WindWriter, clock_message


class PlayerNode(TreeSwayNode):
    """
    Publishes `wind` from a record, and `/clock` if asked to.

    Parameters
    ----------
    options
        For `rclpy.node.Node`.

    """

    def __init__(self, **options: Any) -> None:
        super().__init__("player", **options)
        if not self.values["file"]:
            raise ParameterError("no file to play", cure="give -p file:=wind.csv")
        self._record = read_wind(self.values["file"])
        self._writer = WindWriter(**self.values("output_type", "direction_convention", "frame_id"))
        self._wind = self.publisher(WIND, self._writer.message_class, alone=True)
        has_clock, speed = self.values["publish_clock"], self.values["speed"]
        self._clock_publisher: Any = self.publisher(CLOCK) if has_clock else None
        epoch = self._record.epoch
        if has_clock and not is_ros_time(epoch, self._record.time):
            self.get_logger().warning(
                f"{self._record.source} is dated outside 1970 .. 2038, which /clock cannot say: "
                "it starts at 1 s"
            )
            epoch = None
        playback = Playback(
            self._record.time,
            epoch=epoch,
            **self.values("start", "loop"),
            clock_period=speed / self.values["clock_rate"] if has_clock else 0.0,
        )
        self._thread = PlaybackThread(
            playback,
            speed,
            publish=self._publish,
            may_start=self._may_start,
            on_end=self._end,
            on_error=self.fail,
        )
        self.report_with(self._record.source, self._report)
        self.on_close(self._thread.stop)
        self._thread.start()

    def check_values(self, values: dict[str, Any]) -> None:
        """Refuse a clock in steps so long that nodes would take them for a clock set forward."""
        speed, rate = values["speed"], values["clock_rate"]
        step, longest = speed / rate, LONGEST_CLOCK_STEP
        if values["publish_clock"] and step > longest:
            raise ParameterError(
                f"/clock would go in steps of {step:g} s; nodes follow up to {longest:g} s",
                where="parameters 'speed' and 'clock_rate'",
                cure=f"give speed up to {longest * rate:g}, or clock_rate {speed / longest:g}",
            )

    def _publish(self, row: int, stamp: int) -> None:
        if row < 0:
            self._clock_publisher.publish(clock_message(stamp))
        else:
            self._wind.publish(self._writer.message(stamp, self._record.velocity[row]))

    def _may_start(self) -> bool:
        return not self.values["wait_for_subscriber"] or self._wind.get_subscription_count() > 0

    def _end(self) -> None:
        self.get_logger().info("the record has ended")
        self.is_done = True

    def _report(self) -> list[Status]:
        values = {**self._thread.progress(), "refused in file": self._record.refused}
        return [Status("playback", OK, self._record.source, values)]
