# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
``tree-sway relay``: the wind of a remote site, published as by an anemometer.

The remote site serves a page, by ``tree-sway show`` or the node ``viewer``: only the wind of its
stream is requested, for the nodes `wind` and `solver` of this site.
"""

from __future__ import annotations

import argparse
import time

from tree_sway.commands.ending import Ending
from tree_sway.page.access import read_token
from tree_sway.page.client import StreamClient
from tree_sway.page.protocol import Frame
from tree_sway_ros.commands.watch import add_seconds, seconds_of
from tree_sway_ros.process.listener import Listener
from tree_sway_ros.process.topics import message_class, qos_profile, WIND
from tree_sway_ros.wire.wind_messages import WindWriter

_LOOK = 0.2


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add = parser.add_argument
    add('url', help='address of the page of the remote site, as http://there:8765/')
    add('--token-file', default='', metavar='FILE', help='token of its page')
    add('--namespace', default='', help='namespace of the nodes of this site')
    add('--rate', type=float, default=20.0, help='samples per second [Hz] (%(default)s)')
    add_seconds(parser)


def run(arguments: argparse.Namespace) -> int:
    """Relay the wind until the time is over or Ctrl-C."""
    seconds, token = seconds_of(arguments), read_token(arguments.token_file)
    writer = WindWriter('geometry_msgs/Vector3Stamped', 'to', 'map')
    with Ending() as ending, Listener('tree_sway_relay', arguments.namespace) as site:
        publisher = site.node.create_publisher(message_class(WIND), WIND.name, qos_profile(WIND))

        def take(frame: Frame, _arrival: float) -> None:
            publisher.publish(writer.message(frame.stamp, frame.wind))

        url = f'{arguments.url}?token={token}' if token else arguments.url
        with StreamClient(url, rate=arguments.rate, wind_only=True, on_frame=take) as client:
            client.wait()
            print(f'relaying the wind of {client.url}', flush=True)
            end = time.monotonic() + seconds
            while not ending.is_asked and time.monotonic() < end:
                site.spin(_LOOK)
            print(f'{client.received} samples, {client.unreadable} unreadable')
    return 0
