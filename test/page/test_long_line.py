# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The stream over lines and to clients that are not as good as this machine's own.

What is timed to milliseconds needs an idle machine; ``pytest -m long -s`` prints it.

"""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
import json
from pathlib import Path
import resource
import shutil
import subprocess
import sys
import threading
import time
from typing import Any

import numpy as np
import pytest

aiohttp = pytest.importorskip('aiohttp', reason='aiohttp is not installed')

from tree_sway.page.page_settings import PageSettings  # noqa: E402
from tree_sway.page.server import PageServer  # noqa: E402
from tree_sway.stream.protocol import (  # noqa: E402
    decode_description,
    decode_frame,
    encode_frame,
    Frame,
)

HERE = Path(__file__).parent
DESCRIPTION = (HERE / 'vectors' / 'description.bin').read_bytes()
RATE = 60.0
DEADLINE = 60.0
SECONDS = 6.0
"""That 64 clients read."""


@pytest.mark.long
@pytest.mark.skipif(sys.platform != 'linux', reason='needs network namespaces')
def test_a_long_line_that_loses_packets_loses_no_frame() -> None:
    """30 Hz over 80 ms there and back, 1 % lost, shown 200 ms late."""
    tools = all(map(shutil.which, ('unshare', 'ip'))) and Path('/dev/net/tun').exists()
    if not tools or subprocess.run(['unshare', '-rn', 'true'], check=False).returncode:
        pytest.skip('network namespaces may not be made here')
    command = [sys.executable, str(HERE / 'lossy_line.py'), '--seconds', '20']
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=120)
    seen = json.loads(done.stdout)
    print(seen)
    assert seen['expected'] >= 600
    assert 80.0 <= seen['round_trip_ms'] < 200.0
    assert seen['late_most_ms'] > 30.0  # packets were lost on the way
    assert seen['missing'] <= 0.002


@pytest.fixture
def server() -> Iterator[PageServer]:
    """Run a server that is given a state 60 times per second, on a thread of its own."""
    ended = threading.Event()
    description = decode_description(DESCRIPTION)
    steps = np.zeros(len(description.scale), dtype=np.int16)

    def publish(server: PageServer) -> None:
        due, sequence = time.monotonic(), 0
        while not ended.wait(max(0.0, due - time.monotonic())):
            identity, now = description.short_identity, time.time_ns()
            frame = Frame(identity, sequence, now, 0, np.zeros(3), steps)
            server.publish(encode_frame(frame))
            due, sequence = due + 1.0 / RATE, sequence + 1

    with PageServer(PageSettings(port=0)) as made:
        made.describe(DESCRIPTION)
        thread = threading.Thread(target=publish, args=(made,), daemon=True)
        thread.start()
        yield made
        ended.set()
        thread.join()


async def ages(url: str, seconds: float, credit: int, pause: float = 0.0) -> list[float]:
    """Age of each frame when a client reads it for a time, and rests after each [s]."""
    found: list[float] = []
    async with aiohttp.ClientSession() as session, session.ws_connect(f'{url}stream') as ws:
        await ws.send_json({'credit': credit})
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            message = await asyncio.wait_for(ws.receive(), DEADLINE)
            if message.type is not aiohttp.WSMsgType.BINARY or message.data[:4] == b'TSWD':
                continue
            found.append(time.time() - 1e-9 * decode_frame(message.data).stamp)
            await ws.send_json({'credit': 1})
            await asyncio.sleep(pause)  # the slow reader that is tried
    return found


def test_a_slow_reader_sees_what_is_new(server: PageServer) -> None:
    """Ten frames per second of sixty: a queue would grow by five seconds' worth in six."""
    seconds = 4.0
    seen = asyncio.run(ages(server.url, seconds, credit=2, pause=0.1))
    print(f'10 Hz reader: most {1e3 * max(seen[1:]):.0f} ms')
    assert 5 < len(seen) <= seconds / 0.1 + 2
    assert np.median(seen[len(seen) // 2 :]) < 0.25 * seconds


@pytest.mark.long
def test_sixty_four_clients_are_served_in_time(server: PageServer) -> None:
    command = [sys.executable, str(HERE / 'test_long_line.py'), server.url, '64', str(SECONDS)]
    clients = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    before, began = resource.getrusage(resource.RUSAGE_SELF), time.monotonic()
    output, _ = clients.communicate(timeout=60)
    after, spent = resource.getrusage(resource.RUSAGE_SELF), time.monotonic() - began
    each = [np.array(one) for one in json.loads(output)]
    seen, counts = np.concatenate(each), [len(one) for one in each]
    used = (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime) / spent
    p99 = 1e3 * float(np.quantile(seen, 0.99))
    print(f'64 clients: {len(seen)} frames, p99 {p99:.1f} ms, server {100 * used:.0f} % of a core')
    assert min(counts) > 0.5 * np.median(counts) > 0.0  # nobody is left behind
    assert p99 < 1e3 * SECONDS / 4  # nor served from a queue


def follow(url: str, count: int, seconds: float) -> list[list[float]]:
    """Ages of the frames of each of several clients in this process, of the second half."""

    async def all_of_them() -> Any:
        each = [ages(url, seconds, credit=8) for _ in range(count)]
        return await asyncio.gather(*each)

    return [one[len(one) // 2 :] for one in asyncio.run(all_of_them())]


if __name__ == '__main__':
    print(json.dumps(follow(sys.argv[1], int(sys.argv[2]), float(sys.argv[3]))))
