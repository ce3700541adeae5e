# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""One demo per ROS domain and machine: two would blow and sway on the same topics."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
import errno
import os
import socket
import sys

from tree_sway.errors import TransportError


@contextmanager
def only_demo() -> Iterator[None]:
    """
    Hold the place of the demo in this ROS domain, else raise a `TransportError`.

    Discovery takes from nothing to seconds, so that looking around misses a demo that runs. A name
    for a socket, without a file, is free again whatever its process died of.
    """
    if not sys.platform.startswith('linux'):
        yield
        return
    domain = os.environ.get('ROS_DOMAIN_ID') or '0'
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as place:
        try:
            place.bind(f'\0tree_sway_ros.demo.{domain}')
        except OSError as error:
            if error.errno != errno.EADDRINUSE:
                raise
            raise TransportError(
                f'another demo runs in ROS domain {domain}',
                cure='end it, or set ROS_DOMAIN_ID to another number up to 101',
            ) from None
        yield
