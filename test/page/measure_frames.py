# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Frames per second of the page in a headless Chromium without a graphics unit, the solver beside it.

    python test/page/measure_frames.py goldcrest:1 broadleaf:1 goldcrest:100 --seconds 8

A scene is a tree or a file, and how many of it stand together.

"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import os
from pathlib import Path
import statistics

from conftest import Browser
from tree_sway.commands import show
from tree_sway.page.server import PageServer, PageSettings
from tree_sway.page.session import Choices, Session
from tree_sway.page.wind_source import SimulatedWind


def main() -> None:
    """Measure each scene in turn."""
    parser = argparse.ArgumentParser()
    parser.add_argument('scenes', nargs='+', metavar='TREE:COUNT')
    parser.add_argument('--seconds', type=float, default=8.0)
    parser.add_argument('--profile', action='store_true', help='time of the parts of a frame')
    given = parser.parse_args()
    for scene in given.scenes:
        tree, _, count = scene.partition(':')
        measure(tree, count or '1', given.seconds, given.profile)


def measure(tree: str, count: str, seconds: float, is_profiled: bool) -> None:
    """Print the frames per second that the page tells, after it has settled."""
    told = argparse.ArgumentParser()
    show.add_arguments(told)
    arguments = told.parse_args([tree])
    choices = Choices(tree, count)
    session = Session(
        lambda wanted: show.build_scene(wanted, arguments), choices, SimulatedWind(9)
    )
    with PageServer(PageSettings(port=0), None, session.status) as server:
        session.serve(server)
        try:
            asyncio.run(look(server.url, f'{tree}:{count}', session, seconds, is_profiled))
        finally:
            session.stop()


async def look(url: str, name: str, session: Session, seconds: float, is_profiled: bool) -> None:
    """Open the page and read its counter."""
    async with Browser() as browser:
        await browser.open(url)
        await browser.until("window.treeSway && treeSway.state === 'live' && treeSway.fps > 0")
        await asyncio.sleep(4.0)
        if is_profiled:
            await browser.run(_PROFILE)
        found, cpu = [], cpu_time(browser)
        drawn = await browser.run('treeSway.scene._frame')
        for _ in range(round(seconds / 0.5)):
            await asyncio.sleep(0.5)
            found.append(await browser.run('treeSway.fps'))
        frames = await browser.run('treeSway.scene._frame') - drawn
        cpu = 1e3 * (cpu_time(browser) - cpu) / max(frames, 1)
        status = session.status()
        segments = await browser.run('treeSway.connection.description.nSegments')
        print(
            f'{name}: {segments} segments, {statistics.median(found):.0f} frames/s '
            f'({min(found):.0f} .. {max(found):.0f}), {cpu:.1f} ms of a core per frame, '
            f'{await browser.run("treeSway.scene.leftOut") or "nothing left out"}; '
            f'{status["rate"]:.0f} steps/s of {status["work_us"] / 1e3:.2f} ms',
            flush=True,
        )
        if is_profiled:
            print(await browser.run('JSON.stringify(times)'))


def cpu_time(browser: Browser) -> float:
    """Return what the browser's processes have used so far [s]."""
    parents = {}
    for folder in Path('/proc').glob('[0-9]*'):
        with contextlib.suppress(OSError):
            words = (folder / 'stat').read_text().rpartition(')')[2].split()
            parents[int(folder.name)] = (int(words[1]), int(words[11]) + int(words[12]))
    own, ticks = {browser._process.pid}, 0
    while more := {pid for pid, (parent, _) in parents.items() if parent in own} - own:
        own |= more
    ticks = sum(parents[pid][1] for pid in own if pid in parents)
    return ticks / os.sysconf('SC_CLK_TCK')


_PROFILE = """{
  window.times = {};
  const timed = (object, name) => {
    const method = object[name];
    object[name] = function (...given) {
      const begin = performance.now();
      const result = method.apply(this, given);
      const t = (times[name] ??= [0, 0]);
      t[0] += performance.now() - begin;
      t[1] += 1;
      return result;
    };
  };
  for (const name of ['draw', '_upload', '_castShadow', '_drawTree', '_drawGround', '_drawSolids'])
    timed(treeSway.scene, name);
  timed(treeSway.scene, '_place');
  timed(treeSway.playout, 'sample');
}"""


if __name__ == '__main__':
    main()
