# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The page's server: files, a description, and the newest frame to clients that request one.

It has its own thread and loop. The solver's thread publishes a frame by storing it and waking the
loop, and never waits. A client gets a frame only for a credit that it gave, and always the newest
one, so that a slow client gets fewer frames, not old ones.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from html import escape
from importlib import resources
import json
import logging
import math
from pathlib import Path
import socket
import ssl
import threading
import time
from typing import Any

from aiohttp import web, WSCloseCode, WSMsgType
from aiohttp.typedefs import Handler

from tree_sway.errors import TransportError, TreeSwayError
from tree_sway.page.access import (
    Access,
    access_of,
    cookie_token,
    given_token,
    Guesses,
    is_own_page,
    read_token,
    refusal,
    require_token,
    viewers_token,
    WRONG_TOKEN,
)
from tree_sway.page.doorkeeper import Doorkeeper
from tree_sway.stream.controls import ControlPanel, Value
from tree_sway.stream.protocol import FRAME_SIZE, part_of_frame

LARGEST_MESSAGE = 4096
"""Longest message of a client in [bytes]."""

MOST_CREDIT = 64
"""Largest number of frames in transit to one client."""

SLOWEST, FASTEST = 0.1, 1000.0
"""Range of frames per second of a client [Hz]."""

IDLE_TIME = 60.0
"""Time without a message after which a client is closed [s]; a page sends several a second."""

STATUS_PERIOD = 0.5
STATE_PERIOD = 5.0
"""Interval of coordinates for a client that solves by itself [s]."""

MOST_IN_STATE = 600
"""Number of coordinates that are sent to it each time, in turn."""

_COMPLAINT_PERIOD = 10.0
_LARGEST_PING = 1e15
_LONGEST_PATH = 100
_LOGGER = logging.getLogger('tree_sway.page')
_START_TIMEOUT = 10.0
_SEND_TIMEOUT = 5.0
_MOST_TEXTS = 16
_MOST_WAITING = 3
"""Requests for the tree as a file that wait for the one that is written."""

_MAY_LOOK = 'this link is to look only: ask for one with control'
_STATIC = Path(str(resources.files('tree_sway.page'))) / 'static'
_HEADERS = {
    'Content-Security-Policy': "default-src 'self'; img-src 'self' data:; frame-ancestors 'none'",
    'X-Content-Type-Options': 'nosniff',
    'Referrer-Policy': 'no-referrer',
    'Cache-Control': 'no-cache',
}


@dataclass(frozen=True)
class PageSettings:
    """
    Address of the page and its access.

    Parameters
    ----------
    address, port
        Address to bind to; 0 is a free port.
    token, token_file
        Token of clients, or a file with it; needed for any address except this machine's own.
    certificate, private_key
        PEM files for TLS; none if empty.
    max_clients
        Largest number of pages.
    origins
        Other origins, as ``https://example.org``, whose pages may follow the stream.

    """

    address: str = '127.0.0.1'
    port: int = 8765
    token: str = field(default='', repr=False)
    token_file: str = ''
    certificate: str = ''
    private_key: str = ''
    max_clients: int = 64
    origins: tuple[str, ...] = ()


