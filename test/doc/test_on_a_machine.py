# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The commands of ``bash`` blocks, run until what they promise is seen, and ended with Ctrl-C.

What this machine does not have is replaced: a browser, an instrument on a
serial port, a second site, a cluster. Commands of ROS's own tools are left to ``test/launch``.

"""

from __future__ import annotations

from collections.abc import Iterator
import contextlib
from importlib.util import find_spec
import os
from pathlib import Path
import pty
import re
import runpy
import signal
import socket
import subprocess
import sys
import threading
import tty
from types import SimpleNamespace

import pytest

pages = SimpleNamespace(**runpy.run_path(str(Path(__file__).with_name('test_pages.py'))))
PAGES, ROOT, blocks, name = pages.PAGES, pages.ROOT, pages.blocks, pages.name
SHELL = pages.SHELL.replace('{ ', '{ exec ')  # Ctrl-C goes to the command itself

pytestmark = [pytest.mark.long, pytest.mark.ros]

DEADLINE = 300.0
PROMISED = {
    'show': r'https?://\S+',
    'demo': r'tip +[\d.]+ mm \| poses +[\d.]+ Hz',
    'listen': r'poses +\d+ at',
    'record': r'[1-9]\d* of /segment_poses',
    'relay': r'relaying the wind of',
    'study': r'\d+ cases in',
    'calibrate': r'modulus .* GPa',
    'render': r'\d+ pictures',
    'risk': r'\d+ trees.* in [\d.]+ s',
}
"""What each command says once it does what it is for."""
RECORDS = ROOT / 'examples' / 'data'
"""A scanned tree, and what a phone in it has measured."""
NEEDS_A_TREE = ('listen', 'record')
"""Commands that hear a tree which somebody else runs."""


class Machine:
    """Commands in a folder, ended with the machine."""

    def __init__(self, folder: Path, environment: dict[str, str]) -> None:
        self.folder, self.environment = folder, environment
        self.running: list[tuple[str, subprocess.Popen[bytes], Path]] = []

    def make(self, lines: str) -> None:
        """Run lines that end by themselves."""
        shell = ['bash', '-euc', pages.SHELL + lines]
        subprocess.run(shell, cwd=self.folder, env=self.environment, check=True)

    def start(self, line: str) -> None:
        """Start a command, and wait for what it promises."""
        words = line.split()
        pattern = PROMISED[words[words.index('tree-sway') + 1]]
        log = self.folder / f'{len(self.running)}.log'
        with log.open('wb') as out:
            process = subprocess.Popen(
                ['bash', '-c', SHELL + line],
                cwd=self.folder, env=self.environment,
                stdout=out, stderr=subprocess.STDOUT, start_new_session=True,
            )  # fmt: skip
        self.running.append((line, process, log))
        timed_out = threading.Event()
        watch = threading.Timer(DEADLINE, timed_out.set)
        watch.start()
        try:
            while not re.search(pattern, text := log.read_text(encoding='utf-8')):
                assert process.poll() in (None, 0), f'{line}\n{text}'
                assert not timed_out.wait(0.1), f"no '{pattern}' of {line}\n{text}"
        finally:
            watch.cancel()

    def stop(self) -> None:
        """
        Press Ctrl-C everywhere; every command ends by it, and in peace.

        One that has printed its summary but is slow to leave the graph, as on a machine with other
        work, is ended by its own watchdog, with 1 (`Ending`).
        """
        ended = []
        for line, process, log in reversed(self.running):
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGINT)
            code, text = process.wait(DEADLINE), log.read_text(encoding='utf-8')
            is_late = code == 1 and re.search(r'poses .* missing\n', text)
            ended.append((line, 0 if is_late else code))
        self.running.clear()
        assert not [each for each in ended if each[1] not in (0, 130, -signal.SIGINT)], ended


@pytest.fixture
def machine(tmp_path: Path, ros_environment: dict[str, str]) -> Iterator[Machine]:
    for folder in pages.FOLDERS:
        (tmp_path / folder).symlink_to(ROOT / folder)
    paths = os.pathsep.join([str(ROOT), os.environ.get('PYTHONPATH', '')])
    own = {'PYTHON': sys.executable, 'PYTHONPATH': paths, 'BROWSER': 'true'}
    made = Machine(tmp_path, {**ros_environment, **own})
    # Where this runs in the background of a shell, Ctrl-C is ignored, and would be by the
    # commands.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        yield made
    finally:
        signal.signal(signal.SIGINT, before)
        for _, process, _ in made.running:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()


@pytest.fixture
def instrument() -> Iterator[str]:
    """Path of a serial port on which an anemometer speaks NMEA, ten times per second."""
    ours, theirs = pty.openpty()
    tty.setraw(theirs)
    stopped = threading.Event()

    def speak() -> None:
        while not stopped.wait(0.1):
            text = 'WIMWV,270.0,T,6.0,M,A'
            check = 0
            for letter in text.encode():
                check ^= letter
            os.write(ours, f'${text}*{check:02X}\r\n'.encode())

    thread = threading.Thread(target=speak)
    thread.start()
    yield os.ttyname(theirs)
    stopped.set()
    thread.join()
    os.close(ours)
    os.close(theirs)


TWO_SITES = 'share_a_page'
"""The page whose second block speaks to what its first one starts."""


def lines_of(page: Path) -> list[list[str]]:
    """Command lines of ours of each ``bash`` block."""
    found = []
    texts = [text for _, text in blocks(page, 'bash')]
    for text in [''.join(texts)] if page.stem == TWO_SITES else texts:
        text = text.replace('python3 .ci/in_venv.py tree-sway', 'tree-sway')
        lines = [line.split(' # ')[0].strip() for line in text.splitlines()]
        found.append([line for line in lines if 'tree-sway' in line.split()])
    return [lines for lines in found if lines]


TYPED = ROOT / 'doc' / 'tutorials'
"""Tutorials follow each other's files, and are typed in an environment of their own."""
SHELL_BLOCKS = [
    (page, lines) for page in PAGES[1:] if page.parent != TYPED for lines in lines_of(page)
]


