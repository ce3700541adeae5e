# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Datagrams that are sent to this machine, to all of its network, or to a multicast group."""

from __future__ import annotations

from dataclasses import dataclass
from ipaddress import ip_address
import socket
import struct

from tree_sway.live.transports.link import Link
from tree_sway.live.transports.stream_lines import READ_FOR
from tree_sway.live.transports.transport import Message

_LARGEST = 65_536


@dataclass(frozen=True)
class Udp:
    """
    A port of this machine, on one of its addresses or on all if the host is empty.

    A multicast address is a group to join. A shared port is one that another program may listen to
    as well, for datagrams that are broadcast.
    """

    host: str
    port: int
    is_shared: bool = False
    silence: float = 10.0

    def __str__(self) -> str:
        """Return its address."""
        return f'udp://{self.host}:{self.port}'

    def listen(self, receiver: Link) -> None:
        """Deliver each datagram."""
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
            is_group = _is_group(self.host)
            if self.is_shared or is_group:
                link.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            link.bind(('' if is_group else self.host, self.port))
            if is_group:
                everywhere = struct.pack('4sl', socket.inet_aton(self.host), socket.INADDR_ANY)
                link.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, everywhere)
            receiver.opened()
            link.settimeout(READ_FOR)
            while not receiver.is_over:
                try:
                    data, (sender, port, *_) = link.recvfrom(_LARGEST)
                except TimeoutError:
                    continue
                receiver.deliver(Message(data, f'{sender}:{port}'))


def _is_group(host: str) -> bool:
    try:
        return ip_address(host).is_multicast
    except ValueError:
        return False
