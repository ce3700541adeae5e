# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A headless Chromium, driven over its DevTools protocol."""

from __future__ import annotations

import asyncio
import base64
import json
import re
import shutil
import subprocess
import tempfile
import time
from types import TracebackType
from typing import Any

DEADLINE = 180.0
_FLAGS = (
    '--headless', '--no-sandbox', '--disable-gpu', '--use-angle=swiftshader',
    '--enable-unsafe-swiftshader', '--disable-quic', '--no-first-run', '--mute-audio',
    '--disable-background-networking', '--disable-component-update', '--disable-sync',
    '--remote-debugging-port=0',
)  # fmt: skip


def chromium() -> str | None:
    """Where Chromium is installed; None if it is not."""
    return shutil.which('chromium') or shutil.which('chromium-browser')


class Chromium:
    """A browser without a page, with flags of its command line, its address, and its end."""

    def __init__(self, *flags: str) -> None:
        self._folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        own = f'--user-data-dir={self._folder.name}', *flags
        command = [str(chromium()), *_FLAGS, *own, 'about:blank']
        self._process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
        assert self._process.stderr is not None
        for line in self._process.stderr:
            found = re.search(r'DevTools listening on (ws://\S+)', line)
            if found:
                break
        else:
            raise AssertionError('Chromium did not start')
        self.address = found[1]

    @property
    def process(self) -> int:
        """Number of its process."""
        return self._process.pid

    def close(self) -> None:
        """End it, and remove what it wrote."""
        self._process.kill()
        self._process.wait()
        assert self._process.stderr is not None
        self._process.stderr.close()
        self._folder.cleanup()


class Browser:
    """
    One page, with storage and cache of its own, in a given browser or one of its own.

    A scale below 1 draws fewer pixels in the same layout.
    """

    def __init__(self, shared: Chromium | None = None, scale: float = 1.0) -> None:
        self.scale = scale
        self._own = None if shared else Chromium()
        self._chromium = shared or self._own
        self._number = 0
        self._target = ''
        self.console: list[str] = []
        self.messages: list[str] = []
        self.requests: list[str] = []

    @property
    def process(self) -> int:
        """Number of its process."""
        assert self._chromium is not None
        return self._chromium.process

    async def __aenter__(self) -> Browser:
        import aiohttp

        assert self._chromium is not None
        self._session = aiohttp.ClientSession()
        self._ws = await self._session.ws_connect(self._chromium.address, max_msg_size=0)
        # It ends with the line, and its pages with it.
        context = await self.call('Target.createBrowserContext', disposeOnDetach=True)
        created = await self.call('Target.createTarget', url='about:blank', **context)
        answer = await self.call('Target.attachToTarget', flatten=True, **created)
        self._target = answer['sessionId']
        for domain in ('Page', 'Runtime', 'Network', 'Log'):
            await self.call(f'{domain}.enable')
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        await self._ws.close()
        await self._session.close()
        if self._own is not None:
            self._own.close()

    async def call(self, method: str, **parameters: Any) -> Any:
        """Call a method of the protocol."""
        self._number += 1
        message: dict[str, Any] = {'id': self._number, 'method': method, 'params': parameters}
        if self._target:
            message['sessionId'] = self._target
        await self._ws.send_str(json.dumps(message))
        while True:
            answer = json.loads((await asyncio.wait_for(self._ws.receive(), DEADLINE)).data)
            if answer.get('id') == self._number:
                assert 'error' not in answer, answer['error']
                return answer['result']
            self._note(answer)

    def _note(self, message: dict[str, Any]) -> None:
        """Keep what went wrong on the page, what it said, and every address that it asked for."""
        method, details = message.get('method'), message.get('params', {})
        if method == 'Runtime.exceptionThrown':
            self.console.append(json.dumps(details['exceptionDetails'])[:600])
        elif method == 'Network.requestWillBeSent':
            self.requests.append(details['request']['url'])
        elif method in ('Runtime.consoleAPICalled', 'Log.entryAdded'):
            self.messages.append(json.dumps(details)[:600])

    async def open(  # noqa: A003
        self,
        url: str,
        width: int = 1280,
        height: int = 800,
        dark: bool = False,
        scale: float | None = None,
    ) -> None:
        """Open a page at a size, a colour scheme and a scale, which is the browser's if None."""
        self.requests = []
        scheme = {'name': 'prefers-color-scheme', 'value': 'dark' if dark else 'light'}
        await self.call('Emulation.setEmulatedMedia', features=[scheme])
        await self.call(
            'Emulation.setDeviceMetricsOverride',
            width=width, height=height, deviceScaleFactor=scale or self.scale, mobile=width < 700,
        )  # fmt: skip
        await self.call('Page.navigate', url=url)

    async def run(self, script: str) -> Any:
        """Value of an expression on the page."""
        answer = await self.call(
            'Runtime.evaluate', expression=script, returnByValue=True, awaitPromise=True
        )
        assert 'exceptionDetails' not in answer, answer['exceptionDetails']
        return answer['result'].get('value')

    async def until(self, script: str, deadline: float = DEADLINE) -> None:
        """Wait until an expression is true on the page."""
        end = time.monotonic() + deadline
        while not await self.run(f'Boolean({script})'):
            assert time.monotonic() < end, (script, self.console)
            await asyncio.sleep(0.05)

    async def screenshot(self) -> bytes:
        """Return the page as PNG."""
        return base64.b64decode((await self.call('Page.captureScreenshot'))['data'])
