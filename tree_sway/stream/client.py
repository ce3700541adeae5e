# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A client of the stream in Python, with a connection that is restored, and present poses.

An unreadable message is counted and reported, and the connection is made again: with an updated
server, or a different one on its port, an old picture must not look alive.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
import contextlib
import json
import random
import threading
import time
from urllib.parse import parse_qs, urlsplit, urlunsplit

import aiohttp
import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.checks import refuse_other_kind, within
from tree_sway.errors import FormatError, ParameterError, TransportError
from tree_sway.stream.by_wind import ByWind, STEP
from tree_sway.stream.check_description import Json
from tree_sway.stream.controls import Value
from tree_sway.stream.placing import Placer
from tree_sway.stream.playout import Moment, Playout
from tree_sway.stream.protocol import (
    decode_description,
    decode_frame,
    decode_tables,
    Description,
    Frame,
    LARGEST_DESCRIPTION,
    MAGIC,
    TABLES,
)

_MOST_CREDIT = 24
_LEAST_CREDIT = 8
"""Most and fewest frames that may be in transit."""
_GRANT_EVERY = 4
"""Frames that are requested at once, at least."""
_ON_THE_WAY = 200_000
"""Largest amount of data in transit in [bytes], so that a slow line has little old data."""

_LARGEST_TEXT = 2**20
"""Largest text message in [characters]."""
_SCHEMES = {'http': 'ws', 'ws': 'ws', 'https': 'wss', 'wss': 'wss'}
"""Scheme of the stream by that of the page's address."""

_OTHER_NAME = (62, 64)
"""Codes of OpenSSL for a certificate of a different host name or address."""

_DENIED = (401, 403)
"""HTTP status of a missing or wrong token."""

_ENDS = aiohttp.WSMsgType.CLOSE, aiohttp.WSMsgType.CLOSING, aiohttp.WSMsgType.CLOSED
_SHORTEST_WAIT = 0.5
_LONGEST_WAIT = 10.0
"""Waits before the connection is made again [s]."""
_PING_EVERY = 2.0
"""Time between questions for the round trip [s]."""
_SILENCE = 4.0
"""Time between heartbeats [s]; the connection ends if the server does not answer one."""


