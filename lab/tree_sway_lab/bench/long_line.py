# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A line that is late and loses packets, between two networks of this machine.

Each end is a TUN device, one of them in a network namespace whose only way out it is; their
packets come here, are lost by chance, and go on after a delay. So TCP meets what it meets on a
long line. Needs root, as devices do.
"""

from __future__ import annotations

import contextlib
import fcntl
import heapq
import os
import random
import select
import socket
import struct
import subprocess
import threading
import time

HERE, THERE = '10.93.0.1', '10.93.0.2'
_SET_TUN, _TUN_WITHOUT_HEAD = 0x400454CA, 0x1001
_LARGEST = 2048


def carry(ends: list[socket.socket], delay: float, loss: float, ended: threading.Event) -> None:
    """Hand packets from one end to the other, late, or not at all."""
    chance, number = random.Random(1), 0
    waiting: list[tuple[float, int, int, bytes]] = []
    while not ended.is_set():
        left = max(0.0, waiting[0][0] - time.monotonic()) if waiting else 0.05
        for end in select.select(ends, [], [], min(left, 0.05))[0]:
            packet = end.recv(_LARGEST)
            if packet and chance.random() >= loss:
                number += 1
                to = 1 - ends.index(end)
                heapq.heappush(waiting, (time.monotonic() + delay, number, to, packet))
        while waiting and waiting[0][0] <= time.monotonic():
            _, _, to, packet = heapq.heappop(waiting)
            ends[to].send(packet)


def join_line(descriptor: int, address: str) -> None:
    """Make this process's network one device whose packets go over a socket."""
    tun = os.open('/dev/net/tun', os.O_RDWR)
    fcntl.ioctl(tun, _SET_TUN, struct.pack('16sH', b'line', _TUN_WITHOUT_HEAD))
    steps = f'addr add {address}/24 dev line', 'link set line mtu 1400 up', 'link set lo up'
    for words in steps:
        subprocess.run(['ip', *words.split()], check=True)
    end = socket.socket(fileno=descriptor)

    def out() -> None:
        with contextlib.suppress(ConnectionError):  # of an end that has done its part
            while packet := os.read(tun, _LARGEST):
                end.send(packet)

    def back() -> None:
        with contextlib.suppress(ConnectionError):
            while packet := end.recv(_LARGEST):
                os.write(tun, packet)

    for pump in (out, back):
        threading.Thread(target=pump, daemon=True).start()
