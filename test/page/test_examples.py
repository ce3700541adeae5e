# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The examples as their pages say: on a server of this program, in Python and in a browser."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
import functools
import http.server
import json
from pathlib import Path
import re
import shutil
import subprocess
import sys
import tarfile
import threading
from typing import Any

import numpy as np
import pytest

import tree_sway

pytest.importorskip('aiohttp', reason='aiohttp is not installed')

from tree_sway.commands.cli import main  # noqa: E402
from tree_sway.files.trees.source import open_scene  # noqa: E402
from tree_sway.page.page_settings import PageSettings  # noqa: E402
from tree_sway.page.server import PageServer  # noqa: E402
from tree_sway.page.session import Choices, Session  # noqa: E402
from tree_sway.simulation.wind_source import SimulatedWind  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
WEB = ROOT / 'examples' / 'web'
DEADLINE = 90
"""Until a tree has been seen to sway [s]."""


class Quiet(http.server.SimpleHTTPRequestHandler):
    """Files of a folder, without a word."""

    def log_message(self, *_told: Any) -> None:
        """Say nothing."""


@pytest.fixture(scope='module')
def files() -> Iterator[str]:
    """Address of a server of this repository's files."""
    handler = functools.partial(Quiet, directory=str(ROOT))
    with http.server.ThreadingHTTPServer(('127.0.0.1', 0), handler) as served:
        threading.Thread(target=served.serve_forever, daemon=True).start()
        yield f'http://127.0.0.1:{served.server_port}'
        served.shutdown()


@pytest.fixture(scope='module')
def page(files: str) -> Iterator[PageServer]:
    """Serve a live tree whose stream the pages of the examples may follow."""
    simulator = open_scene('goldcrest').simulator()
    session = Session(lambda _: simulator, Choices('goldcrest'), SimulatedWind(9.0))
    with PageServer(PageSettings(port=0, origins=(files,)), None, session.status) as server:
        session.serve(server)
        yield server
        session.stop()


def test_python_follows_a_tree(page: PageServer) -> None:
    command = [sys.executable, str(ROOT / 'examples/python/follow.py'), page.url]
    following = [*command, '--seconds', str(DEADLINE)]
    tips: set[str] = set()
    with subprocess.Popen(following, stdout=subprocess.PIPE, text=True, cwd=ROOT) as running:
        assert running.stdout is not None
        for line in running.stdout:
            wind, tip = re.fullmatch(
                r'wind +([\d.]+) m/s, tip at (\S+ \S+ \S+) m\n', line
            ).groups()
            tips |= {tip} if float(wind) > 0.5 else set()
            if len(tips) >= 3:
                break
        running.kill()
    assert len(tips) >= 3


@pytest.fixture(scope='module')
def three() -> None:
    """three.js beside the examples, from npm."""
    npm = shutil.which('npm')
    if (ROOT / 'node_modules' / 'three').is_dir():
        return
    if npm is None:
        pytest.skip('npm is not installed here')
    command = [
        npm,
        'install',
        '--no-package-lock',
        '--no-audit',
        '--no-fund',
        '--prefix',
        str(ROOT),
    ]
    if subprocess.run(command, capture_output=True, timeout=180).returncode:
        pytest.skip('npm cannot bring three.js here')


@pytest.mark.parametrize(
    ('kind', 'count'),
    [('poses', 1), ('gltf', 1), pytest.param('gltf', 36, marks=pytest.mark.long)],
)
@pytest.mark.usefixtures('three')
def test_three_draws_a_tree_that_sways(
    kind: str,
    count: int,
    page: PageServer,
    files: str,
    browser_class: Any,
) -> None:
    if kind == 'gltf':
        target = WEB / 'tree.glb'
        command = ['convert', 'goldcrest', '--sway', 'morph']
        assert main([*command, '-o', str(target), '--force']) == 0

    more = f'&count={count}' if count > 1 else ''

    async def look() -> None:
        async with browser_class() as browser:
            address = f'{files}/examples/web/{kind}.html?page={page.url}{more}'
            await browser.open(address, 640, 480, scale=1.0)
            await browser.until('window.example && example.stream.playout.received > 10')
            before = await browser.run('example.tip()')
            await browser.until(
                f'Math.hypot(...example.tip().map((x, k) => x - {before}[k])) > 1e-3'
            )
            assert await browser.run("document.getElementById('state').textContent") == 'open'
            assert browser.console == []
            drawn = await browser.run('example.stage.renderer.info.render.triangles')
            assert drawn > 1000 * count
            (ROOT / 'build').mkdir(exist_ok=True)
            picture = ROOT / 'build' / f'{kind}{count}.png'
            picture.write_bytes(await browser.screenshot())

    asyncio.run(look())


@pytest.mark.usefixtures('three')
def test_the_package_of_npm_places_the_segments_of_a_stream(tmp_path: Path) -> None:
    """What `npm pack` packs is all that a program outside this repository needs."""
    pack = [str(shutil.which('npm')), 'pack', '--json', '--pack-destination', str(tmp_path)]
    packed = json.loads(subprocess.check_output(pack, cwd=ROOT, timeout=60))[0]
    assert packed['version'] == tree_sway.__version__
    modules = tmp_path / 'node_modules'
    with tarfile.open(tmp_path / packed['filename']) as archive:
        # Some Pythons 3.10 and 3.11 have no filters yet.
        archive.extraction_filter = getattr(tarfile, 'data_filter', None)
        archive.extractall(modules)
    (modules / 'package').rename(modules / 'tree-sway')
    (modules / 'three').symlink_to(ROOT / 'node_modules' / 'three')
    program = tmp_path / 'program.mjs'
    program.write_text(FOREIGN_PROGRAM, encoding='utf-8')
    vectors = ROOT / 'test' / 'page' / 'vectors'
    node = str(shutil.which('node'))
    done = subprocess.run(
        [node, program, vectors], capture_output=True, text=True, check=False, timeout=60
    )
    assert done.returncode == 0, done.stderr
    frame = json.loads((vectors / 'expected.json').read_text(encoding='utf-8'))['frames'][1]
    np.testing.assert_allclose(
        np.reshape(json.loads(done.stdout), (-1, 3)), np.array(frame['poses'])[:, :3], atol=1e-5
    )


FOREIGN_PROGRAM = """
import { readFileSync } from "node:fs";
import { TreeStream } from "tree-sway";
import { SwayingTrees } from "tree-sway/three";

const bytes = (name) => new Uint8Array(readFileSync(`${process.argv[2]}/${name}.bin`)).buffer;

globalThis.WebSocket = class {
  static OPEN = 1;
  readyState = 1;
  send() {}
  close() {}
  constructor() {
    setTimeout(() => {
      this.onopen();
      for (const name of ["description", "frame1"]) this.onmessage({ data: bytes(name) });
      trees.update();
      const { array } = trees.segments.instanceMatrix;
      const at = (row) => [...array.subarray(16 * row + 12, 16 * row + 15)];
      console.log(JSON.stringify(Array.from({ length: trees.segments.count }, (_, k) => at(k))));
      stream.close();
    });
  }
};
const stream = new TreeStream("http://127.0.0.1:8765/");
const trees = new SwayingTrees(stream);
stream.open();
"""
"""Prints where the trees of a recorded stream stand after its second frame."""