class _Client:
    """A connected page: its credit, and the sent messages."""

    def __init__(self, socket: web.WebSocketResponse, transport: asyncio.Transport | None) -> None:
        self.socket, self.transport = socket, transport
        self.credit = 0
        self.period = 0.0
        self.timer: asyncio.TimerHandle | None = None
        self.next_due = 0.0
        self.sent = -1
        self.wake = asyncio.Event()
        self.hello = ''
        self.texts: deque[str] = deque(maxlen=_MOST_TEXTS)
        self.description = b''
        self.may_control = False
        self.wants_wind = self.is_solving = self.wants_nothing_else = False
        self.states, self.next_state, self.first = 0, 0.0, 0
        self.last_heard = time.monotonic()
        self.sending_since = math.inf

    def thinned(self, frame: bytes, now: float) -> bytes:
        """Return the part of a frame for a client that solves: wind, sometimes coordinates."""
        if self.wants_nothing_else:
            return part_of_frame(frame, 0, 0)
        if self.states < 2:  # two to begin with, for the rates
            self.states, self.next_state = self.states + 1, now + STATE_PERIOD
            return frame
        if now < self.next_state:
            return part_of_frame(frame, 0, 0)
        self.next_state = now + STATE_PERIOD
        part = part_of_frame(frame, self.first, MOST_IN_STATE)
        self.first += MOST_IN_STATE
        if self.first >= int.from_bytes(frame[FRAME_SIZE - 2 : FRAME_SIZE], 'little'):
            self.first = 0
        return part

    def say(self, content: Mapping[str, object]) -> None:
        """Queue a text; a client that does not read loses the oldest, but not its hello."""
        self.texts.append(json.dumps(content))
        self.wake.set()

    def ring(self) -> None:
        """Wake the task that sends."""
        self.timer = None
        self.wake.set()


