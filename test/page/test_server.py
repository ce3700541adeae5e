# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The page's server as clients meet it: frames by credit, controls, and those who mean no good."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator
import gc
import json
import socket
import threading
import time
import tracemalloc
from types import SimpleNamespace
from typing import Any

import pytest

aiohttp = pytest.importorskip('aiohttp', reason='aiohttp is not installed')

from tree_sway import doorkeeper  # noqa: E402
from tree_sway.doorkeeper import is_loopback  # noqa: E402
from tree_sway.errors import ParameterError, TransportError  # noqa: E402
from tree_sway.page import server as server_module  # noqa: E402
from tree_sway.page.access import refusal, require_token  # noqa: E402
from tree_sway.page.guard import STATIC  # noqa: E402
from tree_sway.page.page_client import PageClient  # noqa: E402
from tree_sway.page.page_settings import PageSettings  # noqa: E402
from tree_sway.page.published import Published  # noqa: E402
from tree_sway.page.server import PageServer  # noqa: E402
from tree_sway.stream.controls import Control, ControlPanel  # noqa: E402

DEADLINE = 60.0
DESCRIPTION = b'TSWD' + bytes(96)


def until(holds: Callable[[], bool]) -> None:
    """Wait for a condition, no longer than the deadline."""
    end = time.monotonic() + DEADLINE
    while not holds():
        assert time.monotonic() < end, 'it did not come to pass'
        time.sleep(0.005)


class Viewer:
    """A client of the stream that says only what a test has it say."""

    def __init__(self, session: Any, ws: Any) -> None:
        self.session, self.ws = session, ws

    async def say(self, **message: Any) -> None:
        await self.ws.send_str(json.dumps(message))

    async def binary(self) -> bytes:
        while True:
            message = await asyncio.wait_for(self.ws.receive(), DEADLINE)
            assert message.type in (aiohttp.WSMsgType.TEXT, aiohttp.WSMsgType.BINARY), message
            if message.type is aiohttp.WSMsgType.BINARY:
                return bytes(message.data)

    async def text(self, key: str) -> Any:
        while True:
            message = await asyncio.wait_for(self.ws.receive(), DEADLINE)
            assert message.type in (aiohttp.WSMsgType.TEXT, aiohttp.WSMsgType.BINARY), message
            if message.type is aiohttp.WSMsgType.TEXT and key in json.loads(message.data):
                return json.loads(message.data)[key]


def run(
    server: PageServer, script: Callable[[Viewer], Any], *, unpacks: bool = True, **options: Any
) -> Any:
    """Run a script with a connected viewer."""

    async def whole() -> Any:
        async with aiohttp.ClientSession(auto_decompress=unpacks) as session:
            async with session.ws_connect(f'{server.url}stream', **options) as ws:
                return await script(Viewer(session, ws))

    return asyncio.run(whole())


@pytest.fixture
def server() -> Iterator[PageServer]:
    with PageServer(PageSettings(port=0)) as server:
        server.describe(DESCRIPTION)
        yield server


def test_a_viewer_gets_the_description_and_then_a_frame_per_credit(server: PageServer) -> None:
    async def script(viewer: Viewer) -> None:
        assert await viewer.binary() == DESCRIPTION
        server.publish(b'F1')
        await viewer.say(credit=1)
        assert await viewer.binary() == b'F1'
        for number in range(2, 9):
            server.publish(f'F{number}'.encode())
        await viewer.say(ping=1)
        await viewer.text('pong')  # nothing came before it: no credit was left
        await viewer.say(credit=5)
        assert await viewer.binary() == b'F8'  # the newest, not those between
        server.publish(b'F9')
        assert await viewer.binary() == b'F9'

    run(server, script)


def test_a_status_that_fails_is_told_and_comes_again(caplog: pytest.LogCaptureFixture) -> None:
    n_asked = 0

    def status() -> dict[str, object]:
        nonlocal n_asked
        n_asked += 1
        if n_asked < 3:
            raise ZeroDivisionError('of a sensor')
        return {'model': complex(1.0) if n_asked == 3 else 'full'}  # no JSON

    async def script(viewer: Viewer) -> None:
        for why in ('ZeroDivisionError: of a sensor', 'TypeError: '):
            refused = await viewer.text('refused')
            assert refused['name'] == 'status'
            assert why in refused['reason']
        assert (await viewer.text('status'))['model'] == 'full'

    with PageServer(PageSettings(port=0), status=status) as server:
        run(server, script)
        assert server.n_refused == 2
    assert 'no status (ZeroDivisionError: of a sensor)' in caplog.text