class StreamClient:
    """
    Receiver of a tree or a scene from ``tree-sway show`` or the node ``viewer``.

    It has its own thread. A lost connection is made again, after increasing waits.

    Parameters
    ----------
    url
        Address of the page or of its stream, with its token if it has one:
        ``http://127.0.0.1:8765/``.
    rate
        Requested frames per second [Hz].
    delay
        Playout delay [s]; by the lateness of the line, up to 0.15 s, if None.
    by_wind
        Whether to request only the wind, 28 bytes per frame, and solve the scene here (`ByWind`);
        request 60 frames per second then.
    wind_only
        Whether to request nothing else than the wind, for `on_frame`; then there are no poses.
    on_frame
        Function called on the client's thread with every frame and its arrival [s] by the own
        clock.
    on_message
        Function called on that thread with the bytes of every description and frame that is sound,
        to hand them on.

    Raises
    ------
    ParameterError
        A text that is not an address of a page, or a rate outside of 0.1 to 1000 Hz.

    Examples
    --------
    >>> with StreamClient("http://127.0.0.1:8765/") as client:
    ...     client.wait()
    ...     poses = client.poses()

    """

    def __init__(
        self,
        url: str,
        *,
        rate: float = 30.0,
        delay: float | None = None,
        by_wind: bool = False,
        wind_only: bool = False,
        on_frame: Callable[[Frame, float], None] | None = None,
        on_message: Callable[[bytes], None] | None = None,
    ) -> None:
        refuse_other_kind('url', url, str, "give 'http://there:8765/'")
        try:
            parts = urlsplit(url)
        except ValueError as error:
            raise ParameterError(f'not an address ({error})', where='url') from None
        if parts.scheme not in _SCHEMES or not parts.hostname:
            raise ParameterError(
                f"'{url.partition('?')[0]}' is not the address of a page",
                where='url',
                cure='give http:// or https:// before the host, as http://there:8765/',
            )
        within('rate', rate, 0.1, 1000.0, 'Hz')
        if delay is not None:
            within('delay', delay, 0.0, 60.0, 's')
        path = parts.path.rstrip('/').removesuffix('/stream') + '/stream'
        self.url = urlunsplit((_SCHEMES[parts.scheme], parts.netloc, path, '', ''))
        """Address of the stream; its token is sent separately, so that no message shows it."""
        token = parse_qs(parts.query).get('token')
        self._headers = {'Authorization': f'Bearer {token[0]}'} if token else {}
        self.playout = Playout(delay)
        self.state = 'connecting'
        """State of the connection: connecting, open or lost."""
        self.problem = ''
        """Why the connection was lost, or a change was refused; empty if neither happened."""
        self.received = self.unreadable = 0
        """
        Numbers of frames, and of unreadable messages; after one of these the connection is made
        again.
        """
        self.round_trip = float('nan')
        """Time to the server and back [s]."""
        self.status: dict[str, object] = {}
        """The newest status of the server."""
        self.solver: ByWind | None = None
        """Solver of the scene by its wind; None where states are received."""
        self._rate = rate
        self._on_frame = on_frame or _nothing
        self._on_message = on_message or _nothing
        self._wants_wind: bool | str = 'only' if wind_only else by_wind
        self._placer: Placer | None = None
        self._more = threading.Condition()
        """Guards placer, playout and counts; a thread that has its lock may take it again."""
        self._loop: asyncio.AbstractEventLoop | None = None
        self._thread: threading.Thread | None = None
        self._refusal: TransportError | None = None
        self._socket: aiohttp.ClientWebSocketResponse | None = None
        self._awaited = 0
        self._credit = _MOST_CREDIT

    def __enter__(self) -> StreamClient:
        if self._thread is not None:
            raise RuntimeError('a StreamClient is entered once; make another one')
        self._loop = asyncio.new_event_loop()
        self._task = self._loop.create_task(self._keep_connected())
        self._thread = threading.Thread(target=self._run, name='stream', daemon=True)
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the connection and end the thread; may be called twice."""
        if self._loop is not None and self._thread is not None and self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._task.cancel)
            self._thread.join(timeout=5.0)

    def wait(self, seconds: float = 30.0, *, frames: int = 1) -> None:
        """
        Wait for a total number of frames.

        Raises
        ------
        TransportError
            Fewer frames within a time [s]; at once if the server refuses the token, or its
            certificate is not trusted.

        """
        if not self.has_frames(seconds, frames=frames):
            what = f'{self.received} frames within {seconds:g} s ({self.problem})'
            cure = 'start tree-sway show, or check the address'
            raise TransportError(what, where=self.url, cure=cure)

    def has_frames(self, seconds: float, *, frames: int = 1) -> bool:
        """
        Return whether a total number of frames is there, or comes within a time [s].

        Raises
        ------
        TransportError
            The server refuses the token, its certificate is not trusted, or the client was not
            entered.

        """
        if self._thread is None:
            cure = 'with StreamClient(...) as client'
            raise TransportError('not connected', where=self.url, cure=cure)
        with self._more:
            self._more.wait_for(lambda: self.received >= frames or self._refusal, seconds)
            if self.received < frames and self._refusal is not None:
                raise self._refusal
            return self.received >= frames

    def set(self, name: str, value: Value) -> None:  # noqa: A003
        """
        Change a control of the server; a refusal by the server is in `problem`.

        Raises
        ------
        TransportError
            No connection at present: nothing is changed.

        """
        if self._loop is None or self.state != 'open':
            raise TransportError(
                f"'{name}' is not changed: the connection is {self.state}",
                where=self.url,
                cure='wait() until frames come',
            )
        self._loop.call_soon_threadsafe(self._say, {'set': {'name': name, 'value': value}})

    @property
    def description(self) -> Description | None:
        """Description that the server sent; None before that."""
        placer = self._placer
        return None if placer is None else placer.description

    def sample(self, now: float | None = None) -> Moment | None:
        """State to show at a time [s] of this machine's clock, now if None; None before any."""
        with self._more:
            return self.playout.sample(time.time() if now is None else now)

    def poses(self, now: float | None = None) -> Floats | None:
        """
        Poses of all segments at a time, (n, 7): x y z in [m] and the quaternion's x y z w.

        None before the first state.
        """
        with self._more:  # a state is placed by its own description
            moment = self.sample(now)
            placer = self._placer
        if moment is None or placer is None:
            return None
        return placer.place(moment.coordinates)

    def _run(self) -> None:
        assert self._loop is not None
        with contextlib.closing(self._loop), contextlib.suppress(asyncio.CancelledError):
            self._loop.run_until_complete(self._task)
        self.state = 'lost'

    async def _keep_connected(self) -> None:
        """Connect, follow, and connect again after increasing waits, until cancelled."""
        wait = _SHORTEST_WAIT
        async with aiohttp.ClientSession(headers=self._headers) as session:
            while True:
                self.state = 'connecting'
                received = self.received
                try:
                    async with session.ws_connect(
                        self.url, max_msg_size=LARGEST_DESCRIPTION, heartbeat=_SILENCE
                    ) as socket:
                        self._socket = socket
                        self._awaited = 0
                        self.state = 'open'
                        self._refusal = None
                        await self._follow(socket)
                except Exception as error:
                    self.problem = _problem_of(error, self.url)
                    with self._more:
                        self._refusal = _refusal_of(error, self.url)
                        self._more.notify_all()
                self._socket = None
                self.state = 'lost'
                if self.received > received:
                    wait = _SHORTEST_WAIT
                # Clients that lose the same server do not reconnect at the same time.
                await asyncio.sleep(wait * random.uniform(0.75, 1.25))
                wait = min(2.0 * wait, _LONGEST_WAIT)

    async def _follow(self, socket: aiohttp.ClientWebSocketResponse) -> None:
        """Receive until the connection ends, is silent or sends an unreadable message."""
        self._say({'rate': self._rate, 'ping': time.monotonic(), 'wind': self._wants_wind})
        pinged = time.monotonic()
        while True:
            message = await socket.receive()
            if message.type in _ENDS:
                raise TransportError(f'the server closed the line ({socket.close_code})')
            is_broken = message.type is aiohttp.WSMsgType.ERROR
            if is_broken and not isinstance(message.data, aiohttp.WebSocketError):
                raise TransportError(f'the line broke ({message.data})')
            try:
                self._take(message)
            except Exception as error:
                self.unreadable += 1
                what = f'a message that cannot be read ({type(error).__name__}: {error})'
                raise FormatError(what[:400], where='stream') from error
            if time.monotonic() - pinged > _PING_EVERY:
                pinged = time.monotonic()
                self._say({'ping': pinged})

    def _take(self, message: aiohttp.WSMessage) -> None:
        if message.type is aiohttp.WSMsgType.TEXT:
            self._hear(message.data)
        elif message.type is not aiohttp.WSMsgType.BINARY:
            raise FormatError(str(message.data))
        elif message.data[:4] == MAGIC:
            self._describe(decode_description(message.data))
            self._on_message(message.data)
        elif message.data[:4] == TABLES:
            description = self.description
            if description is not None:
                scene = decode_tables(message.data).scene(description, STEP)
                self.solver = ByWind(description, scene)
        else:
            self._awaited -= 1
            self._ask()
            self._push(decode_frame(message.data), time.time())
            self._on_message(message.data)

    def _ask(self) -> None:
        """Request as many frames as may be in transit."""
        more = self._credit - self._awaited
        if more >= _GRANT_EVERY:
            self._awaited += more
            self._say({'credit': more})

    def _say(self, message: Json) -> None:
        if self._loop is not None and self._socket is not None and not self._socket.closed:
            task = self._loop.create_task(self._socket.send_json(message))
            task.add_done_callback(lambda done: done.cancelled() or done.exception())

    def _hear(self, text: str) -> None:
        if len(text) > _LARGEST_TEXT:
            raise FormatError(f'a text of {len(text)} characters')
        message: Json = json.loads(text)
        if not isinstance(message, dict):
            raise FormatError(f'{text[:40]!r} where an object belongs')
        if 'pong' in message:
            self.round_trip = time.monotonic() - float(message['pong'])
        if 'gusts' in message and self.solver is not None:
            self.solver.go_on(message['gusts'])
        if 'refused' in message:
            self.problem = str(message['refused']['reason'])
        self.status = dict(message.get('status', self.status))

    def _describe(self, description: Description) -> None:
        placer = Placer(description)
        self.solver = None
        with self._more:
            self._placer = placer
            self.playout.clear()
        fitting = _ON_THE_WAY // description.frame_size
        self._credit = max(_LEAST_CREDIT, min(_MOST_CREDIT, fitting))
        self._ask()

    def _push(self, frame: Frame, arrival: float) -> None:
        description = self.description
        if description is None or frame.identity != description.short_identity:
            return
        solver = self.solver
        values = solver.take(frame) if solver else description.coordinates(frame)
        is_whole = values is not None and len(values) == len(description.scale)
        with self._more:
            if values is not None and is_whole:
                values = values if solver else np.concatenate([values, frame.beyond])
                moment = Moment(1e-9 * frame.stamp, values, frame.wind, frame.flags)
                self.playout.push(moment, arrival)
            self.received += is_whole or self._wants_wind == 'only'
            self._more.notify_all()
        try:
            self._on_frame(frame, arrival)
        except Exception as error:
            self.problem = f'on_frame: {type(error).__name__}: {error}'


