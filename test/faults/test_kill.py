# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``kill -9`` of each process of the chain in turn, and its start by whoever looks after it."""

import itertools
import signal
import subprocess
import sys
import time

import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytestmark = pytest.mark.ros

from tree_sway_ros.process.topics import SEGMENT_POSES, WIND_FILTERED  # noqa: E402

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
        # As where it is installed, whatever the tests themselves run with: with bytecode.
        bytecode = {'PYTHONDONTWRITEBYTECODE': ''}
        self._running[name] = self._run(name, *self._arguments[name], **bytecode)

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
        """Whether frames and wind have come since, and moved a solver that began at rest."""
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