def test_a_slow_viewer_sees_new_frames_and_holds_up_nobody(server: PageServer) -> None:
    stop = threading.Event()

    def solve() -> None:
        while not stop.wait(1.0 / 120.0):
            server.publish(f'{time.monotonic():.6f}'.encode())

    solver = threading.Thread(target=solve)
    solver.start()

    async def script(viewer: Viewer) -> list[float]:
        await viewer.binary()
        await viewer.say(credit=2)
        ages = []
        for _ in range(8):
            await asyncio.sleep(0.1)
            ages.append(time.monotonic() - float(await viewer.binary()))
            await viewer.say(credit=1)
        return ages

    try:
        ages = run(server, script)
    finally:
        stop.set()
        solver.join()
    assert max(ages[2:]) < 0.5


def test_a_new_description_reaches_who_is_there(server: PageServer) -> None:
    async def script(viewer: Viewer) -> None:
        await viewer.binary()
        server.describe(b'TSWD other')
        assert await viewer.binary() == b'TSWD other'

    run(server, script)


def panel(applied: list[Any]) -> ControlPanel:
    """Make a slider, a choice and a button."""

    def apply(name: str, value: Any) -> None:
        if value == 'full':
            raise ParameterError("leaves on model 'full'", cure="use 'branch'")
        applied.append((name, value))

    return ControlPanel(
        (
            Control('wind', 'Wind', 6.0, unit='m/s', minimum=0.0, maximum=40.0),
            Control('model', 'Model', 'branch', choices=('branch', 'full')),
            Control('reset', 'Reset', None, is_action=True),
        ),
        apply,
    )


def test_what_is_changed_is_applied_or_refused_with_the_reason() -> None:
    applied: list[Any] = []

    async def script(viewer: Viewer) -> None:
        hello = await viewer.text('hello')
        assert [control['name'] for control in hello['controls']] == ['wind', 'model', 'reset']
        await viewer.say(set={'name': 'wind', 'value': 12})
        assert (await viewer.text('values'))['wind'] == 12.0
        for name, value, reason in (
            ('wind', 41.0, 'out of range; give 0 .. 40 [m/s]'),
            ('wind', 'strong', 'is not a number'),
            ('wind', float('nan'), 'out of range'),
            ('model', 'best', 'not among its choices; give branch | full'),
            ('model', 'full', "leaves on model 'full'; use 'branch'"),
            ('gravity', 0.0, "no control 'gravity'"),
            (None, None, 'no control'),
        ):
            await viewer.say(set={'name': name, 'value': value})
            assert reason in (await viewer.text('refused'))['reason']
        await viewer.say(set={'name': 'reset'})
        await viewer.text('values')

    with PageServer(PageSettings(port=0), panel(applied)) as server:
        run(server, script)
    assert applied == [('wind', 12.0), ('reset', None)]


def test_without_a_panel_nothing_can_be_changed(server: PageServer) -> None:
    async def script(viewer: Viewer) -> None:
        await viewer.say(set={'name': 'wind', 'value': 1.0})
        assert "no control 'wind'" in (await viewer.text('refused'))['reason']

    run(server, script)


def test_other_pages_and_names_are_refused(server: PageServer) -> None:
    for headers in ({'Origin': 'http://evil.example'}, {'Host': 'evil.example'}):
        with pytest.raises(aiohttp.WSServerHandshakeError, match='403'):
            run(server, lambda viewer: viewer.binary(), headers=headers)
    origin = server.url.rstrip('/')
    assert run(server, lambda viewer: viewer.binary(), headers={'Origin': origin}) == DESCRIPTION


def test_a_token_is_asked_for_elsewhere_than_here() -> None:
    with pytest.raises(ParameterError, match='without a token'):
        PageServer(PageSettings(address='0.0.0.0'))
    require_token('127.0.0.1', '')
    asked = {'address': '0.0.0.0', 'token': 'long enough'}
    assert 'token' in str(refusal({'Host': 'tree.example'}, '', **asked))
    assert 'token' in str(refusal({'Host': 'tree.example'}, 'lóng', **asked))
    assert refusal({'Host': 'tree.example'}, 'long enough', **asked) is None
    other = {'Host': 'tree.example', 'Origin': 'https://scene.example'}
    assert 'origin' in str(refusal(other, 'long enough', **asked))
    assert refusal(other, 'long enough', **asked, origins=('https://scene.example',)) is None
    assert is_loopback('::1')
    assert is_loopback('localhost')
    assert not is_loopback('10.0.0.1')


