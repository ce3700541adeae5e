# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The arguments ``--motion`` and ``--at`` of live sensors on the real tree."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, ExitStack
from functools import partial
from typing import TYPE_CHECKING

from tree_sway.commands import say
from tree_sway.errors import ParameterError
from tree_sway.live.commands.sensor_places import add_place_argument, sensors_and_places
from tree_sway.live.transports.transport import ignore

if TYPE_CHECKING:
    from tree_sway.live import MotionFeed
    from tree_sway.live.motion.motion_reading import MotionReading

say_motion = partial(say, kind='motion')
"""Print a line of news of a motion sensor or a camera."""


def add_live_motion_arguments(parser: argparse.ArgumentParser) -> None:
    """Add ``--motion`` and ``--at``."""
    parser.add_argument(
        '--motion', action='append', default=[], metavar='URL',
        help='live motion sensor on the real tree: http://PHONE:8080 '
        '(phyphox), udp:PORT or mqtt://host/topic (JSON); with show also camera:0, camera:page or '
        'camera:rtsp://host/path (doc/camera.md); repeatable (doc/phone_on_a_tree.md)',
    )  # fmt: skip
    add_place_argument(parser)


@contextmanager
def sensing(
    arguments: argparse.Namespace, heard: Sequence[Callable[[MotionReading], None]] = ()
) -> Iterator[MotionFeed]:
    """
    Listen to the sensors of ``--motion``, and end at once.

    Parameters
    ----------
    arguments
        Arguments of `add_live_motion_arguments`.
    heard
        For each sensor, a function called with each of its samples, from its thread.

    Raises
    ------
    ParameterError
        A sensor without a place, two at one address or of one name and place, or a wrong
        address.

    """
    from tree_sway.live import LiveMotion, MotionFeed, open_motion
    from tree_sway.live.motion.motion_feed import PlacedSensor

    places = sensors_and_places(arguments)
    sources = [open_motion(url) for url, _ in places]
    addresses = [str(each.transport) for each in sources]
    for address in addresses:
        if addresses.count(address) > 1:
            raise ParameterError(
                f'two sensors at {address}',
                where='--motion',
                cure='a sensor has one place: give each its own port, host or topic',
            )
    every_heard = heard or [ignore] * len(sources)
    placed = [
        PlacedSensor(LiveMotion(source, say_motion, heard=each), at)
        for source, each, (_, at) in zip(sources, every_heard, places, strict=True)
    ]
    feed = MotionFeed(placed)
    if len(feed.sensors) < len(placed):
        raise ParameterError(
            'two sensors of one name and place',
            where='--motion',
            cure='give each a name: udp:5006?name=stem',
        )
    with ExitStack() as stack:
        for each in placed:
            each.live.start()
            stack.callback(each.live.stop)
        yield feed