@pytest.mark.parametrize(
    ('page', 'lines'), SHELL_BLOCKS, ids=[f'{name(p)}:{ls[0][:40]}' for p, ls in SHELL_BLOCKS]
)
def test_its_commands_do_what_they_promise(
    page: Path, lines: list[str], machine: Machine, request: pytest.FixtureRequest
) -> None:
    stand_ins = {'--seconds 60': '--seconds 2', '--seconds 10': '--seconds 2'}
    text = ' '.join(lines)
    if 'serial:' in text:
        pytest.importorskip('serial', reason='pyserial is not installed')
        stand_ins['serial:/dev/ttyUSB0'] = 'serial:' + request.getfixturevalue('instrument')
    if '--token-file' in text:
        with socket.create_server(('127.0.0.1', 0)) as free:
            port = free.getsockname()[1]
        token = machine.folder / 'token'
        token.touch(0o600)
        token.write_text('of-two-sites-on-one-machine', encoding='utf-8')
        stand_ins |= {
            '--address 0.0.0.0': f'--port {port}',
            'https://tree.local:8765/': f'https://127.0.0.1:{port}/',
        }
        made = [each for _, each in blocks(page, 'sh') if 'openssl' in each]
        if made:
            machine.make(made[0].replace('192.0.2.7', '127.0.0.1'))
        else:
            stand_ins |= {
                ' --certificate site.pem --private-key site.key': '',
                'https://there:8765/': f'http://127.0.0.1:{port}/',
            }
    if 'oak.yaml' in text:
        made = 'tree-sway grow --species oak --height 12 --seed 2 -o oak.yaml'
        if 'phyphox' in page.read_text(encoding='utf-8'):
            made = f'tree-sway convert {RECORDS / "forest_tree.treeqsm.txt"} -o oak.yaml'
            stand_ins['http://192.168.0.42:8080 --seconds 2'] = str(RECORDS / 'pull.phyphox.csv')
            stand_ins['b12:0.5'] = 'b2:0.5'
        machine.make(made)
    if 'avenue.yaml' in text:
        (stand,) = (each for _, each in blocks(page, 'python') if "avenue.yaml').write" in each)
        written = [sys.executable, '-c', stand]
        subprocess.run(written, cwd=machine.folder, env=machine.environment, check=True)
    if 'tree-sway study' in text:
        small = 'trees: [benjamina]\nwinds: [{speed: 4, seeds: 2}]\n'
        small += 'settings: {model: 20}\nseconds: 2\n'
        (machine.folder / 'small.yaml').write_text(small, encoding='utf-8')
        stand_ins |= dict.fromkeys(('config/examples/grown_trees.yaml', 'oaks.yaml'), 'small.yaml')
        # A scheduler and workers started apart are tested in test/forest.
        stand_ins['--scheduler tcp://host:8786'] = '--workers 1'
    if 'inventory.csv' in text:
        trees = 'species,height,dbh_cm\noak,12,30\nspruce,15,28\n'
        (machine.folder / 'inventory.csv').write_text(trees, encoding='utf-8')
    if any(f'tree-sway {each}' in text for each in NEEDS_A_TREE):
        machine.start('tree-sway demo goldcrest --no-page')
    for line in lines:
        for word, ours in stand_ins.items():
            line = line.replace(word, ours)
        machine.start(line)
    machine.stop()


def test_the_first_commands_of_the_readme_move_a_tree(machine: Machine) -> None:
    """In sources with an environment of its own, as a new user types them."""
    if find_spec('ensurepip') is None:
        pytest.skip('this Python cannot make environments')
    (_, text), *_ = blocks(PAGES[0], 'bash')
    commands = [line.split(' # ')[0].strip() for line in text.splitlines()]
    own = {key: value for key, value in machine.environment.items() if key != 'PYTHONPATH'}
    machine.environment = {key: own[key] for key in own if key != 'TREE_SWAY_VENV'}
    clone = ['git', 'clone', str(ROOT), 'tree_sway_ros']
    subprocess.run(clone, cwd=machine.folder, check=True)
    machine.folder = machine.folder / 'tree_sway_ros'
    assert len(commands) == 2
    for command in commands:
        machine.start(command)
        machine.stop()
