# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A server and a client of the stream in two networks, and between them a line of our own.

    python test/page/lossy_line.py --delay 0.04 --loss 0.01 --seconds 60

Each side lives in a network namespace whose only way out is a TUN device; its packets come here,
are lost by chance, or forwarded after a delay. So TCP meets what it meets on a long line.

"""

from __future__ import annotations

import argparse
import contextlib
import json
from pathlib import Path
import socket
import subprocess
import sys
import threading
import time
from typing import Any

import numpy as np
from tree_sway_lab.bench.long_line import carry, HERE, join_line, THERE

ROOT = Path(__file__).resolve().parents[2]
VECTORS = Path(__file__).parent / 'vectors'
TOKEN = 'a-long-line'
PORT = 8765
PLAYOUT = 0.2
RATE, SOLVED = 30.0, 60.0


def main() -> None:
    """Run the line, or one side of it, and print what the client saw as JSON."""
    parser = argparse.ArgumentParser()
    parser.add_argument('--delay', type=float, default=0.04, help='one way [s]')
    parser.add_argument('--loss', type=float, default=0.01, help='of packets, either way')
    parser.add_argument('--seconds', type=float, default=60.0)
    parser.add_argument('--side', nargs=2)
    given = parser.parse_args()
    if given.side:
        join_line(int(given.side[1]), HERE if given.side[0] == 'serve' else THERE)
        if given.side[0] == 'serve':
            serve(given.seconds + 60.0)
        else:
            print(json.dumps(listen(given.seconds)))
        return
    print(json.dumps(run_line(given.delay, given.loss, given.seconds)))


def run_line(delay: float, loss: float, seconds: float) -> dict[str, float]:
    """Return what a client sees over a line of such delay [s] and loss."""
    ends = [socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET) for _ in range(2)]
    sides = []
    for name, (_, inner) in zip(('serve', 'listen'), ends, strict=True):
        command = ['unshare', '-rn', sys.executable, __file__, '--seconds', str(seconds)]
        command += ['--side', name, str(inner.fileno())]
        sides.append(
            subprocess.Popen(command, pass_fds=[inner.fileno()], stdout=subprocess.PIPE, cwd=ROOT)
        )
        inner.close()
    ended = threading.Event()
    outer = [end for end, _ in ends]
    carrier = threading.Thread(target=_carry, args=(outer, delay, loss, ended), daemon=True)
    carrier.start()
    try:
        output, _ = sides[1].communicate(timeout=seconds + 60.0)
    finally:
        ended.set()
        carrier.join()
        for side in sides:
            side.kill()
            side.wait()
            assert side.stdout is not None
            side.stdout.close()
        for end in outer:
            end.close()
    found: dict[str, float] = json.loads(output)
    return found


def _carry(*given: Any) -> None:
    with contextlib.suppress(ConnectionError):  # of a side that has done its part
        carry(*given)


def serve(seconds: float) -> None:
    """Publish a state 60 times per second."""
    from tree_sway.page.page_settings import PageSettings
    from tree_sway.page.server import PageServer
    from tree_sway.stream.protocol import decode_description, encode_frame, Frame

    data = (VECTORS / 'description.bin').read_bytes()
    description = decode_description(data)
    steps = np.zeros(len(description.scale), dtype=np.int16)
    end, pause = time.monotonic() + seconds, threading.Event()
    with PageServer(PageSettings(HERE, PORT, TOKEN)) as server:
        server.describe(data)
        due, sequence = time.monotonic(), 0
        while due < end:
            now = time.time_ns()
            frame = Frame(description.short_identity, sequence, now, 0, np.zeros(3), steps)
            server.publish(encode_frame(frame))
            due, sequence = due + 1.0 / SOLVED, sequence + 1
            pause.wait(max(0.0, due - time.monotonic()))


def listen(seconds: float) -> dict[str, Any]:
    """Count the states that are there when they are to be shown."""
    from tree_sway.stream.client import StreamClient

    seen: list[tuple[float, float]] = []
    with StreamClient(
        f'http://{HERE}:{PORT}/?token={TOKEN}',
        rate=RATE,
        delay=PLAYOUT,
        on_frame=lambda frame, arrival: seen.append((1e-9 * frame.stamp, arrival)),
    ) as client:
        client.wait(30.0, frames=round(2 * RATE))  # the window of TCP has opened
        seen.clear()
        client.wait(seconds + 30.0, frames=round((seconds + 2) * RATE))
        round_trip = client.round_trip
    stamps, arrivals = np.array(seen).T
    late = arrivals - stamps - (arrivals - stamps).min()
    expected = RATE * (stamps[-1] - stamps[0]) + 1.0
    return {
        'expected': round(expected),
        'missing': float(1.0 - np.sum(late <= PLAYOUT) / expected),
        'late_p99_ms': float(1e3 * np.quantile(late, 0.99)),
        'late_most_ms': float(1e3 * late.max()),
        'quickest_ms': float(1e3 * (arrivals - stamps).min()),
        'round_trip_ms': 1e3 * round_trip,
    }


if __name__ == '__main__':
    main()
