# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
``tree-sway relay``: a remote site, served here as a page, or its wind as by an anemometer.

The remote site serves a page, by ``tree-sway show`` or the node ``viewer``. A page here serves its
frames on as they come, and needs no ROS. With ROS only the wind is requested, for the nodes `wind`
and `solver` of this site.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from importlib.util import find_spec
import time
from urllib.parse import parse_qsl, urlencode, urlsplit
import webbrowser

from tree_sway.commands import Ending
from tree_sway.errors import ParameterError, TransportError
from tree_sway.page import PageServer, read_token
from tree_sway.page.commands import add_page_arguments, page_settings, print_address
from tree_sway.stream import MAGIC, StreamClient
from tree_sway_ros.commands.duration import add_seconds, seconds_of

_LOOK = 0.2
_RATE_OF_WIND, _RATE_OF_PAGE = 20.0, 60.0

_SILENT = 3.0
"""Time without a first frame after which that is said [s]."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add = parser.add_argument
    add('url', help='address of the page at the remote site, such as http://there:8765/')
    add('--namespace', default='', help='namespace of the nodes at this site')
    rates = f'{_RATE_OF_WIND:g}, {_RATE_OF_PAGE:g} for a page'
    add('--rate', type=float, help=f'samples or frames per second [Hz] ({rates})')
    add(
        '--page',
        action='store_true',
        help='serve a page, as is done without ROS; the token in the file is that of both pages',
    )
    add_page_arguments(parser)
    add_seconds(parser)


def run(arguments: argparse.Namespace) -> int:
    """Relay until the time is over or Ctrl-C."""
    seconds = seconds_of(arguments)
    url = _with_token(arguments.url, read_token(arguments.token_file))
    if arguments.page or find_spec('rclpy') is None:
        return _to_page(arguments, url, seconds)
    return _to_topics(arguments, url, seconds)


def _to_topics(arguments: argparse.Namespace, url: str, seconds: float) -> int:
    from tree_sway_ros.commands.relay_to_topics import Relay
    from tree_sway_ros.process.listener import Listener

    rate = arguments.rate or _RATE_OF_WIND
    with Ending() as ending, Listener('tree_sway_relay', arguments.namespace) as site:
        relay = Relay(site.node)
        with StreamClient(url, rate=rate, wind_only=True, on_frame=relay.take) as client:
            wait_for_frames(client, seconds)
            print(f'relaying the wind of {client.url}', flush=True)
            end = time.monotonic() + seconds
            while not ending.is_asked and time.monotonic() < end:
                site.spin(_LOOK)
                relay.report(client)
            print(f'{relay.published} samples, {client.unreadable} unreadable')
    return 0


def _to_page(arguments: argparse.Namespace, url: str, seconds: float) -> int:
    """Serve descriptions and frames as they come, to those who look: nothing is changed there."""

    def status() -> Mapping[str, object]:
        return client.status

    def take(message: bytes) -> None:
        if message[:4] == MAGIC:
            server.describe(message)
        else:
            server.publish(message)

    server = PageServer(page_settings(arguments), status=status)
    client = StreamClient(url, rate=arguments.rate or _RATE_OF_PAGE, on_message=take)
    with Ending(is_last=True) as ending, server, client:
        wait_for_frames(client, seconds)
        ending.look()
        print_address(server, f'relaying {client.url} to')
        if arguments.open:
            webbrowser.open(server.url)
        end = time.monotonic() + seconds
        state = client.state
        while not ending.is_asked and time.monotonic() < end:
            time.sleep(_LOOK)
            if client.state != state and client.state != 'connecting':
                state = client.state
                print(f'{client.url}: {state} {client.problem if state == "lost" else ""}')
        print(f'{client.received} frames, {client.unreadable} unreadable')
    return 0


def wait_for_frames(client: StreamClient, seconds: float) -> None:
    """
    Wait for the first frame, at most for a time [s]; say why there is none yet.

    Raises
    ------
    TransportError
        The server refuses for good, or no frame comes within the time.

    """
    told = ''
    while not client.has_frames(min(_SILENT, seconds)):
        seconds -= _SILENT
        problem = client.problem or 'no answer'
        if seconds <= 0.0:
            raise TransportError(
                f'no frame in time ({problem})',
                where=client.url,
                cure='check the address, and that tree-sway show or the node viewer runs there',
            )
        if problem != told:
            told = problem
            print(f'waiting for {client.url} ({told}) until it is there', flush=True)


def _with_token(url: str, token: str) -> str:
    """Return the address with a token in its query, unless that is empty."""
    if not token:
        return url
    try:
        parts = urlsplit(url)
    except ValueError as error:
        raise ParameterError(f'not an address ({error})', where='url') from None
    others = [(name, value) for name, value in parse_qsl(parts.query) if name != 'token']
    return parts._replace(query=urlencode([*others, ('token', token)])).geturl()
