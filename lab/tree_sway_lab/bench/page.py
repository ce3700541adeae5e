# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Frames per second of the page in a headless Chromium without a graphics unit, and its memory."""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import os
from pathlib import Path
import statistics

from tree_sway.errors import ParameterError
from tree_sway.page import Choices, PageServer, PageSettings, Session
from tree_sway.page.commands import add_arguments, build_scene
from tree_sway.simulation import SimulatedWind
from tree_sway_lab.bench.measured import Measured
from tree_sway_lab.browser import Browser, chromium

_SETTLING = 20.0
_WIND = 9.0
_HOUR = 3600.0
_RATE = 30.0

_PUSH = """(seconds, rate) => {
  const { playout, traces } = treeSway;
  const frame = playout._frames[playout._frames.length - 1];
  for (let i = 1; i <= seconds * rate; i++) {
    const stamp = frame.stamp + 1000 * i / rate;
    const coordinates = frame.coordinates.slice();
    playout.push({ ...frame, stamp, coordinates }, stamp + playout.clock.value);
    for (const trace of Object.values(traces)) trace.add(stamp / 1000, 1);
  }
}"""


def time_page(tree: str = 'benjamina', size: int = 1, seconds: float = 10.0) -> list[Measured]:
    """
    Open the page of a tree in wind, the solver beside it on the same cores, and count its frames.

    Parameters
    ----------
    tree
        Name or path of a tree or a stand.
    size
        How many of a tree stand together.
    seconds
        How long frames are counted, after the page has chosen what it draws.

    Returns
    -------
    list of Measured
        Frames per second; processor time of the browser per frame in [ms]; shares of leaves and
        pixels that are drawn in [%]; memory of the page's scripts in [MB], before and after the
        states of an hour at 30 Hz.

    Raises
    ------
    ParameterError
        No Chromium is installed here.

    """
    if chromium() is None:
        raise ParameterError('there is no browser', where='bench page', cure='install chromium')
    parser = argparse.ArgumentParser()
    add_arguments(parser)
    arguments = parser.parse_args([tree])
    session = Session(
        lambda wanted: build_scene(wanted, arguments),
        Choices(Path(tree).name, str(size)),
        SimulatedWind(_WIND),
    )
    with PageServer(PageSettings(port=0), None, session.status) as server:
        session.serve(server)
        try:
            return asyncio.run(_counted(server.url, seconds))
        finally:
            session.stop()


async def _counted(url: str, seconds: float) -> list[Measured]:
    async with Browser() as browser:
        await browser.open(url)
        await browser.until("window.treeSway && treeSway.state === 'live' && treeSway.fps > 0")
        await asyncio.sleep(_SETTLING)
        found, used = [], _processor_time(browser)
        first = await browser.run('treeSway.scene._frame')
        for _ in range(max(1, round(seconds / 0.5))):
            await asyncio.sleep(0.5)
            found.append(await browser.run('treeSway.fps'))
        frames = await browser.run('treeSway.scene._frame') - first
        used = 1e3 * (_processor_time(browser) - used) / max(frames, 1)
        left = await browser.run('treeSway.scene.quality.leftOut')
        left = left or {'leaves': 100, 'pixels': 100}
        # A state of the server beside those of hours ahead would begin a new history.
        await browser.run('treeSway.connection.close()')
        memory = [await _memory(browser)]
        # Twice: what is stored of a minute is there after the first.
        for _ in range(2):
            await browser.run(f'({_PUSH})({_HOUR}, {_RATE})')
            memory.append(await _memory(browser))
    return [
        Measured('frames drawn', statistics.median(found), '1/s'),
        Measured('processor time of a frame', used, 'ms'),
        Measured('leaves drawn', left['leaves'], '%'),
        Measured('pixels drawn', left['pixels'], '%'),
        Measured('memory of the scripts', memory[0], 'MB'),
        Measured('after the states of an hour', memory[1], 'MB'),
        Measured('after those of two hours', memory[2], 'MB'),
    ]


async def _memory(browser: Browser) -> float:
    """Return what the page's scripts hold, without garbage [MB]."""
    await browser.call('HeapProfiler.collectGarbage')
    usage = await browser.call('Runtime.getHeapUsage')
    return 1e-6 * float(usage['usedSize'] + usage.get('backingStorageSize', 0.0))


def _processor_time(browser: Browser) -> float:
    """Return what the browser's processes have used until now [s]."""
    parents = {}
    for folder in Path('/proc').glob('[0-9]*'):
        with contextlib.suppress(OSError):
            words = (folder / 'stat').read_text().rpartition(')')[2].split()
            parents[int(folder.name)] = (int(words[1]), int(words[11]) + int(words[12]))
    own, ticks = {browser.process}, 0
    while more := {pid for pid, (parent, _) in parents.items() if parent in own} - own:
        own |= more
    ticks = sum(parents[pid][1] for pid in own if pid in parents)
    return ticks / os.sysconf('SC_CLK_TCK')
