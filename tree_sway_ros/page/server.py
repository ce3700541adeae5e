# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The page's server: files, a description once, the newest frame to whoever has asked for one more.

It runs on a thread and loop of its own. The solver's thread hands a frame over by storing it and
waking the loop, and never waits. A client gets a frame only for a credit that it gave, and always
the newest one, so that a slow client sees fewer frames, not old ones.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Mapping
import contextlib
from dataclasses import dataclass
from importlib import resources
import json
from pathlib import Path
import ssl
import threading
import time

from aiohttp import web, WSCloseCode, WSMsgType
from aiohttp.typedefs import Handler

from tree_sway_ros.errors import TransportError
from tree_sway_ros.page.access import refusal, require_token
from tree_sway_ros.page.controls import ControlPanel, Value
from tree_sway_ros.page.doorkeeper import Doorkeeper

LARGEST_MESSAGE = 4096
"""Longest message that a client may send in [bytes]."""

MOST_CREDIT = 64
"""Most frames that may be on their way to one client."""

IDLE_TIME = 60.0
"""A client that says nothing for so long is closed [s]; a page speaks several times per second."""

STATUS_PERIOD = 0.5
_START_TIMEOUT = 10.0
_SEND_TIMEOUT = 5.0
_HEADERS = {
    'Content-Security-Policy': "default-src 'self'; img-src 'self' data:; frame-ancestors 'none'",
    'X-Content-Type-Options': 'nosniff',
    'Referrer-Policy': 'no-referrer',
    'Cache-Control': 'no-cache',
}


@dataclass(frozen=True)
class PageSettings:
    """
    Where and to whom the page is served.

    Parameters
    ----------
    address, port
        To bind to; port 0 takes a free one.
    token
        What clients must know; needed for any address but this machine's own.
    certificate, private_key
        PEM files for TLS; none if empty.
    max_clients
        Most pages at once.
    origins
        Other origins, as ``https://example.org``, whose pages may follow the stream.

    """

    address: str = '127.0.0.1'
    port: int = 8765
    token: str = ''
    certificate: str = ''
    private_key: str = ''
    max_clients: int = 64
    origins: tuple[str, ...] = ()


class _Client:
    """One connected page: its credit, and what it has been sent."""

    def __init__(self, socket: web.WebSocketResponse, transport: asyncio.Transport | None) -> None:
        self.socket, self.transport = socket, transport
        self.credit = 0
        self.period = 0.0
        self.next_due = 0.0
        self.sent = -1
        self.wake = asyncio.Event()
        self.texts: deque[str] = deque(maxlen=16)
        self.description = b''
        self.last_heard = time.monotonic()