def test_a_port_in_use_is_an_error_in_words(server: PageServer) -> None:
    with pytest.raises(TransportError, match='different port'):
        PageServer(PageSettings(port=server.port)).start()


def test_an_address_of_another_machine_is_told_as_such() -> None:
    # RFC 5737, block 2: no machine has this address.
    settings = PageSettings(address='198.51.100.7', token='a long token', port=0)
    with pytest.raises(TransportError, match="give an address of this machine's own"):
        PageServer(settings).start()


def test_of_two_pages_without_a_port_the_second_takes_a_free_one(
    server: PageServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Both were asked for when the usual port was free: only the server itself can tell."""
    monkeypatch.setattr(server_module, 'USUAL_PORT', server.port)
    with PageServer(PageSettings(port=None)) as second:
        assert second.port not in (0, server.port)
        assert str(second.port) in second.url


def test_a_server_that_does_not_start_in_time_is_an_error(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(server_module, '_START_TIMEOUT', 0.05)
    made = PageServer(PageSettings(port=0))
    may_go_on, serve = threading.Event(), made._serve

    async def late() -> None:
        await asyncio.to_thread(may_go_on.wait, DEADLINE)
        await serve()

    monkeypatch.setattr(made, '_serve', late)
    with pytest.raises(TransportError, match='not served after'):
        made.start()
    may_go_on.set()
    made._thread.join(DEADLINE)
    assert not made._thread.is_alive()  # it ends by itself


def test_a_server_that_was_never_started_leaves_no_loop() -> None:
    made = PageServer(PageSettings(port=0))
    made.close()
    made.close()
    assert made._loop.is_closed()


def test_a_client_that_does_not_read_keeps_its_hello() -> None:
    class Socket:
        closed = False

        def __init__(self) -> None:
            self.sent: list[Any] = []

        async def send_str(self, text: str) -> None:
            self.sent.append(json.loads(text))

    with PageServer(PageSettings(port=0)) as made:
        socket = Socket()
        client = PageClient(socket, None)  # type: ignore[arg-type]
        client.hello = made._hello(may_control=False)
        for number in range(50):
            client.say({'status': number})
        asyncio.run(client.send_due(made._published))
    assert 'hello' in socket.sent[0]
    assert socket.sent[-1] == {'status': 49}
    assert len(socket.sent) == 17


@pytest.mark.parametrize(
    ('rate', 'credit', 'missed'), [(60.0, 64, 0), (20.0, 64, 0), (60.0, 4, 6), (60.0, 0, 9)]
)
def test_frames_that_a_late_client_misses_are_counted(
    rate: float, credit: int, missed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It asks for frames, gives leave for a few, and for more after ten of 60 Hz."""

    class Socket:
        async def send_bytes(self, _: bytes) -> None:
            pass

    async def frames() -> int:
        loop = asyncio.get_running_loop()
        client, published = PageClient(Socket(), None), Published(b'tree')  # type: ignore[arg-type]
        client.take({'rate': rate, 'credit': credit + 1})
        for number in range(12):
            monkeypatch.setattr(loop, 'time', lambda at=number / 60.0: 100.0 + at)
            published.newest = number, b'frame'
            if number == 11:
                client.take({'credit': 64})
            await client.send_due(published)
        client.stop_timer()
        return client.missed

    assert asyncio.run(frames()) == pytest.approx(missed, abs=1 if missed else 0)


def test_health_and_headers(server: PageServer) -> None:
    async def script(viewer: Viewer) -> None:
        await viewer.binary()
        async with viewer.session.get(f'{server.url}healthz') as answer:
            assert (await answer.json())['status'] == 'ok'
        async with viewer.session.get(server.url) as answer:
            policy = answer.headers['Content-Security-Policy']
            assert policy.startswith("default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; ")
            assert policy.count('unsafe') == 1
            assert '<!doctype html>' in (await answer.text()).lower()
        async with viewer.session.get(f'{server.url}static/../server.py') as answer:
            assert answer.status == 404

    run(server, script)


def test_a_tree_is_written_or_refused_with_the_reason(server: PageServer) -> None:
    def written(suffix: str) -> bytes:
        if suffix == 'html':
            raise ParameterError('no table', where='model', cure='take 60')
        return b'glTF'

    async def answers(url: str) -> list[tuple[int, bytes]]:
        found = []
        async with aiohttp.ClientSession() as session:
            for suffix in ('glb', 'html'):
                asked = {'X-Requested-With': 'test'}
                async with session.get(f'{url}tree.{suffix}', headers=asked) as answer:
                    found.append((answer.status, await answer.read()))
        return found

    assert {status for status, _ in asyncio.run(answers(server.url))} == {404}
    with PageServer(PageSettings(port=0), None, None, written) as other:
        (first, data), (second, why) = asyncio.run(answers(other.url))
    assert (first, data, second) == (200, b'glTF', 409)
    assert b'take 60' in why


def test_what_a_camera_sees_is_for_who_may_control(server: PageServer) -> None:
    film: Any = SimpleNamespace(picture=[b'jpeg', None].pop)

    async def answer(url: str, token: str, **headers: str) -> tuple[int, bytes, Any]:
        headers['Authorization'] = f'Bearer {token}'
        async with aiohttp.ClientSession(headers=headers) as session:
            async with session.get(f'{url}camera.jpg') as found:
                status, data = found.status, await found.read()
            async with session.ws_connect(f'{url}stream') as viewer:
                hello = (await viewer.receive_json(timeout=DEADLINE))['hello']
            return status, data, hello['has_camera']

    own = {'X-Requested-With': 'test'}
    assert asyncio.run(answer(server.url, '', **own))[::2] == (404, False)
    token = 'a token of some length'
    with PageServer(PageSettings(port=0, token=token), film=film) as seeing:
        assert asyncio.run(answer(seeing.url, seeing.viewers_token, **own))[::2] == (403, False)
        assert asyncio.run(answer(seeing.url, token))[0] == 403  # as by an image of another page
        assert asyncio.run(answer(seeing.url, token, **own)) == (204, b'', True)
        assert asyncio.run(answer(seeing.url, token, **own)) == (200, b'jpeg', True)


def test_the_page_is_sent_packed_and_not_twice(server: PageServer) -> None:
    async def script(viewer: Viewer) -> None:
        url = f'{server.url}static/drawing/scene.js'
        async with viewer.session.get(url, headers={'Accept-Encoding': 'gzip'}) as answer:
            assert answer.headers['Content-Encoding'] == 'gzip'
            assert answer.content_type in ('text/javascript', 'application/javascript')
            text, tag = await answer.text(), answer.headers['ETag']
        async with viewer.session.get(url, headers={'Accept-Encoding': 'identity'}) as answer:
            assert await answer.text() == text
        async with viewer.session.get(url, headers={'If-None-Match': tag}) as answer:
            assert answer.status == 304
        async with viewer.session.get(f'{server.url}static/nothing.js') as answer:
            assert answer.status == 404

    run(server, script)


def test_what_a_visitor_downloads_is_small(server: PageServer) -> None:
    """All files of the page, as they are sent: at most 200 kB."""
    paths = ['', *(f'static/{each.relative_to(STATIC)}' for each in STATIC.rglob('*.*'))]

    async def script(viewer: Viewer) -> int:
        n_bytes = 0
        for path in paths:
            url, packed = f'{server.url}{path}', {'Accept-Encoding': 'gzip'}
            async with viewer.session.get(url, headers=packed) as answer:
                assert answer.status == 200, path
                n_bytes += len(await answer.read())
        return n_bytes

    n_bytes = run(server, script, unpacks=False)
    print(f'the page is {1e-3 * n_bytes:.0f} kB')
    assert 50_000 < n_bytes < 200_000


HOSTILE = (
    b'\x16\x03\x01' + bytes(range(256)),
    b'GET /stream HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 4611686018427387904\r\n\r\n',
    b'GET / HTTP/1.1\r\nHost: ' + b'a' * 100_000 + b'\r\n\r\n',
    b'POST / HTTP/1.1\r\nHost: 127.0.0.1\r\nTransfer-Encoding: chunked\r\n\r\n'
    b'FFFFFFFFFFFFFFFF\r\n',
)
UPGRADE = (
    b'GET /stream HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n'
    b'Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n'
)
BAD_FRAMES = (
    b'\x82\xff\x40' + bytes(7) + bytes(4),  # 2^62 bytes are to follow
    b'\x81\x85\0\0\0\0hello',  # not JSON
    b'\x81\x86\0\0\0\0[1, 2]',
    b'\x83\x80\0\0\0\0',  # a reserved kind
    b'\x01\x81\0\0\0\0{\x81\x81\0\0\0\0}',  # a message within another
    b'\x82\x81\0\0\0\0x',  # bytes where text is spoken
)


def is_closed_by_the_server(port: int, *parts: bytes) -> bool:
    """Whether the server ends a connection that sent this."""
    with socket.create_connection(('127.0.0.1', port), timeout=DEADLINE) as connection:
        try:
            for part in parts:
                connection.sendall(part)
                connection.recv(1)
            while connection.recv(65536):
                pass
        except ConnectionError:
            pass
        except TimeoutError:
            return False
    return True


@pytest.mark.parametrize('data', HOSTILE, ids=range(len(HOSTILE)))
def test_what_is_no_request_is_closed(
    server: PageServer, data: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(doorkeeper, 'ASKING_TIME', 0.3)
    assert is_closed_by_the_server(server.port, data)


@pytest.mark.parametrize('frame', BAD_FRAMES, ids=range(len(BAD_FRAMES)))
def test_bad_frames_are_closed(
    server: PageServer, frame: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(server_module, '_CLOSING_TIME', 0.2)
    assert is_closed_by_the_server(server.port, UPGRADE, frame)
    until(lambda: server.n_clients == 0)


def test_hostile_input_costs_no_memory_and_a_viewer_no_frame(
    server: PageServer, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    caplog.set_level('CRITICAL', 'aiohttp.server')  # or what is logged is kept
    monkeypatch.setattr(server_module, '_CLOSING_TIME', 0.2)
    attacks = [(HOSTILE[0],), (HOSTILE[2],), *((UPGRADE, frame) for frame in BAD_FRAMES)]

    def attack() -> None:
        for parts in attacks:
            assert is_closed_by_the_server(server.port, *parts)

    async def script(viewer: Viewer) -> None:
        await viewer.binary()
        number, kept = 0, []
        for _ in range(3):
            attacked = asyncio.get_running_loop().run_in_executor(None, attack)
            before = number
            while not attacked.done():
                server.publish(f'F{number}'.encode())
                await viewer.say(credit=1)
                assert await viewer.binary() == f'F{number}'.encode()
                number += 1
                await asyncio.wait({attacked}, timeout=1.0 / 60.0)  # as a page draws
            await attacked
            assert number > before
            until(lambda: server.n_clients == 1)
            gc.collect()
            kept.append(tracemalloc.get_traced_memory()[0])
        assert kept[-1] - kept[1] < 100_000, kept

    tracemalloc.start()
    try:
        run(server, script)
    finally:
        tracemalloc.stop()


def test_slow_headers_are_closed(server: PageServer, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(doorkeeper, 'ASKING_TIME', 0.2)
    began = time.monotonic()
    assert is_closed_by_the_server(server.port, b'GET / HTTP/1.1\r\nHost: 127')
    assert time.monotonic() - began < DEADLINE / 2


def test_too_many_pages_are_refused() -> None:
    with PageServer(PageSettings(port=0, max_clients=1)) as server:
        server.describe(DESCRIPTION)

        async def script(viewer: Viewer) -> None:
            await viewer.binary()
            with pytest.raises(aiohttp.WSServerHandshakeError, match='503'):
                await viewer.session.ws_connect(f'{server.url}stream')

        run(server, script)


def test_publishing_does_not_wait_for_anybody(server: PageServer) -> None:
    """Frames are published while the server's own thread is blocked."""
    occupied, freed = threading.Event(), threading.Event()
    in_time = []

    def hold() -> None:
        occupied.set()
        in_time.append(freed.wait(DEADLINE))

    server._loop.call_soon_threadsafe(hold)
    assert occupied.wait(DEADLINE)
    for _ in range(1000):
        server.publish(bytes(96))
    freed.set()
    until(lambda: bool(in_time))
    assert in_time == [True]
