# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The tasks of ``doc/tasks.md``, run as typed, and the table of their seconds and results.

    python test/doc/time_tasks.py [NUMBER ...]

Each ``shell`` block of the page is run in an empty folder that has the repository's folders in it,
on this machine. What it may lack has a substitute: ``ros2 launch`` is the three nodes that it
starts, and an anemometer speaks on a serial port of its own. ``test_tasks.py`` runs the same
blocks.

"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, ExitStack
from dataclasses import dataclass, replace
import os
from pathlib import Path
import pty
import random
import re
import socket
import subprocess
import sys
import tempfile
import threading
import time
import tty

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / 'doc' / 'tasks.md'
FOLDERS = ('config', 'doc', 'examples', 'launch', 'test')
DEADLINE = 300.0
PROGRAMS = """
set -eum
trap 'kill $(jobs -p) 2>/dev/null || true' EXIT
tree-sway() { "$PYTHON" -m tree_sway "$@"; }
python() { "$PYTHON" "$@"; }
if ! command -v ros2 >/dev/null; then
  ros2() {
    for node in anemometer wind solver; do
      "$PYTHON" -c "import tree_sway_ros.nodes.executables as e; raise SystemExit(e.$node())" \\
        --ros-args --params-file "config/$node.yaml" -p "$4" &
    done
    wait
  }
fi
"""
TABLE = re.compile(r'(<!-- tasks -->\n).*?(<!-- end -->)', re.DOTALL)
BLOCK = re.compile(r'^### (\d+)\. (.*?)$(.*?)^```shell\n(.*?)^```$', re.MULTILINE | re.DOTALL)

RESULTS = {
    1: r'strength used: (wood .*)',
    2: r'swing +(.* Hz)',
    3: r'goldcrest.glb: (.*)',
    4: r'birch.glb: (.*)',
    5: r'(poses +\d+ at .*)',
    6: r'(\d+ corrections.*)',
    7: r'(\d+ cases in.*)',
    8: r'(1,?000 trees.*)',
    9: r'(green wood breaks at .*)',
    10: r'(tip +[1-9]\S* mm from rest on average.*)',
    11: r'(tip +[1-9]\S* mm from rest on average.*)',
    12: r'strength used: (wood .*)',
    13: r'goldcrest.mp4: (.*)',
    14: r'(of \d+ m/s: .*)',
}
"""What is reported of each task: the last that its commands say of this kind."""


SHORT = (
    (r'--seconds (10|60|300)\b', '--seconds 5'),
    (r'frames=600', 'frames=60'),
    (r'seconds: \d+', 'seconds: 2'),
    (r'height: \[4, [^]]*\], seeds: 2', 'height: [4]'),
    (r'speed: \[3, [^]]*\], seeds: 2', 'speed: [3, 6]'),
)
"""What is replaced in commands, and by what, so that they take less time."""


@dataclass(frozen=True)
class Task:
    """A task of the page: its number and title, and the commands as typed."""

    number: int
    title: str
    commands: str


def tasks() -> list[Task]:
    """Tasks of the page."""
    found = BLOCK.findall(PAGE.read_text(encoding='utf-8'))
    return [Task(int(number), title, commands) for number, title, _, commands in found]


def in_short(task: Task) -> Task:
    """Return the same task with shorter winds and fewer cases."""
    commands = task.commands
    for long, short in SHORT:
        commands = re.sub(long, short, commands)
    return replace(task, commands=commands)


def free_port() -> str:
    """Return a free port of this machine."""
    with socket.create_server(('127.0.0.1', 0)) as free:
        return str(free.getsockname()[1])


@contextmanager
def instrument() -> Iterator[str]:
    """Open a serial port, by its path, on which an anemometer speaks NMEA ten times per second."""
    ours, theirs = pty.openpty()
    tty.setraw(theirs)
    is_over = threading.Event()

    def speak() -> None:
        while not is_over.wait(0.1):
            os.write(ours, b'$WIMWV,270.0,T,6.0,M,A*25\r\n')

    thread = threading.Thread(target=speak)
    thread.start()
    try:
        yield os.ttyname(theirs)
    finally:
        is_over.set()
        thread.join()
        os.close(ours)
        os.close(theirs)


def run(task: Task, folder: Path, environment: dict[str, str]) -> tuple[float, str]:
    """Run a task in a folder; return its seconds and all that it says."""
    for each in FOLDERS:
        (folder / each).symlink_to(ROOT / each)
    paths = os.pathsep.join([str(ROOT), os.environ.get('PYTHONPATH', '')])
    own = {'PYTHON': sys.executable, 'PYTHONPATH': paths}
    with ExitStack() as stack:
        commands = task.commands
        for port in ('7447', '20110'):
            commands = commands.replace(port, free_port())
        if '/dev/ttyUSB0' in commands:
            commands = commands.replace('/dev/ttyUSB0', stack.enter_context(instrument()))
        began = time.monotonic()
        with subprocess.Popen(
            ['bash', '-c', PROGRAMS + commands],
            cwd=folder, env={**environment, **own}, text=True, start_new_session=True,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
        ) as process:  # fmt: skip
            try:
                said, _ = process.communicate(timeout=DEADLINE)
            finally:
                if process.poll() is None:
                    subprocess.run(['pkill', '-KILL', '-s', str(process.pid)], check=False)
        seconds = time.monotonic() - began
    assert process.returncode == 0, f'{commands}\n{said}'
    return seconds, said


def result_of(task: Task, said: str) -> str:
    """Return what the table reports of what a task said."""
    found = re.findall(RESULTS[task.number], said)
    assert found, f"no '{RESULTS[task.number]}' of {task.title}\n{said}"
    return ' '.join(found[-1].split()).replace('|', ',')


def main() -> None:
    """Run the tasks named, or all, and write their rows."""
    chosen = set(map(int, sys.argv[1:])) or set(RESULTS)
    environment = os.environ | {
        'ROS_DOMAIN_ID': str(random.randint(1, 101)),
        'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST',
    }
    page = PAGE.read_text(encoding='utf-8')
    rows = dict(re.findall(r'^(\| (\d+)\..*)$', page, re.MULTILINE))
    rows = {int(number): row for row, number in rows.items()}
    for task in tasks():
        if task.number not in chosen:
            continue
        with tempfile.TemporaryDirectory() as folder:
            seconds, said = run(task, Path(folder), environment)
        title = f'{task.number}. {task.title}'
        rows[task.number] = f'| {title} | {seconds:.0f} | {result_of(task, said)} |'
        print(rows[task.number], flush=True)
    lines = ['| task | seconds | result |', '|---|---|---|', *(rows[key] for key in sorted(rows))]
    table = '\n'.join(lines) + '\n'
    page = TABLE.sub(lambda match: match[1] + table + match[2], page)
    PAGE.write_text(page, encoding='utf-8')


if __name__ == '__main__':
    main()
