# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree as one HTML file: it opens from a disk, sways, and says what is wrong."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
import io
import json
from pathlib import Path
import re
from typing import Any

import numpy as np
import pytest

pytest.importorskip('aiohttp', reason='aiohttp is not installed')
Image = pytest.importorskip('PIL.Image', reason='Pillow is not installed')

from tree_sway_lab.bench.bench_tree import bench_tree  # noqa: E402

from tree_sway.commands.cli import main  # noqa: E402
from tree_sway.core.scene.make import make_simulator  # noqa: E402
from tree_sway.core.settings import Settings  # noqa: E402
from tree_sway.errors import ParameterError  # noqa: E402
from tree_sway.page.one_file import page_of_scene  # noqa: E402

Browser = Any
LARGEST = 1_000_000
LIVE = "window.treeSway && treeSway.state === 'live' && treeSway.fps > 0"
SHOWN = "(box => box && !box.hidden && box.textContent)(document.getElementById('{}'))"
NOTICE, TOAST = SHOWN.format('notice'), SHOWN.format('toast')


@pytest.fixture(scope='module')
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One for all tests."""
    path = tmp_path_factory.mktemp('one') / 'goldcrest.html'
    assert main(['convert', 'goldcrest', '-o', str(path)]) == 0
    return path


@pytest.fixture
def visit(browser_class: Any) -> Callable[..., None]:
    """Open a file offline and run a script; nothing but the file is asked for."""

    def visited(
        path: Path, script: Callable[[Browser], Coroutine[Any, Any, None]], **size: Any
    ) -> None:
        async def whole() -> None:
            async with browser_class() as browser:
                offline = {'latency': 0, 'downloadThroughput': 0, 'uploadThroughput': 0}
                await browser.call('Network.emulateNetworkConditions', offline=True, **offline)
                await browser.open(path.as_uri(), **size)
                await script(browser)
                asked = [url for url in browser.requests if not url.startswith('data:')]
                assert asked == [path.as_uri()]
                assert browser.console == []

        asyncio.run(whole())

    return visited


def picture(data: bytes) -> Any:
    """Return a screenshot of the middle of the page."""
    image = np.asarray(Image.open(io.BytesIO(data)).convert('RGB'), dtype=np.int16)
    return image[100:600, 380:900]


def changed(path: Path, name: str, change: Callable[[str], str]) -> Path:
    """Write the file with another content of one of its parts."""
    text = path.read_text(encoding='utf-8')
    pattern = re.compile(rf'(id="{name}">)([^<]*)(<)')
    other = path.with_name(f'{name}.html')
    new = pattern.sub(lambda found: found[1] + change(found[2]) + found[3], text)
    other.write_text(new, encoding='utf-8')
    return other


async def drop(browser: Browser, name: str, text: str) -> None:
    """Let a file fall on the page."""
    await browser.run(
        '{const data = new DataTransfer();'
        f'data.items.add(new File([{json.dumps(text)}], {json.dumps(name)}));'
        "document.dispatchEvent(new DragEvent('drop', {dataTransfer: data, cancelable: true}))}"
    )


def test_it_is_small_and_sways(file: Path, visit: Callable[..., None]) -> None:
    assert file.stat().st_size <= LARGEST

    async def script(browser: Browser) -> None:
        await browser.until(LIVE)
        before = picture(await browser.screenshot())
        tip = await browser.run('treeSway.scene.position()')
        moved = 'Math.hypot(...treeSway.scene.position().map((x, c) => x - {}[c])) > 0.002'
        await browser.until(moved.format(json.dumps(tip)))
        assert (np.abs(picture(await browser.screenshot()) - before) > 30).mean() > 1e-3
        await browser.run("treeSway.stream.set('mean_speed', 20)")
        await browser.until('Math.hypot(...treeSway.playout.wind) > 12')
        await browser.run("document.getElementById('control-pause').click()")
        await browser.until("treeSway.state === 'paused'")
        await browser.run("document.getElementById('control-reset').click()")
        await browser.until(
            'Math.hypot(...treeSway.scene.position().map((x, c) =>'
            ' x - treeSway.scene.restPosition()[c])) < 1e-4'
        )

    visit(file, script, scale=1.0)


def test_a_table_of_wind_blows_and_another_file_is_refused(
    file: Path, visit: Callable[..., None]
) -> None:
    async def script(browser: Browser) -> None:
        await browser.until(LIVE)
        rows = 'time,speed [km/h],direction\n0,36,270\n1,36,270\n2,36,270\n'
        await drop(browser, 'mast.csv', rows)
        await browser.until('Math.abs(treeSway.playout.wind[0] - 10) < 1e-6')
        await drop(browser, 'tree.csv', 'x,y,z\n0,0,1\n')
        await browser.until(TOAST)
        text = await browser.run(TOAST)
        assert 'tree.csv is no table of wind' in text
        assert 'Drop another file' in text
        assert await browser.run('treeSway.playout.wind[0] > 9')
        await drop(browser, 'short.csv', 'time,u,v\n0,1,1\n0,1,nan\n')
        await browser.until(f"({TOAST}).includes('short.csv has fewer than two rows')")

    visit(file, script)


@pytest.mark.parametrize(
    ('part', 'change'),
    [
        ('scene', lambda text: text[: len(text) // 2]),
        ('scene', lambda _: 'no base64!'),
        ('modules', lambda text: text[:-400]),
        ('core', lambda text: text[:-400]),
    ],
)
def test_a_damaged_file_says_so(
    file: Path, visit: Callable[..., None], part: str, change: Callable[[str], str]
) -> None:
    async def script(browser: Browser) -> None:
        await browser.until(NOTICE)
        text = await browser.run(NOTICE)
        assert 'file is damaged' in text
        assert 'again' in text

    visit(changed(file, part, change), script)


def test_a_live_wind_that_is_not_there_is_named(file: Path, browser_class: Any) -> None:
    async def whole() -> None:
        async with browser_class() as browser:
            await browser.open(f'{file.as_uri()}?wind=ws://127.0.0.1:9/stream')
            await browser.until(LIVE)
            await browser.until(f"({TOAST} || '').includes('no live wind from ws://127.0.0.1:9')")

    asyncio.run(whole())


def test_a_browser_without_webgl_says_what_to_do(file: Path, browser_class: Any) -> None:
    async def whole() -> None:
        async with browser_class() as browser:
            hidden = 'HTMLCanvasElement.prototype.getContext = () => null'
            await browser.call('Page.addScriptToEvaluateOnNewDocument', source=hidden)
            await browser.open(file.as_uri())
            await browser.until(NOTICE)
            assert 'hardware acceleration' in await browser.run(NOTICE)

    asyncio.run(whole())


@pytest.mark.parametrize('changes', [{'model': 'branch'}, {'model': 20, 'crown_coherence': 0.5}])
def test_a_model_without_a_table_is_refused(changes: dict[str, Any]) -> None:
    # A page has one wind for a tree, and none of each limb.
    simulator = make_simulator(bench_tree(), settings=Settings(**changes))
    with pytest.raises(ParameterError, match='no table to solve it by'):
        page_of_scene(simulator)
