# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``kill -9`` of each process of the chain in turn, and its start by whoever looks after it."""

import hashlib
import itertools
import signal
import subprocess
import sys
import time

import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytestmark = pytest.mark.ros

from tree_sway_ros.process.topics import SEGMENT_POSES, WIND_FILTERED  # noqa: E402
from tree_sway_ros.wire.cdr import stamp_of  # noqa: E402

LONGEST = 3.0
"""From a kill to the whole stream [s], with processes that take all of the machine beside."""
PATIENCE = 30.0
_POSES = 28
"""Begin of the poses in a message: behind the header, their count and a gap that nobody fills."""


@pytest.fixture
def chain(run):
    """Start a process, and kill it: ``chain.start("wind")``, ``chain.kill("wind")``."""
    return Processes(run)


class Processes:
    """The processes of the chain, each to be killed and started again."""

    def __init__(self, run):
        self._run = run
        self._arguments = {}
        self._running = {}

    def start(self, name, *parameters):
        self._arguments.setdefault(name, parameters)
        # As where it is installed, whatever the tests themselves run with: with bytecode, and
        # without the tool that numba loads where it finds it.
        bytecode, bare = (
            {'PYTHONDONTWRITEBYTECODE': ''},
            "import sys; sys.modules['coverage'] = None; ",
        )
        self._running[name] = self._run(name, *self._arguments[name], before=bare, **bytecode)

    def kill(self, name):
        process = self._running.pop(name)
        process.send_signal(signal.SIGKILL)
        process.wait()


def outages(chain, observer, tree, rounds):
    """Seconds from each kill to the whole stream of a tree that moves, by who was killed."""
    frames = observer.listen(SEGMENT_POSES, raw=True)
    filtered = observer.listen(WIND_FILTERED, raw=True)
    chain.start('solver', f'tree:={tree}')
    chain.start('wind')
    chain.start('anemometer', 'rate:=50.0')

    def is_whole(seen, heard):
        """Whether frames and wind have come since, and a solver that began at rest feels it."""
        if not (len(frames) > seen + 5 and len(filtered) > heard + 5):
            return False
        return frames[-1][_POSES:] != frames[-2][_POSES:]

    observer.until(lambda: is_whole(0, 0), 'the stream', deadline=60.0)
    found = []
    for name, _ in zip(itertools.cycle(('solver', 'wind', 'anemometer')), range(rounds)):
        chain.kill(name)
        seen, heard, begin = len(frames), len(filtered), time.monotonic()
        chain.start(name)
        observer.until(
            lambda seen=seen, heard=heard: is_whole(seen, heard),
            f'the stream after the end of {name}',
            deadline=PATIENCE,
        )
        found.append((name, time.monotonic() - begin))
    return found


def test_whoever_is_killed_the_stream_is_whole_again(chain, observer, tree_file):
    outages(chain, observer, tree_file, 3)


@pytest.fixture
def load():
    """Two processes that compute all the time."""
    busy = [subprocess.Popen([sys.executable, '-c', 'while True: pass']) for _ in range(2)]
    yield
    for each in busy:
        each.kill()
        each.wait()


@pytest.mark.long
def test_twenty_kills_under_load_cost_three_seconds_each(chain, observer, load):
    found = outages(chain, observer, 'goldcrest', 20)
    print(' '.join(f'{name} {seconds:.2f}' for name, seconds in found))
    assert [each for each in found if each[1] > LONGEST] == []


def digests(observer, frames, last):
    """Digest of each frame of a record by its stamp, up to the last one."""
    observer.until(lambda: frames and stamp_of(frames[-1]) >= last, 'the end', deadline=60.0)
    found = {stamp_of(data): hashlib.sha1(data[_POSES:]).digest() for data in list(frames)}
    return {stamp: digest for stamp, digest in found.items() if 10**9 <= stamp <= last}


@pytest.mark.long
def test_killed_amid_a_replay_the_next_one_is_the_same_bit_for_bit(
    chain, observer, tree_file, tmp_path
):
    record = tmp_path / 'wind.csv'
    rows = [f'{k / 20:.2f},{6 + k % 7},{0.1 * (k % 5):.1f},0' for k in range(40)]
    record.write_text('\n'.join(['time,u,v,w', *rows]) + '\n')
    last = 10**9 + 2 * 10**9 - round(1e9 / 60.0)
    frames = observer.listen(SEGMENT_POSES, raw=True, depth=1000)
    told = (
        'publish_clock:=true',
        'loop:=false',
        "wait_for:='wind wind/filtered segment_poses /clock:2'",
    )
    chain.start('solver', f'tree:={tree_file}', 'use_sim_time:=true', 'exact_replay:=true')
    chain.start('wind', 'use_sim_time:=true')
    chain.start('player', f'file:={record}', *told)
    first = digests(observer, frames, last)
    assert len(set(first.values())) > 100
    for name in ('solver', 'wind', 'player'):
        if name != 'player':
            chain.kill('player')
            frames.clear()
            chain.start('player')
            observer.until(
                lambda: any(15 * 10**8 < stamp_of(data) < last for data in list(frames)),
                'the middle of the record',
                deadline=PATIENCE,
            )
            chain.kill(name)
            chain.start(name)
        chain.kill('player')
        frames.clear()
        chain.start('player')
        assert digests(observer, frames, last) == first, name
