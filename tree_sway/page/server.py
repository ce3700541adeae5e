# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The page's server: files, a description, and the newest frame to clients that request one.

It has its own thread and loop. The solver's thread publishes a frame by storing it and waking the
loop, and never waits. `guard` decides which requests are answered, `page_client` what a connected
page is sent.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
import errno
import json
import logging
import socket
import threading
import time

from aiohttp import web, WSCloseCode, WSMsgType

from tree_sway.doorkeeper import Doorkeeper
from tree_sway.errors import TransportError, TreeSwayError
from tree_sway.live import LiveFilm, PageFilm
from tree_sway.page.access import is_own_page
from tree_sway.page.guard import add_headers, Guard, STATIC
from tree_sway.page.page_client import PageClient
from tree_sway.page.page_settings import PageSettings, USUAL_PORT
from tree_sway.page.published import Gusts, nothing, Published, Tables
from tree_sway.page.refusals import Refusals
from tree_sway.stream import ControlPanel, Json, Value

LARGEST_MESSAGE = 4096
"""Longest message of a client in [bytes]."""

_STATUS_PERIOD = 0.5
"""Interval of the status, and of the search for clients that do not read [s]."""

_HEARTBEAT = 20.0
"""Interval of the pings that a page answers [s]; one that does not is gone."""

_CLOSING_TIME = 2.0
"""Time in which a page that is sent away may answer before its socket is closed [s]."""
_START_TIMEOUT = 10.0
_BACKLOG = 256
_MOST_WAITING = 3
"""Requests for the tree as a file that wait for the one that is written."""