class PageServer:
    """
    Server of the page and the state of one scene.

    Parameters
    ----------
    settings
        Address and access.
    panel
        Controls for viewers; none if None.
    status
        Function called twice a second on the server's thread for the status on the page.
    written
        Function called with ``glb`` or ``html`` on a separate thread for the tree as a file;
        raises a `TreeSwayError` to refuse.
    critical_winds
        Band of the critical wind of each tree by its name [m/s], by which viewers colour trees.

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
        written: Callable[[str], bytes] | None = None,
        critical_winds: Mapping[str, tuple[float, float]] | None = None,
    ) -> None:
        self.settings = settings
        self._token = settings.token or read_token(settings.token_file)
        require_token(settings.address, self._token)
        self._panel = panel or ControlPanel()
        self._status, self._written = status or dict, written
        self._critical_winds = critical_winds
        self._writing, self._waiting = asyncio.Lock(), 0
        self._guesses = Guesses()
        self._description = b''
        self._tables: Callable[[], bytes | None] = lambda: None
        self._gusts: Callable[[], Mapping[str, object] | None] = lambda: None
        self._frame: tuple[int, bytes] = (-1, b'')
        self._clients: set[_Client] = set()
        self._loop = asyncio.new_event_loop()
        self._started = threading.Event()
        self._failure: Exception | None = None
        self._ending = asyncio.Event()
        self._is_woken = False
        self.n_refused = 0
        """Number of refused requests and messages."""
        self._complained = -_COMPLAINT_PERIOD
        self._doors = Doorkeeper(4 * settings.max_clients, self._complain)
        self._thread = threading.Thread(target=self._run, name='page', daemon=True)
        self.port = settings.port

    def start(self) -> None:
        """
        Start serving.

        Raises
        ------
        TransportError
            The address cannot be bound, the TLS files cannot be used, or the server does not start
            in time.

        """
        self._thread.start()
        if not self._started.wait(_START_TIMEOUT):
            self._loop.call_soon_threadsafe(self._ending.set)
            what = f'the page is not served after {_START_TIMEOUT:g} s'
            cure = 'try again when this machine has less to do'
            raise TransportError(what, where=self.settings.address, cure=cure)
        if self._failure is not None:
            self._thread.join()
            where = f'{self.settings.address}:{self.settings.port}'
            what = f'the page cannot be served ({self._failure})'
            cure = 'choose a different port, or end the program that uses this one'
            raise TransportError(what, where=where, cure=cure) from self._failure

    def close(self) -> None:
        """Close every client and stop; may be called twice."""
        if self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._ending.set)
            self._thread.join(timeout=10.0)
        elif self._thread.ident is None:  # never started
            self._loop.close()

    def __enter__(self) -> PageServer:
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def url(self) -> str:
        """Address for a browser, without the token, which the page requests."""
        scheme = 'https' if self.settings.certificate else 'http'
        address = self.settings.address
        host = f'[{address}]' if ':' in address else address
        return f'{scheme}://{host}:{self.port}/'

    @property
    def viewers_token(self) -> str:
        """Token of links to look only; empty without a token."""
        return viewers_token(self._token)

    @property
    def n_clients(self) -> int:
        """Number of connected pages."""
        return len(self._clients)

    def describe(
        self,
        description: bytes,
        tables: Callable[[], bytes | None] = lambda: None,
        gusts: Callable[[], Mapping[str, object] | None] = lambda: None,
    ) -> None:
        """
        Send the description of the following frames to all pages, now and later.

        Clients that request only the wind get the result of `tables` to solve by; `gusts` returns
        the gusts in the scene, as `GustHistory.recent`.
        """
        self._description, self._tables, self._gusts = description, tables, gusts
        self._call(self._wake_all)

    def publish(self, frame: bytes) -> None:
        """Send the newest frame, from any thread, without waiting."""
        self._frame = (self._frame[0] + 1, frame)
        if not self._is_woken:
            self._is_woken = True
            self._call(self._wake_all)

    def announce(
        self, content: Mapping[str, object], values: Mapping[str, Value] | None = None
    ) -> None:
        """
        Send a message to all pages, from any thread.

        Parameters
        ----------
        content
            Content for JSON.
        values
            Changed values of controls.

        """
        if values is not None:
            self._panel.update(values)
            content = {**content, 'values': self._panel.values()}
        self._call(lambda: self._send_all(content))

    def _call(self, action: Callable[[], None]) -> None:
        try:
            self._loop.call_soon_threadsafe(action)
        except RuntimeError:  # the loop is closed
            self._is_woken = False

    def _wake_all(self) -> None:
        self._is_woken = False
        for client in self._clients:
            client.wake.set()

    def _run(self) -> None:
        asyncio.set_event_loop(self._loop)
        self._loop.set_exception_handler(lambda _, context: self._complain(context['message']))
        try:
            self._loop.run_until_complete(self._serve())
        except Exception as error:
            self._failure = error
            self._started.set()
        finally:
            for task in (left := asyncio.all_tasks(self._loop)):
                task.cancel()
            self._loop.run_until_complete(asyncio.gather(*left, return_exceptions=True))
            self._loop.close()

    async def _serve(self) -> None:
        app = web.Application(middlewares=[self._guard])
        app.router.add_get('/', self._index)
        app.router.add_get('/stream', self._stream)
        app.router.add_get('/healthz', self._health)
        app.router.add_get('/tree.{suffix:glb|html}', self._tree)
        app.router.add_static('/static/', _STATIC)
        app.on_response_prepare.append(_add_headers)
        logger = logging.Logger('page')
        logger.addFilter(self._complain_of)
        runner = web.AppRunner(
            app, access_log=None, keepalive_timeout=15.0, lingering_time=0.5, shutdown_timeout=1.0,
            logger=logger,
        )  # fmt: skip
        await runner.setup()
        assert runner.server is not None
        tls, address = _tls(self.settings), (self.settings.address, self.settings.port)
        family = socket.AF_INET6 if ':' in address[0] else socket.AF_INET
        with socket.create_server(address, family=family, backlog=256) as listener:
            listener.setblocking(False)
            self.port = listener.getsockname()[1]
            tasks = [
                self._loop.create_task(self._doors.admit(listener, runner.server, tls)),
                self._loop.create_task(self._send_status()),
            ]
            self._started.set()
            await self._ending.wait()
            for task in tasks:
                task.cancel()
        for client in tuple(self._clients):
            await client.socket.close(code=WSCloseCode.GOING_AWAY, message=b'server ends')
        await runner.cleanup()

    def _complain_of(self, record: logging.LogRecord) -> bool:
        """Log errors of the HTTP server in one sentence instead of a traceback."""
        error = record.exc_info[1] if record.exc_info else None
        self._complain(f'{record.getMessage()}: {error!a}')
        return False

    def _complain(self, what: str) -> None:
        """Count refusals, and log some of them."""
        self.n_refused += 1
        now = time.monotonic()
        if now - self._complained >= _COMPLAINT_PERIOD:
            self._complained = now
            _LOGGER.warning('%s (%d refused since the start)', what[:200], self.n_refused)

    @web.middleware
    async def _guard(self, request: web.Request, handler: Handler) -> web.StreamResponse:
        settings = self.settings
        given = self._given(request)
        now, address = time.monotonic(), request.remote or ''
        if given and self._token:
            wait = self._guesses.waiting_time(address, now)
            if wait > 0.0:
                slow, with_page = 'too many wrong tokens: wait a moment', request.path == '/'
                return self._refused(429, slow, with_page=with_page, retry_after=wait)
        access = access_of(given, self._token)
        if given and access is Access.NONE:
            self._guesses.note(address, given, now)
        self._doors.let_in(request.transport, is_known=access is not Access.NONE)
        if request.can_read_body:
            return self._refused(413, 'requests have no body')
        try:
            if len(request.path) > _LONGEST_PATH:
                raise ValueError('a path of no file')
            if request.path != '/healthz' and not request.path.startswith('/static/'):
                why = refusal(
                    request.headers, given, address=settings.address, token=self._token,
                    origins=settings.origins,
                )  # fmt: skip
                if why is not None:
                    return self._refused(403, why, with_page=request.path == '/')
        except ValueError as error:
            return self._refused(400, f'not understood: {error}')
        response: web.StreamResponse = await handler(request)
        if isinstance(response, web.FileResponse) and _takes_packed(request):
            response.enable_compression(web.ContentCoding.gzip)
        return response

    def _refused(
        self, status: int, why: str, *, with_page: bool = False, retry_after: float = 0.0
    ) -> web.Response:
        self._complain(f'a request was refused: {why!a}')
        text, kind = f'refused: {why}\n', 'text/plain'
        if with_page:
            text, kind = _refusal_page(why), 'text/html'
        answer = web.Response(status=status, text=text, content_type=kind)
        if retry_after:
            answer.headers['Retry-After'] = str(math.ceil(retry_after))
        answer.force_close()
        return answer

    @property
    def _cookie(self) -> str:
        """Name of the cookie with the token; cookies are common to all ports of a machine."""
        return f'tree_sway_{self.port}'

    def _given(self, request: web.Request) -> str:
        return given_token(request.headers, request.query, self._cookie)

    def _may_control(self, request: web.Request) -> bool:
        return access_of(self._given(request), self._token) is Access.CONTROL

    async def _index(self, request: web.Request) -> web.FileResponse:
        """Answer with the page; a cookie replaces the token in its address."""
        answer = web.FileResponse(_STATIC / 'index.html')
        if 'token' in request.query and self._token:
            has_control = self._may_control(request)
            value = cookie_token(self._token) if has_control else self.viewers_token
            is_secure = bool(self.settings.certificate)
            answer.set_cookie(
                self._cookie, value, httponly=True, samesite='Strict', secure=is_secure
            )
        return answer

    async def _health(self, _request: web.Request) -> web.Response:
        return web.json_response({'status': 'ok', 'described': bool(self._description)})

    async def _tree(self, request: web.Request) -> web.StreamResponse:
        """Answer with the tree as a file, one at a time."""
        if self._written is None:
            return self._refused(404, 'no files are written here: use tree-sway convert')
        if not is_own_page(request.headers):
            why = 'take the button of the page, or send the header X-Requested-With'
            return self._refused(403, why)
        if self._waiting > _MOST_WAITING:
            why = 'other files are being written: try again'
            return self._refused(503, why, retry_after=_START_TIMEOUT)
        self._waiting += 1
        try:
            async with self._writing:
                suffix = request.match_info['suffix']
                data = await asyncio.to_thread(self._written, suffix)
        except TreeSwayError as error:
            return self._refused(409, str(error))
        finally:
            self._waiting -= 1
        return web.Response(body=data, content_type='application/octet-stream')

    async def _stream(self, request: web.Request) -> web.StreamResponse:
        if len(self._clients) >= self.settings.max_clients:
            return self._refused(503, 'too many pages are connected')
        socket = web.WebSocketResponse(
            compress=False, max_msg_size=LARGEST_MESSAGE, heartbeat=20.0, timeout=2.0
        )
        await socket.prepare(request)
        client = _Client(socket, request.transport)
        client.may_control = self._may_control(request)
        client.hello = json.dumps({'hello': self._hello(client)})
        client.wake.set()
        self._clients.add(client)
        sender = self._loop.create_task(self._send(client))
        try:
            async for message in socket:
                client.last_heard = time.monotonic()
                try:
                    if message.type is not WSMsgType.TEXT:
                        raise ValueError('bytes instead of text')
                    self._take(client, message.data)
                except (ValueError, TypeError, RecursionError) as error:
                    self._complain(f'a message was refused: {error!a}')
                    await socket.close(
                        code=WSCloseCode.POLICY_VIOLATION, message=b'not understood'
                    )
        finally:
            self._clients.discard(client)
            sender.cancel()
            if client.timer is not None:
                client.timer.cancel()
        return socket

    def _hello(self, client: _Client) -> dict[str, object]:
        """Return what a client may change, and the token that its links have."""
        may = client.may_control
        return {
            'controls': self._panel.entries() if may else [],
            'can_pull': self._panel.can_pull and may,
            'address': self.settings.address,
            'viewers_token': self.viewers_token,
            'critical_winds': self._critical_winds,
        }

    def _take(self, client: _Client, text: str) -> None:
        """Handle a message of a client; raises a `ValueError` or `TypeError` for anything else."""
        message = json.loads(text)
        if not isinstance(message, dict):
            raise TypeError('not an object')
        if 'credit' in message:
            credit = client.credit + _number(message, 'credit', -MOST_CREDIT, math.inf)
            client.credit = int(max(0, min(credit, MOST_CREDIT)))
        if 'rate' in message:
            client.period = 1.0 / _number(message, 'rate', SLOWEST, FASTEST)
        if 'ping' in message:
            ping = _number(message, 'ping', -_LARGEST_PING, _LARGEST_PING)
            client.say({'pong': ping, 'time': time.time_ns() / 1e6})
        if message.get('wind') is True:
            client.wants_wind, client.description = True, b''
        client.wants_nothing_else |= message.get('wind') == 'only'
        for name, action in (('set', self._change), ('pull', self._pull)):
            if name in message and client.may_control:
                action(client, message[name])
            elif name in message:
                self._refuse(client, name, _MAY_LOOK)
        client.wake.set()

    def _pull(self, client: _Client, pull: object) -> None:
        """Pull for a client, which alone hears of a refusal, now or later."""

        def refused(why: str) -> None:
            self._call(lambda: self._refuse(client, 'pull', why))

        why = self._panel.pull(pull, refused)
        if why is not None:
            self._refuse(client, 'pull', why)

    def _change(self, client: _Client, change: object) -> None:
        change = change if isinstance(change, dict) else {}
        name = change.get('name')
        why = self._panel.set(name, change.get('value'))
        if why is not None:
            self._refuse(client, str(name)[:80], why)
        else:
            self._send_all({'values': self._panel.values()})

    def _refuse(self, client: _Client, name: str, why: str) -> None:
        self.n_refused += 1
        refused = {'name': name, 'reason': why[:400]}
        client.say({'refused': refused, 'values': self._panel.values()})

    def _send_all(self, content: Mapping[str, object]) -> None:
        for client in self._clients:
            client.say(content)

    async def _send(self, client: _Client) -> None:
        """Send new messages to a client, within its credit."""
        while not client.socket.closed:
            await client.wake.wait()
            client.wake.clear()
            # Checked twice a second: a timer and a task per frame would cost memory.
            client.sending_since = time.monotonic()
            try:
                await self._send_due(client)
            except (ConnectionError, RuntimeError):
                self._drop(client)
                return
            client.sending_since = math.inf

    async def _send_due(self, client: _Client) -> None:
        if client.hello:
            hello, client.hello = client.hello, ''
            await client.socket.send_str(hello)
        while client.texts:
            await client.socket.send_str(client.texts.popleft())
        if client.description is not self._description:
            client.description = self._description
            await client.socket.send_bytes(self._description)
            if client.wants_wind:
                await self._send_tables(client)
        number, frame = self._frame
        if client.credit <= 0 or number == client.sent or not frame or not client.description:
            return
        now = self._loop.time()
        # Half a period early is on time: the solver's frames and the client's rate have no common
        # grid.
        if now < client.next_due - 0.5 * client.period:
            if client.timer is None:
                client.timer = self._loop.call_at(client.next_due, client.ring)
            return
        client.next_due = max(client.next_due + client.period, now)
        client.credit -= 1
        client.sent = number
        if client.is_solving or client.wants_nothing_else:
            frame = client.thinned(frame, now)
        await client.socket.send_bytes(frame)

    async def _send_tables(self, client: _Client) -> None:
        """Send the tables, or a message that there are none; then every state is sent."""
        tables = await self._loop.run_in_executor(None, self._tables)
        client.is_solving, client.states = tables is not None, 0
        if tables is not None:
            await client.socket.send_bytes(tables)
            if gusts := self._gusts():
                await client.socket.send_str(json.dumps({'gusts': gusts}))
            return
        reason = 'this scene cannot be solved by clients: it is sent state by state'
        client.say({'refused': {'name': 'wind', 'reason': reason}})

    async def _send_status(self) -> None:
        while True:
            await asyncio.sleep(STATUS_PERIOD)
            now = time.monotonic()
            for client in tuple(self._clients):
                # It has neither sent nor read for too long.
                if now > min(client.last_heard + IDLE_TIME, client.sending_since + _SEND_TIMEOUT):
                    self._drop(client)
            if self._clients:
                self._send_all({'status': {**self._status(), 'clients': len(self._clients)}})

    def _drop(self, client: _Client) -> None:
        """Close a client that does not read, without waiting for it."""
        self._clients.discard(client)
        if client.transport is not None:
            client.transport.abort()


def _number(message: dict[str, Any], name: str, low: float, high: float) -> float:
    """Return an entry that is a number within a range, else raise."""
    value = message[name]
    if type(value) not in (int, float) or not low <= value <= high:
        raise ValueError(f'{name} out of {low:g} .. {high:g}')
    return float(min(value, _LARGEST_PING))


def _refusal_page(why: str) -> str:
    """Return the page of a refusal: why, and what to do."""
    page = (_STATIC / 'refused.html').read_text(encoding='utf-8')
    kind = 'token' if why == WRONG_TOKEN else 'other'
    return page.replace('{why}', escape(why)).replace('{kind}', kind)


def _takes_packed(request: web.Request) -> bool:
    """Whether a file may be packed; not where it may be missing, as aiohttp packs that as well."""
    headers = request.headers
    is_sent = request.method == 'GET' and not {'If-None-Match', 'If-Modified-Since'} & {*headers}
    return is_sent and 'gzip' in headers.get('Accept-Encoding', '')


async def _add_headers(_request: web.Request, response: web.StreamResponse) -> None:
    response.headers.update(_HEADERS)


def _tls(settings: PageSettings) -> ssl.SSLContext | None:
    if not settings.certificate:
        return None
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(settings.certificate, settings.private_key or None)
    return context
