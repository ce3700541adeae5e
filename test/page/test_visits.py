# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Many visits to the page, and not one word on its console."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
import contextlib
import itertools
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip('aiohttp', reason='aiohttp is not installed')

from tree_sway.commands.cli import main  # noqa: E402
from tree_sway.core.settings import Settings  # noqa: E402
from tree_sway.files.trees.source import open_scene  # noqa: E402
from tree_sway.page.page_settings import PageSettings  # noqa: E402
from tree_sway.page.server import PageServer  # noqa: E402
from tree_sway.page.session import Choices, Session  # noqa: E402
from tree_sway.simulation.wind_source import SimulatedWind  # noqa: E402
from tree_sway.stream.controls import Control, ControlPanel, PAUSE_AND_RESET  # noqa: E402

# Whoever was there before may have paused it.
LIVE = "['live', 'paused'].includes(window.treeSway?.state) && treeSway.fps > 0"
SIZES = {'width': 1280, 'height': 800, 'dark': False}, {'width': 390, 'height': 844, 'dark': True}
ENDS = '', '?quality=full', '?solve#shown=strain', '#lang=de&leaves=false', '#lang=ja&autumn=true'
OPERATED = (
    'HTMLAnchorElement.prototype.click = () => undefined;'
    # First: a gesture allows it for five seconds, which a busy machine spends on the others.
    "document.getElementById('full').click();"
    "for (const button of document.querySelectorAll('#tools button, #controls button')) {"
    " if (!button.disabled && !button.hidden && !['full', 'help', 'headset'].includes(button.id))"
    ' button.click(); }'
    "for (const slider of document.querySelectorAll('input[type=range]')) {"
    " slider.stepDown(3); slider.dispatchEvent(new Event('input')); }"
)


@pytest.fixture(scope='module')
def pages(tmp_path_factory: pytest.TempPathFactory) -> Iterator[list[str]]:
    """Addresses of two trees that are served, and of one that is a file."""
    path = tmp_path_factory.mktemp('one') / 'goldcrest.html'
    assert main(['convert', 'goldcrest', '--model', '12', '-o', str(path)]) == 0
    with contextlib.ExitStack() as stack:
        urls = [Path(path).as_uri()]
        for tree in ('goldcrest', 'benjamina'):
            simulator = open_scene(tree).simulator(Settings(), model=12)
            wind = SimulatedWind(6.0)
            session = Session(lambda _, made=simulator: made, Choices(tree), wind)
            speed = Control('mean_speed', 'Wind', 6.0, 'Mean', 'm/s', 0.0, 40.0)
            panel = ControlPanel((speed, *PAUSE_AND_RESET), session.apply, session.pull)
            server = PageServer(PageSettings(port=0), panel, session.status, session.written)
            stack.enter_context(server)
            session.serve(server)
            stack.callback(session.stop)
            urls.append(server.url)
        yield urls


@pytest.mark.parametrize('count', [3, pytest.param(30, marks=pytest.mark.long)])
def test_the_console_is_silent(pages: list[str], browser_class: Any, count: int) -> None:
    """Every page in every size by every address, all buttons and sliders operated in each."""
    visits = list(itertools.product(pages, SIZES, ENDS))
    chosen = visits[:: len(visits) // count]

    async def visit(url: str, size: dict[str, Any]) -> tuple[list[str], list[str]]:
        async with browser_class() as browser:
            await browser.open(url, **size)
            await browser.until(LIVE)
            await browser.call('Runtime.evaluate', expression=OPERATED, userGesture=True)
            drawn = await browser.run('treeSway.scene._frame')
            await browser.until(f'treeSway.scene._frame > {drawn} + 5')
            await browser.run("document.getElementById('clip').click()")
            # A picture or a clip is read back from the canvas, which the driver remarks.
            messages = [each for each in browser.messages if 'due to ReadPixels' not in each]
            return browser.console, messages

    said = [asyncio.run(visit(url + end, size)) for url, size, end in chosen]
    assert len(said) == count
    assert [each for each in said if each != ([], [])] == []