_OTHER_PORT = 'choose a different port, or end the program that uses this one'
_CURES = {
    errno.EADDRNOTAVAIL: "give an address of this machine's own, or 0.0.0.0 for all of them",
    errno.EACCES: 'choose a port above 1023',
}
_MAY_LOOK = 'this link is to look only: ask for one with control'
_LONGEST_NAME = 80
_LONGEST_REASON = 400


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
    film
        Camera whose picture is shown to those alone who may control, or that is one of theirs.

    Raises
    ------
    TransportError
        Files that are no certificate and key.

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
        status: Callable[[], Json] | None = None,
        written: Callable[[str], bytes] | None = None,
        critical_winds: Mapping[str, tuple[float, float]] | None = None,
        film: LiveFilm | PageFilm | None = None,
    ) -> None:
        self.settings = settings
        self._tls = settings.tls()
        self.port = USUAL_PORT if settings.port is None else settings.port
        """Port that the server is bound to."""
        self._panel = panel or ControlPanel()
        self._status = status or dict
        self._written = written
        self._critical_winds = critical_winds
        self._film = film
        self._of_page = film if isinstance(film, PageFilm) else None
        self._published = Published()
        self._clients: set[PageClient] = set()
        self._refusals = Refusals()
        self._doors = Doorkeeper(4 * settings.max_clients, self._refusals.note)
        self._guard = Guard(settings, self._doors, self._refusals)
        # One tree is written to a file at a time; some requests may wait for their turn.
        self._writing = asyncio.Lock()
        self._n_waiting = 0
        self._loop = asyncio.new_event_loop()
        self._started = threading.Event()
        self._ending = asyncio.Event()
        self._failure: Exception | None = None
        self._is_woken = False
        self._thread = threading.Thread(target=self._run, name='page', daemon=True)

    def start(self) -> None:
        """
        Start serving.

        Raises
        ------
        TransportError
            The address cannot be bound, or the server does not start in time.

        """
        self._thread.start()
        if not self._started.wait(_START_TIMEOUT):
            self._call(self._ending.set)
            what = f'the page is not served after {_START_TIMEOUT:g} s'
            cure = 'try again when this machine has less to do'
            raise TransportError(what, where=self.settings.address, cure=cure)
        if self._failure is not None:
            self._thread.join()
            where = f'{self.settings.address}:{self.port}'
            what = f'the page cannot be served ({self._failure})'
            cure = _CURES.get(getattr(self._failure, 'errno', 0) or 0, _OTHER_PORT)
            raise TransportError(what, where=where, cure=cure) from self._failure

    def close(self) -> None:
        """Close every client and stop; may be called twice."""
        if self._thread.is_alive():
            self._call(self._ending.set)
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
        return self.settings.url(self.port)

    @property
    def viewers_token(self) -> str:
        """Token of links to look only; empty without a token."""
        return self._guard.viewers_token

    @property
    def n_clients(self) -> int:
        """Number of connected pages."""
        return len(self._clients)

    @property
    def n_missed(self) -> int:
        """Number of frames that the connected pages asked for and were not sent."""
        return sum(client.missed for client in tuple(self._clients))

    @property
    def n_refused(self) -> int:
        """Number of refused requests and messages."""
        return self._refusals.count

    def describe(
        self,
        description: bytes,
        tables: Tables = nothing,
        gusts: Gusts = nothing,
    ) -> None:
        """
        Send the description of the following frames to all pages, now and later.

        Clients that request only the wind get the result of `tables` to solve by; `gusts` returns
        the gusts in the scene, as `GustHistory.recent`.
        """
        published = self._published
        published.description = description
        published.tables = tables
        published.gusts = gusts
        self._call(self._wake_all)

    def publish(self, frame: bytes) -> None:
        """Send the newest frame, from any thread, without waiting."""
        number, _ = self._published.newest
        self._published.newest = number + 1, frame
        if not self._is_woken:
            self._is_woken = True
            self._call(self._wake_all)

    def announce(self, content: Json, values: Mapping[str, Value] | None = None) -> None:
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
        self._loop.set_exception_handler(
            lambda _, context: self._refusals.note(context['message'])
        )
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
        runner = self._runner()
        await runner.setup()
        assert runner.server is not None
        with self._listener() as listener:
            listener.setblocking(False)
            self.port = self._guard.port = listener.getsockname()[1]
            tasks = [
                self._loop.create_task(self._doors.admit(listener, runner.server, self._tls)),
                self._loop.create_task(self._send_status()),
            ]
            self._started.set()
            await self._ending.wait()
            for task in tasks:
                task.cancel()
        for client in tuple(self._clients):
            await client.socket.close(code=WSCloseCode.GOING_AWAY, message=b'server ends')
        await runner.cleanup()

    def _listener(self) -> socket.socket:
        """Bind the port; where any will do and the usual one is in use, a free one."""
        host = self.settings.address
        family = socket.AF_INET6 if ':' in host else socket.AF_INET
        try:
            return socket.create_server((host, self.port), family=family, backlog=_BACKLOG)
        except OSError as error:
            if self.settings.port is not None or error.errno != errno.EADDRINUSE:
                raise
        return socket.create_server((host, 0), family=family, backlog=_BACKLOG)

    def _runner(self) -> web.AppRunner:
        """Return the HTTP server, with an answer to each kind of request."""
        app = web.Application(middlewares=[self._guard.check])
        app.router.add_get('/', self._index)
        app.router.add_get('/stream', self._stream)
        app.router.add_get('/healthz', self._health)
        app.router.add_get('/tree.{suffix:glb|html}', self._tree)
        app.router.add_get('/camera.jpg', self._camera)
        app.router.add_static('/static/', STATIC)
        app.on_response_prepare.append(add_headers)
        logger = logging.Logger('page')
        logger.addFilter(self._refusals.note_record)
        return web.AppRunner(
            app, access_log=None, keepalive_timeout=15.0, lingering_time=0.5, shutdown_timeout=1.0,
            logger=logger,
        )  # fmt: skip

    async def _index(self, request: web.Request) -> web.FileResponse:
        """Answer with the page; a cookie replaces the token in its address."""
        answer = web.FileResponse(STATIC / 'index.html')
        self._guard.hide_token(request, answer)
        return answer

    async def _health(self, _request: web.Request) -> web.Response:
        is_described = bool(self._published.description)
        return web.json_response({'status': 'ok', 'described': is_described})

    async def _tree(self, request: web.Request) -> web.StreamResponse:
        """Answer with the tree as a file, one at a time."""
        refused = self._guard.refused
        if self._written is None:
            return refused(404, 'no files are written here: use tree-sway convert')
        if not is_own_page(request.headers):
            return refused(403, 'take the button of the page, or send the header X-Requested-With')
        if self._n_waiting > _MOST_WAITING:
            why = 'other files are being written: try again'
            return refused(503, why, retry_after=_START_TIMEOUT)
        self._n_waiting += 1
        try:
            async with self._writing:
                data = await asyncio.to_thread(self._written, request.match_info['suffix'])
        except TreeSwayError as error:
            return refused(409, str(error))
        finally:
            self._n_waiting -= 1
        return web.Response(body=data, content_type='application/octet-stream')

    async def _camera(self, request: web.Request) -> web.StreamResponse:
        """Answer with what the camera sees, for its check and not for whoever looks on."""
        refused = self._guard.refused
        if self._film is None:
            return refused(404, 'no camera looks at this tree')
        if not (self._guard.may_control(request) and is_own_page(request.headers)):
            return refused(403, _MAY_LOOK)
        data = await asyncio.to_thread(self._film.picture)
        return web.Response(status=200 if data else 204, body=data, content_type='image/jpeg')

    async def _stream(self, request: web.Request) -> web.StreamResponse:
        """Serve a page from its first message to its last."""
        if len(self._clients) >= self.settings.max_clients:
            return self._guard.refused(503, 'too many pages are connected')
        socket = web.WebSocketResponse(
            compress=False,
            max_msg_size=LARGEST_MESSAGE,
            heartbeat=_HEARTBEAT,
            timeout=_CLOSING_TIME,
        )
        await socket.prepare(request)
        may_control = self._guard.may_control(request)
        client = PageClient(socket, request.transport, may_control=may_control)
        client.hello = self._hello(may_control=may_control)
        client.wake.set()
        self._clients.add(client)
        sender = self._loop.create_task(self._send(client))
        try:
            async for message in socket:
                client.last_heard = time.monotonic()
                if isinstance(message.data, asyncio.TimeoutError):
                    break  # it answered no ping: it is gone, and sent nothing wrong
                try:
                    if message.type is not WSMsgType.TEXT:
                        raise ValueError('bytes instead of text')
                    self._take(client, message.data)
                except (ValueError, TypeError, RecursionError) as error:
                    self._refusals.note(f'a message was refused: {error!a}')
                    await socket.close(
                        code=WSCloseCode.POLICY_VIOLATION, message=b'not understood'
                    )
        finally:
            self._clients.discard(client)
            if self._of_page is not None:
                self._of_page.leave(client)
            sender.cancel()
            client.stop_timer()
        return socket

    def _hello(self, *, may_control: bool) -> str:
        """Return the first text: what a client may change, and the token that its links have."""
        hello = {
            'controls': self._panel.entries() if may_control else [],
            'can_pull': self._panel.can_pull and may_control,
            'address': self.settings.address,
            'viewers_token': self.viewers_token,
            'critical_winds': self._critical_winds,
            'has_camera': self._film is not None and may_control,
            'can_film': self._of_page is not None and may_control,
        }
        return json.dumps({'hello': hello})

    def _take(self, client: PageClient, text: str) -> None:
        """Handle a message of a client; raises a `ValueError` or `TypeError` for anything else."""
        message = json.loads(text)
        if not isinstance(message, dict):
            raise TypeError('not an object')
        client.take(message)
        takers = ('set', self._change), ('pull', self._pull), ('film', self._follow_film)
        for name, action in takers:
            if name in message:
                why = action(client, message[name]) if client.may_control else _MAY_LOOK
                self._refuse(client, name, why)

    def _pull(self, client: PageClient, pull: object) -> str | None:
        """Pull for a client, which alone hears of a refusal, now or later."""

        def refused(why: str) -> None:
            self._call(lambda: self._refuse(client, 'pull', why))

        return self._panel.pull(pull, refused)

    def _follow_film(self, client: PageClient, seen: object) -> str | None:
        """Take what a page films; return why not."""
        if self._of_page is None:
            return 'no camera of a page is wanted: start with --motion camera:page'
        return self._of_page.take(client, seen, lambda told: self._call(lambda: client.say(told)))

    def _change(self, client: PageClient, change: object) -> None:
        change = change if isinstance(change, dict) else {}
        name = change.get('name')
        why = self._panel.set(name, change.get('value'))
        self._refuse(client, str(name)[:_LONGEST_NAME], why)
        if why is None:
            self._send_all({'values': self._panel.values()})

    def _refuse(self, client: PageClient, name: str, why: str | None) -> None:
        """Tell a client why something is refused, if it is."""
        if why is None:
            return
        self._refusals.count += 1
        client.say({'refused': _refusal(name, why), 'values': self._panel.values()})

    def _send_all(self, content: Json) -> None:
        for client in self._clients:
            client.say(content)

    async def _send(self, client: PageClient) -> None:
        """Send to a client until its connection ends."""
        try:
            await client.send(self._published)
        except (ConnectionError, RuntimeError):
            self._drop(client)

    async def _send_status(self) -> None:
        """Send the status at its interval; pages are told once why there is none."""
        told = ''
        while True:
            await asyncio.sleep(_STATUS_PERIOD)
            now = time.monotonic()
            for client in tuple(self._clients):
                if client.is_stuck(now):
                    self._drop(client)
            why = ''
            try:
                if self._clients:
                    status = {**self._status(), 'clients': len(self._clients)}
                    for client in self._clients:
                        client.say({'status': {**status, 'missed': client.missed}})
            except Exception as error:
                why = f'no status ({type(error).__name__}: {error})'
                if why != told:
                    self._refusals.note(why)
                    self._send_all({'refused': _refusal('status', why)})
            told = why

    def _drop(self, client: PageClient) -> None:
        """Close a client that does not read, without waiting for it."""
        self._clients.discard(client)
        client.drop()


def _refusal(name: str, why: str) -> dict[str, str]:
    return {'name': name, 'reason': why[:_LONGEST_REASON]}
