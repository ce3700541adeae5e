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
from typing import Any
from urllib.parse import parse_qsl, urlencode, urlsplit

from tree_sway.commands.ending import Ending
from tree_sway.errors import ParameterError, TransportError
from tree_sway.page.access import read_token
from tree_sway.stream.client import StreamClient
from tree_sway.stream.protocol import Frame, PAUSED, WIND_LOST
from tree_sway_ros.commands.duration import add_seconds, seconds_of
from tree_sway_ros.process.listener import Listener
from tree_sway_ros.process.topics import DIAGNOSTICS, message_class, qos_profile, WIND
from tree_sway_ros.reports.diagnostics import OK, Status, status_array, WARN
from tree_sway_ros.wire.wind_messages import WindWriter

_LOOK = 0.2
_REPORT_EVERY = 1.0
"""Interval of reports on `/diagnostics` [s]."""

_SILENT, _UNREACHED, _PATIENCE = 3.0, 12.0, 30.0
"""Times without a first frame [s] until that is said, and until a page is given up that is not
reached, or that is connected but sends none."""

_OVERDUE = 2.0
"""Time without a frame after which the remote site counts as lost [s]."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add = parser.add_argument
    add('url', help='address of the page at the remote site, such as http://there:8765/')
    add('--token-file', default='', metavar='FILE', help='file with the access token of that page')
    add('--namespace', default='', help='namespace of the nodes at this site')
    add('--rate', type=float, default=20.0, help='samples per second [Hz] (%(default)s)')
    add_seconds(parser)


def run(arguments: argparse.Namespace) -> int:
    """Relay the wind until the time is over or Ctrl-C."""
    seconds = seconds_of(arguments)
    url = with_token(arguments.url, read_token(arguments.token_file))
    with Ending() as ending, Listener('tree_sway_relay', arguments.namespace) as site:
        relay = Relay(site.node)
        with StreamClient(url, rate=arguments.rate, wind_only=True, on_frame=relay.take) as client:
            wait_for_frames(client)
            print(f'relaying the wind of {client.url}', flush=True)
            end = time.monotonic() + seconds
            while not ending.is_asked and time.monotonic() < end:
                site.spin(_LOOK)
                relay.report(client)
            print(f'{relay.published} samples, {client.unreadable} unreadable')
    return 0


def wait_for_frames(client: StreamClient) -> None:
    """
    Wait for the first frame; say after some seconds why there is none yet.

    Raises
    ------
    TransportError
        The server refuses, is not reached, or has no frame to send.

    """
    if client.has_frames(_SILENT):
        return
    problem = client.problem or 'no answer'
    print(f'waiting for {client.url} ({problem}); Ctrl-C ends it', flush=True)
    if client.has_frames(_UNREACHED - _SILENT):
        return
    if client.state != 'open':
        raise TransportError(
            f'not reached within {_UNREACHED:g} s ({client.problem or "no answer"})',
            where=client.url,
            cure='check the address, and that tree-sway show or the node viewer runs there',
        )
    client.wait(_PATIENCE - _UNREACHED)


def with_token(url: str, token: str) -> str:
    """Return the address with a token in its query, unless that is empty."""
    if not token:
        return url
    try:
        parts = urlsplit(url)
    except ValueError as error:
        raise ParameterError(f'not an address ({error})', where='url') from None
    others = [(name, value) for name, value in parse_qsl(parts.query) if name != 'token']
    return parts._replace(query=urlencode([*others, ('token', token)])).geturl()


class Relay:
    """
    Publisher of the remote wind, as long as a sensor measures it there.

    A frame of a paused tree repeats an old wind, and one without a measured wind has the decaying
    or the calm wind of its solver: neither is a sample.
    """

    def __init__(self, node: Any) -> None:
        self.published = 0
        """Number of samples."""
        self._writer = WindWriter('geometry_msgs/Vector3Stamped', 'to', 'map')
        self._node = node
        self._wind = node.create_publisher(message_class(WIND), WIND.name, qos_profile(WIND))
        self._diagnostics = node.create_publisher(
            message_class(DIAGNOSTICS), DIAGNOSTICS.name, qos_profile(DIAGNOSTICS)
        )
        self._flags = 0
        self._arrival = time.monotonic()
        self._reported = -_REPORT_EVERY
        self._text = ''

    def take(self, frame: Frame, _arrival: float) -> None:
        """Publish the wind of a frame if it is a sample; called by the client's thread."""
        self._flags = frame.flags
        self._arrival = time.monotonic()
        if not frame.flags & (PAUSED | WIND_LOST):
            self._wind.publish(self._writer.message(frame.stamp, frame.wind))
            self.published += 1

    def status(self, client: StreamClient) -> Status:
        """Status of the wind for `/diagnostics`."""
        silence = time.monotonic() - self._arrival
        values: dict[str, object] = {
            'samples': self.published,
            'frames': client.received,
            'unreadable': client.unreadable,
            'connection': client.state,
            'age of the last frame [s]': silence,
        }
        level = OK
        text = f'the wind of {client.url}'
        if silence > _OVERDUE:
            level = WARN
            text = f'nothing from {client.url} for {silence:.0f} s: {client.problem}'
        elif self._flags & PAUSED:
            level = WARN
            text = 'nothing is published: the remote tree is paused'
        elif self._flags & WIND_LOST:
            level = WARN
            text = 'nothing is published: the remote site has no measured wind'
        return Status('wind', level, text, values)

    def report(self, client: StreamClient) -> None:
        """Publish the status if it is due, and print it when the wind is lost or back."""
        now = time.monotonic()
        if now - self._reported < _REPORT_EVERY:
            return
        self._reported = now
        status = self.status(client)
        name = self._node.get_fully_qualified_name().lstrip('/')
        stamp = self._node.get_clock().now().to_msg()
        array = status_array([status], prefix=name, hardware=client.url, stamp=stamp)
        self._diagnostics.publish(array)
        heading = status.message.partition(':')[0]
        if heading != self._text and (self._text or status.level != OK):
            print(status.message, flush=True)
        self._text = heading
