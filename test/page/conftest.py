# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A browser, and JavaScript without one, for tests of the page."""

from __future__ import annotations

from collections.abc import Callable, Iterator
import functools
import json
import shutil
import subprocess
from typing import Any

import pytest
from tree_sway_lab.browser import Browser, Chromium, chromium

FEWER_FRAMES = (
    '{const draw = window.requestAnimationFrame.bind(window);'
    ' window.requestAnimationFrame = (frame) => setTimeout(() => draw(frame), 50);}'
)


@pytest.fixture(scope='session')
def one_chromium() -> Iterator[Chromium]:
    """Start one Chromium for all tests of a process: each opens a page with storage of its own."""
    if chromium() is None:
        pytest.skip('chromium is not installed here')
    made = Chromium()
    yield made
    made.close()


@pytest.fixture(scope='session')
def javascript() -> Callable[..., Any]:
    """Run a JavaScript module in node, with a text on its input, and read the JSON it prints."""
    node = shutil.which('node')
    if node is None:
        pytest.skip('node is not installed here')

    def run(program: str, given: str = '') -> Any:
        command = [node, '--input-type=module', '-e', program]
        done = subprocess.run(
            command, input=given, capture_output=True, text=True, check=False, timeout=120
        )
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)

    return run


class SlowScreen(Browser):
    """A page that is drawn some fifteen times a second, as on a slow machine."""

    async def __aenter__(self) -> Browser:
        await super().__aenter__()
        await self.call('Page.addScriptToEvaluateOnNewDocument', source=FEWER_FRAMES)
        return self


@pytest.fixture
def browser_class(one_chromium: Chromium) -> Callable[[], Browser]:
    """Make pages on a slow screen: without a graphics card every pixel and frame costs time."""
    return functools.partial(SlowScreen, one_chromium, scale=0.5)


@pytest.fixture
def swift_browser_class(one_chromium: Chromium) -> Callable[[], Browser]:
    """Make pages that draw every frame they can."""
    return functools.partial(Browser, one_chromium, scale=0.5)
