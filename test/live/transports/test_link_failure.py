# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What is told of a connection that fails: what to do, not the number of an error."""

from __future__ import annotations

import errno
import socket

import pytest

from tree_sway.live.registry import open_source
from tree_sway.live.transports.link_failure import failure_text
from tree_sway.live.transports.udp import Udp


@pytest.mark.parametrize(
    ('error', 'words'),
    [
        (ConnectionRefusedError(errno.ECONNREFUSED, 'Connection refused'), 'is its sender on'),
        (OSError(errno.EADDRINUSE, 'Address already in use'), 'another program listens'),
        (PermissionError(errno.EACCES, 'Permission denied'), 'group dialout'),
        (socket.gaierror(-2, 'Name or service not known'), 'no such name'),
        (TimeoutError('timed out'), 'no answer'),
        (OSError("could not open port 'COM3': FileNotFoundError(2, 'no file')"), 'plugged in'),
        (OSError("Multiple exceptions: [Errno 111] Connect call failed ('::1', 1)"), 'refused'),
        (ConnectionError('closed by the other side'), 'closed by the other side'),
        (ValueError('a register'), 'ValueError: a register'),
    ],
)
def test_a_failure_is_told_by_what_to_do(error: Exception, words: str) -> None:
    text = failure_text(error)
    assert words in text
    assert 'Errno' not in text


@pytest.mark.parametrize(
    ('address', 'words'),
    [
        ('tcp://127.0.0.1:1', 'is its sender on'),
        ('http://127.0.0.1:1/wind.json', 'is its sender on'),
        ('signalk://127.0.0.1:1', 'is its sender on'),
        ('mqtt://127.0.0.1:1/wind', 'is its sender on'),
        ('serial:/dev/no-such-device:9600', 'is it plugged in'),
        ('modbus:/dev/no-such-device:9600?speed=1', 'is it plugged in'),
    ],
)
def test_each_way_to_an_instrument_tells_it(hear, address: str, words: str) -> None:
    heard = hear(open_source(address).transport)
    heard.until(lambda: any(words in text for text in heard.said))


def test_a_port_that_another_program_has_is_told(hear, udp_port: int) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(('127.0.0.1', udp_port))
        heard = hear(Udp('127.0.0.1', udp_port))
        heard.until(lambda: any('another program listens' in text for text in heard.said))