class PageServer:
    """
    Serves the page and the state of one scene.

    Parameters
    ----------
    settings
        Where and to whom.
    panel
        What viewers may change; nothing if None.
    status
        Called twice a second on the server's thread for what the page shows beside the tree.

    Examples
    --------
    >>> with PageServer(PageSettings()) as server:
    ...     server.describe(description)
    ...     server.publish(frame)

    """

    def __init__(
        self,
        settings: PageSettings,
        panel: ControlPanel | None = None,
        status: Callable[[], Mapping[str, object]] | None = None,
    ) -> None:
        require_token(settings.address, settings.token)
        self.settings = settings
        self._panel = panel or ControlPanel()
        self._status = status or dict
        self._description = b''
        self._frame: tuple[int, bytes] = (-1, b'')
        self._clients: set[_Client] = set()
        self._loop = asyncio.new_event_loop()
        self._started = threading.Event()
        self._failure: Exception | None = None
        self._ending: asyncio.Event | None = None
        self._is_woken = False
        self._counts = dict.fromkeys(('frames', 'sent', 'bytes', 'refused', 'closed_idle'), 0)
        self._doors = Doorkeeper(4 * settings.max_clients)
        self._thread = threading.Thread(target=self._run, name='page', daemon=True)
        self.port = settings.port

    def start(self) -> None:
        """
        Start serving.

        Raises
        ------
        TransportError
            The address cannot be bound, or the TLS files cannot be used.

        """
        self._thread.start()
        self._started.wait(_START_TIMEOUT)
        if self._failure is not None:
            self._thread.join()
            where = f'{self.settings.address}:{self.settings.port}'
            raise TransportError(
                f'the page cannot be served ({self._failure})',
                where=where,
                cure='choose another port, or end what uses this one',
            ) from self._failure

    def close(self) -> None:
        """Close every client and stop; may be called twice."""
        if self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._end)
            self._thread.join(timeout=10.0)

    def __enter__(self) -> PageServer:
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def url(self) -> str:
        """Where to point a browser."""
        scheme = 'https' if self.settings.certificate else 'http'
        token = f'?token={self.settings.token}' if self.settings.token else ''
        address = self.settings.address
        host = f'[{address}]' if ':' in address else address
        return f'{scheme}://{host}:{self.port}/{token}'

    @property
    def n_clients(self) -> int:
        """Pages that are connected."""
        return len(self._clients)

    def describe(self, description: bytes) -> None:
        """Tell all pages, now and later, what the frames that follow belong to."""
        self._description = description
        self._call(self._wake_all)

    def publish(self, frame: bytes) -> None:
        """Hand over the newest frame, from any thread, without waiting."""
        self._frame = (self._frame[0] + 1, frame)
        if not self._is_woken:
            self._is_woken = True
            self._call(self._wake_all)

    def tell(
        self, content: Mapping[str, object], values: Mapping[str, Value] | None = None
    ) -> None:
        """
        Tell all pages something, from any thread.

        Parameters
        ----------
        content
            What JSON can hold.
        values
            Controls that have other values now.

        """
        if values is not None:
            self._panel.update(values)
            content = {**content, 'values': self._panel.values()}
        self._call(lambda: self._tell_all(content))

    def _call(self, action: Callable[[], None]) -> None:
        try:
            self._loop.call_soon_threadsafe(action)
        except RuntimeError:  # the loop is closed
            self._is_woken = False

    def _wake_all(self) -> None:
        self._is_woken = False
        for client in self._clients:
            client.wake.set()

    def _end(self) -> None:
        if self._ending is not None:
            self._ending.set()

    def _run(self) -> None:
        asyncio.set_event_loop(self._loop)
        try:
            self._loop.run_until_complete(self._serve())
        except Exception as error:
            self._failure = error
            self._started.set()
        finally:
            self._loop.close()

    async def _serve(self) -> None:
        self._ending = asyncio.Event()
        app = web.Application(middlewares=[self._guard])
        app.router.add_get('/', self._index)
        app.router.add_get('/stream', self._stream)
        app.router.add_get('/healthz', self._health)
        app.router.add_get('/metrics', self._metrics)
        app.router.add_static('/static', _static_folder(), show_index=False)
        app.on_response_prepare.append(_add_headers)
        runner = web.AppRunner(
            app, access_log=None, keepalive_timeout=15.0, lingering_time=0.5, shutdown_timeout=1.0
        )
        await runner.setup()
        assert runner.server is not None
        make = self._doors.guarding(runner.server)
        server = await self._loop.create_server(
            make, self.settings.address, self.settings.port, ssl=_tls(self.settings), backlog=256
        )
        self.port = server.sockets[0].getsockname()[1]
        self._started.set()
        teller = self._loop.create_task(self._tell_status())
        try:
            await self._ending.wait()
        finally:
            teller.cancel()
            server.close()
            for client in tuple(self._clients):
                await client.socket.close(code=WSCloseCode.GOING_AWAY, message=b'server ends')
            await runner.cleanup()

    @web.middleware
    async def _guard(self, request: web.Request, handler: Handler) -> web.StreamResponse:
        self._doors.let_in(request.protocol)
        if request.can_read_body:
            self._counts['refused'] += 1
            answer = web.Response(status=413, text='refused: nothing here takes a body\n')
            answer.force_close()
            return answer
        if request.path not in ('/healthz',) and not request.path.startswith('/static/'):
            given = request.query.get('token', '')
            settings = self.settings
            why = refusal(
                request.headers,
                given,
                address=settings.address,
                token=settings.token,
                origins=settings.origins,
            )
            if why is not None:
                self._counts['refused'] += 1
                return web.Response(status=403, text=f'refused: {why}\n')
        response: web.StreamResponse = await handler(request)
        return response

    async def _index(self, _request: web.Request) -> web.StreamResponse:
        return web.FileResponse(_static_folder() / 'index.html')

    async def _health(self, _request: web.Request) -> web.Response:
        return web.json_response({'status': 'ok', 'described': bool(self._description)})

    async def _metrics(self, _request: web.Request) -> web.Response:
        counts = {
            'tree_sway_page_clients': ('gauge', 'Pages connected.', len(self._clients)),
            'tree_sway_page_connections': ('gauge', 'Sockets open.', self._doors.n_open()),
            'tree_sway_page_frames_total': ('counter', 'Frames published.', self._frame[0] + 1),
            'tree_sway_page_sent_total': ('counter', 'Frames sent.', self._counts['sent']),
            'tree_sway_page_sent_bytes_total': ('counter', 'Their bytes.', self._counts['bytes']),
            'tree_sway_page_refused_total': (
                'counter', 'Requests and messages refused.', self._counts['refused'],
            ),
            'tree_sway_page_closed_total': (
                'counter', 'Connections closed as idle, slow or too many.',
                self._counts['closed_idle'] + self._doors.n_closed,
            ),
        }  # fmt: skip
        lines = []
        for name, (kind, text, value) in counts.items():
            lines += [f'# HELP {name} {text}', f'# TYPE {name} {kind}', f'{name} {value}']
        return web.Response(text='\n'.join(lines) + '\n')

    async def _stream(self, request: web.Request) -> web.StreamResponse:
        if len(self._clients) >= self.settings.max_clients:
            self._counts['refused'] += 1
            return web.Response(status=503, text='refused: too many pages are connected\n')
        socket = web.WebSocketResponse(
            compress=False, max_msg_size=LARGEST_MESSAGE, heartbeat=20.0, timeout=2.0
        )
        await socket.prepare(request)
        client = _Client(socket, request.transport)
        client.texts.append(self._hello())
        self._clients.add(client)
        sender = self._loop.create_task(self._send(client))
        try:
            async for message in socket:
                client.last_heard = time.monotonic()
                if message.type is WSMsgType.TEXT and self._take(client, message.data):
                    continue
                self._counts['refused'] += 1
                await socket.close(code=WSCloseCode.POLICY_VIOLATION, message=b'not understood')
        finally:
            self._clients.discard(client)
            sender.cancel()
        return socket

    def _hello(self) -> str:
        return json.dumps(
            {'hello': {'controls': self._panel.told(), 'address': self.settings.address}}
        )

    def _take(self, client: _Client, text: str) -> bool:
        """Take a message of a client; False if it is none."""
        try:
            message = json.loads(text)
        except (ValueError, RecursionError):
            return False
        if not isinstance(message, dict):
            return False
        credit, rate, ping = message.get('credit'), message.get('rate'), message.get('ping')
        if isinstance(credit, int) and not isinstance(credit, bool):
            client.credit = max(0, min(client.credit + credit, MOST_CREDIT))
        if isinstance(rate, int | float) and not isinstance(rate, bool) and 0.0 < rate <= 1000.0:
            client.period = 1.0 / rate
        if isinstance(ping, int | float):
            client.texts.append(json.dumps({'pong': ping, 'time': time.time_ns() / 1e6}))
        if 'set' in message:
            self._change(client, message['set'])
        client.wake.set()
        return True

    def _change(self, client: _Client, change: object) -> None:
        change = change if isinstance(change, dict) else {}
        name = change.get('name')
        why = self._panel.set(name, change.get('value'))
        if why is not None:
            self._counts['refused'] += 1
            told = {'name': str(name)[:80], 'reason': why[:400]}
            client.texts.append(json.dumps({'refused': told, 'values': self._panel.values()}))
            return
        self._tell_all({'values': self._panel.values()})

    def _tell_all(self, content: Mapping[str, object]) -> None:
        text = json.dumps(content)
        for client in self._clients:
            client.texts.append(text)
            client.wake.set()

    async def _send(self, client: _Client) -> None:
        """Send a client what is new, as its credit allows."""
        while not client.socket.closed:
            await client.wake.wait()
            client.wake.clear()
            try:
                await asyncio.wait_for(self._send_due(client), _SEND_TIMEOUT)
            except (ConnectionError, RuntimeError, asyncio.TimeoutError):
                self._counts['closed_idle'] += 1
                self._drop(client)
                return

    async def _send_due(self, client: _Client) -> None:
        while client.texts:
            await client.socket.send_str(client.texts.popleft())
        if client.description is not self._description:
            client.description = self._description
            await client.socket.send_bytes(self._description)
        number, frame = self._frame
        if client.credit <= 0 or number == client.sent or not frame or not client.description:
            return
        now = self._loop.time()
        # Half a period early is on time: the solver's frames and the client's rate share no grid.
        if now < client.next_due - 0.5 * client.period:
            self._loop.call_at(client.next_due, client.wake.set)
            return
        client.next_due = max(client.next_due + client.period, now)
        client.credit -= 1
        client.sent = number
        self._counts['sent'] += 1
        self._counts['bytes'] += len(frame)
        await client.socket.send_bytes(frame)

    async def _tell_status(self) -> None:
        assert self._ending is not None
        while not self._ending.is_set():
            with contextlib.suppress(asyncio.TimeoutError):
                await asyncio.wait_for(self._ending.wait(), STATUS_PERIOD)
            silent_since = time.monotonic() - IDLE_TIME
            for client in tuple(self._clients):
                if client.last_heard < silent_since:
                    self._counts['closed_idle'] += 1
                    self._drop(client)
            if self._clients:
                self._tell_all({'status': {**self._status(), 'clients': len(self._clients)}})

    def _drop(self, client: _Client) -> None:
        """Close a client that does not read, without waiting for it."""
        self._clients.discard(client)
        if client.transport is not None:
            client.transport.abort()


def _static_folder() -> Path:
    return Path(str(resources.files('tree_sway_ros.page') / 'static'))


async def _add_headers(_request: web.Request, response: web.StreamResponse) -> None:
    response.headers.update(_HEADERS)


def _tls(settings: PageSettings) -> ssl.SSLContext | None:
    if not settings.certificate:
        return None
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(settings.certificate, settings.private_key or None)
    return context
