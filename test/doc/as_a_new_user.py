# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The README's commands in a bare Debian, as a new user of it: how long until a tree moves, how big.

    sudo .venv/bin/python test/doc/as_a_new_user.py

Needs debootstrap and, to look at the page, Chromium on this machine. The Debian has Python, its
venv and git; what it fetches packages with (pip's settings, certificates) is this machine's.

"""

from __future__ import annotations

import argparse
import asyncio
from collections.abc import Iterator
from contextlib import contextmanager
import os
from pathlib import Path
import re
import runpy
import shutil
import signal
import subprocess
import sys
import tempfile
import time

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = 'python3,python3-venv,git,ca-certificates'
OF_THIS_MACHINE = ('/etc/pip.conf', '/etc/resolv.conf', '/etc/ssl/certs/ca-certificates.crt')
SHOW = 'python3 .ci/in_venv.py tree-sway show'
DEMO = 'python3 .ci/in_venv.py tree-sway demo --no-page --seconds 4'
Browser = runpy.run_path(str(ROOT / 'lab' / 'tree_sway_lab' / 'browser.py'))['Browser']


def main() -> None:
    """Print seconds and sizes of the first and the second start, and of the demo."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--suite', default='bookworm', help='of Debian (bookworm)')
    given = parser.parse_args()
    # Who is started in the background ignores Ctrl-C, and so would all that it starts.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    with (
        tempfile.TemporaryDirectory(prefix='debian-') as folder,
        debian(folder, given.suite) as run,
    ):
        began = time.monotonic()
        run('git clone -q /srv/tree_sway_ros.git tree_sway_ros')
        seen = look(folder, began)
        print(f'clone to a moving tree: {seen:.0f} s; {size(folder)} MB with its environment')
        print(f'second start to a moving tree: {look(folder, time.monotonic()):.1f} s')
        began = time.monotonic()
        output = run(f'cd tree_sway_ros && {DEMO}')
        print(f'demo, with what it installs: {time.monotonic() - began:.0f} s; {size(folder)} MB')
        print(output.splitlines()[-1])


@contextmanager
def debian(folder: str, suite: str) -> Iterator[object]:
    """Make a Debian in a folder, with a user and the repository; give what runs a line there."""
    Path(folder).chmod(0o755)  # for the user within
    site = 'apt-get indextargets --format $(SITE)'.split()
    mirror = subprocess.run(site, capture_output=True, text=True, check=True).stdout.split()[0]
    bootstrap = [
        'debootstrap',
        '--variant=minbase',
        f'--include={PACKAGES}',
        suite,
        folder,
        mirror,
    ]
    subprocess.run(bootstrap, check=True, stdout=subprocess.DEVNULL)
    for path in map(Path, OF_THIS_MACHINE):
        if path.is_file():
            shutil.copy(path, folder + str(path))
    kept = f'{folder}/srv/tree_sway_ros.git'
    subprocess.run(['git', 'clone', '-q', '--bare', str(ROOT), kept], check=True)
    places = ('proc', 'sys', 'dev')
    for place in places:
        subprocess.run(['mount', '--bind', f'/{place}', f'{folder}/{place}'], check=True)
    subprocess.run(['mount', '--bind', '/dev/shm', f'{folder}/dev/shm'], check=True)
    try:
        for line in ('useradd -m newcomer', 'chown -R newcomer /srv/tree_sway_ros.git'):
            subprocess.run(['chroot', folder, *line.split()], check=True)

        def run(line: str) -> str:
            process = start(folder, line)
            output = process.communicate()[0]
            if process.returncode:
                sys.exit(f'{line}\n{output}')
            return str(output)

        yield run
    finally:
        for place in ('dev/shm', *reversed(places)):
            subprocess.run(['umount', '-l', f'{folder}/{place}'], check=True)


def start(folder: str, line: str) -> subprocess.Popen[str]:
    """Start a line as the new user, in their home."""
    kept = {key: value for key, value in os.environ.items() if 'PIP' in key or 'CERT' in key}
    own = {
        'PATH': '/usr/bin:/bin:/usr/sbin:/sbin',
        'HOME': '/home/newcomer',
        'LANG': 'C.UTF-8',
        **kept,
    }
    shell = ['/bin/bash', '-ec', f'cd; {line}']
    return subprocess.Popen(
        ['/usr/sbin/chroot', '--userspec=newcomer', folder, *shell],
        env=own,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
    )


def look(folder: str, began: float) -> float:
    """Seconds from ``began`` until the tree of `SHOW` has moved on its page."""
    process = start(folder, f'cd tree_sway_ros && exec {SHOW}')
    assert process.stdout is not None
    try:
        for line in process.stdout:
            print('   ', line, end='', flush=True)
            if found := re.search(r'http://\S+', line):
                return asyncio.run(moving(found[0])) - began
    finally:
        os.killpg(process.pid, signal.SIGINT)  # as Ctrl-C does
        process.communicate(timeout=30)
    sys.exit('no page was served')


async def moving(url: str) -> float:
    """When two frames that differ were drawn."""
    async with Browser() as browser:
        await browser.open(url)
        await browser.until("window.treeSway && treeSway.state === 'live' && treeSway.fps > 0")
        return time.monotonic()


def size(folder: str) -> int:
    """Megabytes of what the new user has."""
    home = f'{folder}/home/newcomer'
    output = subprocess.run(['du', '-sm', home], capture_output=True, text=True, check=True).stdout
    return int(output.split()[0])


if __name__ == '__main__':
    main()