def _nothing(*_: object) -> None:
    """Do nothing with what is received."""


def _problem_of(error: Exception, url: str) -> str:
    """Return what is wrong with a connection, in words."""
    problem = str(error) or type(error).__name__
    # A server with a certificate hangs up on plain HTTP.
    if isinstance(error, aiohttp.ServerDisconnectedError) and url.startswith('ws:'):
        return f'{problem}; if it has a certificate, give https://'
    return problem


def _refusal_of(error: Exception, url: str) -> TransportError | None:
    """Return the error for a caller who waits, with its cure; None if waiting may help."""
    if isinstance(error, aiohttp.ClientConnectorCertificateError):
        reason = error.certificate_error
        why = getattr(reason, 'verify_message', '') or str(reason)
        if getattr(reason, 'verify_code', 0) in _OTHER_NAME:
            cure = 'use a host name that the certificate contains'
        else:
            cure = "set SSL_CERT_FILE to the server's certificate (PEM) if you trust it"
        what = f'its certificate is refused ({why})'
    elif isinstance(error, aiohttp.ClientConnectorSSLError):
        what = f'it does not speak TLS ({error.strerror or error})'
        cure = 'give http://'
    elif isinstance(error, aiohttp.WSServerHandshakeError) and error.status in _DENIED:
        what = f'it refuses the connection (HTTP {error.status})'
        cure = 'give the token of its page: --token-file, or ?token=... in its address'
    else:
        return None
    return TransportError(what, where=url, cure=cure)
