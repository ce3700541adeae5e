# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Those who mean no good: too many sockets, odd requests and numbers, and the token they seek."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator
import contextlib
import errno
import json
from pathlib import Path
import resource
import shutil
import socket
import ssl
import subprocess
import threading
import time
from types import SimpleNamespace
from typing import Any

import pytest

aiohttp = pytest.importorskip('aiohttp', reason='aiohttp is not installed')

from tree_sway import doorkeeper  # noqa: E402
from tree_sway.errors import ParameterError, TransportError  # noqa: E402
from tree_sway.page import access, guard  # noqa: E402
from tree_sway.page import server as server_module  # noqa: E402
from tree_sway.page.access import make_token, read_token  # noqa: E402
from tree_sway.page.page_settings import PageSettings  # noqa: E402
from tree_sway.page.server import PageServer  # noqa: E402
from tree_sway.stream.client import StreamClient  # noqa: E402
from tree_sway.stream.controls import Control, ControlPanel  # noqa: E402

pytestmark = pytest.mark.usefixtures('little_effort')

DEADLINE = 60.0
DESCRIPTION = (Path(__file__).parent / 'vectors' / 'description.bin').read_bytes()
TOKEN = 'confidential-words'


def until(holds: Callable[[], bool]) -> None:
    """Wait for a condition, no longer than the deadline."""
    end = time.monotonic() + DEADLINE
    while not holds():
        assert time.monotonic() < end, 'it did not come to pass'
        time.sleep(0.005)


@pytest.fixture
def server() -> Iterator[PageServer]:
    wind = Control('wind', 'Wind', 6.0, minimum=0.0, maximum=40.0)
    free = Control('free', 'Free', 6.0)
    panel = ControlPanel((wind, free), lambda *_: None)
    with PageServer(PageSettings(port=0), panel) as server:
        server.describe(DESCRIPTION)
        yield server


def answer_to(port: int, request: bytes) -> bytes:
    """Send a request on a socket of its own; what comes back until it is closed."""
    with socket.create_connection(('127.0.0.1', port), timeout=DEADLINE) as connection:
        connection.sendall(request)
        answer = b''
        with contextlib.suppress(ConnectionError):
            while data := connection.recv(65536):
                answer += data
        return answer


def lines_of(caplog: pytest.LogCaptureFixture) -> list[str]:
    """Return what was logged, tracebacks included."""
    return [line for record in caplog.records for line in record.getMessage().splitlines()]


ODD_REQUESTS = {
    'an origin that is no address': b'GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nOrigin: http://[\r\n',
    'an origin of raw bytes': b'GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nOrigin: http://\xff\r\n',
    'a host of raw bytes': b'GET / HTTP/1.1\r\nHost: 127.0.0.1\xff\r\n',
    'a path of 300 letters': b'GET /static/%b HTTP/1.1\r\nHost: 127.0.0.1\r\n' % (b'a' * 300),
    'a length of 400 digits': b'GET / HTTP/1.1\r\nHost: a\r\nContent-Length: %b\r\n'
    % (b'9' * 400),
    'a header without a name': b'GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n: x\r\n',
    'a line that is no request': b'GET\r\n',
}


@pytest.mark.parametrize('name', ODD_REQUESTS)
def test_an_odd_request_is_answered_by_400_and_one_counted_line(
    name: str, server: PageServer, caplog: pytest.LogCaptureFixture
) -> None:
    for count in range(1, 21):
        answer = answer_to(server.port, ODD_REQUESTS[name] + b'Connection: close\r\n\r\n')
        assert answer.split()[1] == b'400', answer[:200]
        assert server.n_refused == count
    assert len(lines_of(caplog)) == 1
    assert not caplog.records[0].exc_info


@pytest.mark.parametrize(
    'request_',
    [
        b'GET /static/%00 HTTP/1.1\r\nHost: 127.0.0.1\r\n',
        b'GET /static/../../server.py HTTP/1.1\r\nHost: 127.0.0.1\r\n',
        b'GET /?token=\xff%ff HTTP/1.1\r\nHost: 127.0.0.1\r\n',
        b'GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nAuthorization: Bearer \xff\xfe\r\n',
        b'GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nUser-Agent: \xff\r\n',
    ],
)
def test_other_odd_requests_bring_no_traceback(
    request_: bytes, server: PageServer, caplog: pytest.LogCaptureFixture
) -> None:
    answer = answer_to(server.port, request_ + b'Connection: close\r\n\r\n')
    assert answer.split()[1] in (b'200', b'400', b'403', b'404')
    assert len(lines_of(caplog)) <= 1


def run(server: PageServer, script: Callable[[Any], Any], **options: Any) -> Any:
    """Run a script with the socket of a connected viewer."""

    async def whole() -> Any:
        async with (
            aiohttp.ClientSession() as session,
            session.ws_connect(f'{server.url}stream', **options) as ws,
        ):
            return await script(ws)

    return asyncio.run(whole())


DIGITS = '9' * 400


@pytest.mark.parametrize(
    'text',
    [
        '{"rate":1e-9}',
        '{"rate":0}',
        '{"rate":NaN}',
        '{"rate":true}',
        f'{{"rate":{DIGITS}}}',
        f'{{"ping":{DIGITS}}}',
        '{"ping":"x"}',
        '{"credit":null}',
        '{"credit":-1e99}',
        '[' * 4000,
    ],
)
def test_an_odd_text_ends_the_line_and_is_counted(
    text: str, server: PageServer, caplog: pytest.LogCaptureFixture
) -> None:
    async def script(ws: Any) -> None:
        await ws.send_str(text)
        while (await asyncio.wait_for(ws.receive(), DEADLINE)).type not in (
            aiohttp.WSMsgType.CLOSE,
            aiohttp.WSMsgType.CLOSED,
        ):
            pass
        assert ws.close_code == aiohttp.WSCloseCode.POLICY_VIOLATION

    run(server, script)
    assert server.n_refused == 1
    assert len(lines_of(caplog)) == 1


@pytest.mark.parametrize('name', ['wind', 'free'])
def test_a_value_of_400_digits_is_refused_in_words(name: str, server: PageServer) -> None:
    async def script(ws: Any) -> None:
        await ws.send_str(f'{{"set":{{"name":"{name}","value":{DIGITS}}},"credit":{DIGITS}}}')
        while True:
            message = await asyncio.wait_for(ws.receive(), DEADLINE)
            if message.type is aiohttp.WSMsgType.TEXT and 'refused' in json.loads(message.data):
                assert 'out of range' in json.loads(message.data)['refused']['reason']
                return

    run(server, script)


def test_a_pull_that_is_refused_later_is_reported_to_its_sender_alone() -> None:
    def pull(_segment: int, _to: Any, _stiffness: float, refused: Callable[[str], None]) -> None:
        refuser = threading.Thread(target=lambda: refused('no segment 7'))
        refuser.start()
        refuser.join()

    async def whole(url: str) -> list[list[Any]]:
        heard: list[list[Any]] = [[], []]
        async with (
            aiohttp.ClientSession() as session,
            session.ws_connect(f'{url}stream') as one,
            session.ws_connect(f'{url}stream') as other,
        ):
            await one.send_str('{"pull":{"segment":7,"to":[1,0,1],"stiffness":5}}')
            for number, ws in enumerate((one, other)):
                await ws.send_str('{"ping":1}')
                while 'status' not in (message := await ws.receive_json(timeout=DEADLINE)):
                    heard[number] += [message['refused']] if 'refused' in message else []
        return heard

    with PageServer(PageSettings(port=0), ControlPanel(pull=pull)) as server:
        heard = asyncio.run(whole(server.url))
        assert heard == [[{'name': 'pull', 'reason': 'no segment 7'}], []]
        assert server.n_refused == 1


def test_a_slow_client_has_one_timer(server: PageServer) -> None:
    async def script(ws: Any) -> None:
        await ws.send_str('{"rate":0.1,"credit":60}')
        received = 0
        while received < 2:  # the description and the first frame
            server.publish(bytes(60))
            message = await asyncio.wait_for(ws.receive(), DEADLINE)
            received += message.type is aiohttp.WSMsgType.BINARY
        for number in range(300):
            server.publish(bytes(60))
            await ws.send_str(f'{{"ping":{number}}}')
            while True:
                message = await asyncio.wait_for(ws.receive(), DEADLINE)
                is_text = message.type is aiohttp.WSMsgType.TEXT
                if is_text and json.loads(message.data).get('pong') == number:
                    break
        scheduled = [timer for timer in server._loop._scheduled if not timer.cancelled()]  # type: ignore[attr-defined]
        assert len(scheduled) < 20

    run(server, script)


def test_a_frame_costs_neither_a_task_nor_a_timer(server: PageServer) -> None:
    """Else the memory of a page that is followed for hours grows."""
    made: list[object] = []

    def make(loop: asyncio.AbstractEventLoop, work: Any, **more: Any) -> Any:
        made.append(work)
        return asyncio.Task(work, loop=loop, **more)

    async def script(ws: Any) -> None:
        received = 0
        while received < 200:
            if received == 100:
                server._loop.call_soon_threadsafe(server._loop.set_task_factory, make)
            await ws.send_str('{"credit":1}')
            server.publish(bytes(60))
            message = await asyncio.wait_for(ws.receive(), DEADLINE)
            received += message.type is aiohttp.WSMsgType.BINARY

    run(server, script)
    assert len(made) < 20


@pytest.fixture(scope='module')
def certificate(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, str]:
    """Certificate and key for 127.0.0.1."""
    openssl = shutil.which('openssl')
    if openssl is None:
        pytest.skip('openssl is not installed here')
    folder = tmp_path_factory.mktemp('tls')
    files = str(folder / 'certificate.pem'), str(folder / 'key.pem')
    subprocess.run(
        [openssl, 'req', '-x509', '-newkey', 'rsa:2048', '-nodes', '-days', '2', '-subj',
         '/CN=127.0.0.1', '-out', files[0], '-keyout', files[1]],
        check=True, capture_output=True,
    )  # fmt: skip
    return files


def sockets(port: int, count: int) -> list[socket.socket]:
    """Open sockets that say nothing."""
    return [socket.create_connection(('127.0.0.1', port), timeout=DEADLINE) for _ in range(count)]


def is_closed(connection: socket.socket) -> bool:
    """Whether the server has closed a socket that said nothing."""
    connection.setblocking(False)
    try:
        return connection.recv(1) == b''
    except BlockingIOError:
        return False
    except ConnectionError:
        return True


def test_files_that_are_no_certificate_are_named(
    tmp_path: Path, certificate: tuple[str, str]
) -> None:
    wrong, missing = tmp_path / 'wrong.pem', tmp_path / 'missing.pem'
    wrong.write_text('no certificate')
    certified, key = certificate
    for files in ((wrong, key), (certified, wrong), (missing, key), (certified, certified)):
        settings = PageSettings(port=0, certificate=str(files[0]), private_key=str(files[1]))
        with pytest.raises(TransportError, match='no certificate with its private key') as caught:
            PageServer(settings)
        assert caught.value.where == f'{files[0]} and {files[1]}'
        assert 'PEM' in caught.value.cure


def test_sockets_that_never_shake_hands_are_counted_and_closed(
    certificate: tuple[str, str],
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    certified, key = certificate
    settings = PageSettings(port=0, token=TOKEN, certificate=certified, private_key=key)
    with PageServer(settings) as server, contextlib.ExitStack() as stack:
        server.describe(DESCRIPTION)
        silent = [stack.enter_context(each) for each in sockets(server.port, 1100)]
        until(lambda: sum(map(is_closed, silent)) >= 1100 - server._doors.most)
        assert server._doors.n_open <= server._doors.most
        trusting = ssl.create_default_context(cafile=certified)
        trusting.check_hostname = False

        async def script(ws: Any) -> None:
            while (await asyncio.wait_for(ws.receive(), DEADLINE)).data != DESCRIPTION:
                pass

        began = time.monotonic()
        run(server, script, headers={'Authorization': f'Bearer {TOKEN}'}, ssl=trusting)
        assert time.monotonic() - began < doorkeeper.ASKING_TIME
        with (
            contextlib.suppress(OSError),
            socket.create_connection(('127.0.0.1', server.port), timeout=DEADLINE) as wrong,
        ):
            wrong.sendall(b'GET / HTTP/1.1\r\n\r\n')
            while wrong.recv(4096):
                pass
    assert len(lines_of(caplog)) <= 1
    monkeypatch.setattr(doorkeeper, 'ASKING_TIME', 0.2)
    with PageServer(settings) as server, contextlib.ExitStack() as stack:
        silent = [stack.enter_context(each) for each in sockets(server.port, 10)]
        until(lambda: all(map(is_closed, silent)))
        assert server._doors.n_closed == 10


def test_who_has_the_token_is_not_shut_out_by_those_who_have_none() -> None:
    with (
        PageServer(PageSettings(port=0, token=TOKEN)) as server,
        contextlib.ExitStack() as stack,
    ):
        server.describe(DESCRIPTION)
        keepers = [stack.enter_context(each) for each in sockets(server.port, 256)]

        def keep() -> None:
            for keeper in keepers:
                with contextlib.suppress(OSError):
                    keeper.sendall(b'GET /healthz HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n')

        async def script(ws: Any) -> int:
            received = 0
            await ws.send_str('{"credit":60}')
            while received < 20:
                keepers.extend(stack.enter_context(each) for each in sockets(server.port, 2))
                keep()
                server.publish(bytes(60))
                message = await asyncio.wait_for(ws.receive(), DEADLINE)
                assert message.type in (aiohttp.WSMsgType.TEXT, aiohttp.WSMsgType.BINARY)
                received += message.type is aiohttp.WSMsgType.BINARY
            return received

        keep()
        headers = {'Authorization': f'Bearer {TOKEN}'}
        assert run(server, script, headers=headers) == 20
        with pytest.raises(aiohttp.WSServerHandshakeError, match='403'):
            run(server, script, headers={'Authorization': 'Bearer other'})


def test_a_system_without_handles_is_one_line(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(doorkeeper, '_PAUSE', 0.01)
    with PageServer(PageSettings(port=0)) as server:
        accept, failed = server._loop.sock_accept, []

        async def full(listener: socket.socket) -> Any:
            accepted = await accept(listener)
            if len(failed) < 10:
                failed.append(accepted[0].close())
                raise OSError(errno.EMFILE, 'Too many open files')
            return accepted

        monkeypatch.setattr(server._loop, 'sock_accept', full)
        sockets_of_before = sockets(server.port, 12)
        until(lambda: len(failed) == 10)
        answer = b''
        while not answer.startswith(b'HTTP/1.1 200'):
            answer = answer_to(
                server.port,
                b'GET /healthz HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n',
            )
        for each in sockets_of_before:
            each.close()
    assert len(lines_of(caplog)) == 1
    assert 'Too many open files' in lines_of(caplog)[0]


def test_attacks_cost_neither_memory_nor_handles(server: PageServer) -> None:
    """A thousand odd requests: within 64 MiB, and every handle given back."""
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for number in range(1000):
        odd = list(ODD_REQUESTS.values())[number % len(ODD_REQUESTS)]
        answer_to(server.port, odd + b'Connection: close\r\n\r\n')
    until(lambda: server._doors.n_open == 0)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 64 * 1024


def test_the_token_comes_from_a_file_and_is_shown_nowhere(
    tmp_path: Path, caplog: pytest.LogCaptureFixture, capfd: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / 'token'
    path.write_text(f'{TOKEN}\n', encoding='ascii')
    path.chmod(0o600)
    caplog.set_level('DEBUG')
    settings = PageSettings(port=0, token_file=str(path))
    with PageServer(settings) as server:
        server.describe(DESCRIPTION)
        assert b'403' in answer_to(server.port, b'GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n')
        with StreamClient(f'{server.url}?token={TOKEN}') as client:
            until(lambda: client.description is not None)
            shown = f'{client.url} {client.problem} {server.url} {settings}'
        request = f'GET /?token={TOKEN} HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n'
        answer = answer_to(server.port, request.encode())
        assert answer.startswith(b'HTTP/1.1 200')
        assert TOKEN.encode() not in answer
    shown += f'{PageSettings(token=TOKEN)} {caplog.text} {capfd.readouterr()}'
    assert TOKEN not in shown


def test_a_viewer_without_the_token_is_asked_for_it() -> None:
    with PageServer(PageSettings(port=0, token=TOKEN)) as server:
        answer = answer_to(server.port, b'GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n')
        assert b'text/html' in answer
        assert b'name="token" type="password"' in answer
        assert b'type the token' in answer
        assert b'href="static/style.css"' in answer


@pytest.mark.parametrize(
    ('content', 'mode', 'match'),
    [
        (TOKEN, 0o644, 'every user'),
        (TOKEN, 0o602, 'every user'),
        ('short', 0o600, 'no token of 8'),
        ('x' * 300, 0o600, 'no token of 8'),
        ('two\nlines of it', 0o600, 'no token of 8'),
        ('lóng enough', 0o600, 'cannot be read'),
        (None, 0o600, 'cannot be read'),
    ],
)
def test_a_bad_token_file_is_refused(
    content: str | None, mode: int, match: str, tmp_path: Path
) -> None:
    path = tmp_path / 'token'
    if content is not None:
        path.write_text(content, encoding='utf-8')
        path.chmod(mode)
    with pytest.raises(ParameterError, match=match) as error:
        read_token(path)
    assert TOKEN not in str(error.value)
    assert read_token('') == ''


def test_a_token_is_made_where_there_is_none(tmp_path: Path) -> None:
    path = tmp_path / 'token'
    token = make_token(path)
    assert path.stat().st_mode & 0o777 == 0o600
    assert read_token(path) == token
    assert len(token) >= 40
    for taken in (path, tmp_path / 'no folder' / 'token'):
        with pytest.raises(ParameterError, match='no token can be written'):
            make_token(taken)
    assert read_token(path) == token


def status_of(port: int, path: str, *headers: str) -> int:
    """Return the status of the answer to a GET."""
    lines = [f'GET {path} HTTP/1.1', 'Host: 127.0.0.1', 'Connection: close', *headers, '', '']
    return int(answer_to(port, '\r\n'.join(lines).encode()).split()[1])


def test_a_viewers_token_shows_and_changes_nothing() -> None:
    changed: list[Any] = []
    wind = Control('wind', 'Wind', 6.0, minimum=0.0, maximum=40.0)
    panel = ControlPanel((wind,), lambda *each: changed.append(each), lambda *_: None)

    async def script(ws: Any) -> list[Any]:
        hello = (await ws.receive_json(timeout=DEADLINE))['hello']
        await ws.send_str('{"set":{"name":"wind","value":9},"pull":{"segment":0}}')
        reasons = []
        while len(reasons) < 2:
            message = await asyncio.wait_for(ws.receive(), DEADLINE)
            if message.type is aiohttp.WSMsgType.TEXT:
                text = json.loads(message.data)
                reasons += [text['refused']['reason']] if 'refused' in text else []
        return [hello, *reasons]

    with PageServer(PageSettings(port=0, token=TOKEN), panel) as server:
        server.describe(DESCRIPTION)
        headers = {'Authorization': f'Bearer {server.viewers_token}'}
        hello, *reasons = run(server, script, headers=headers)
        assert hello['controls'] == []
        assert hello['can_pull'] is False
        assert hello['viewers_token'] == server.viewers_token
        assert all('to look only' in reason for reason in reasons)
        assert changed == []
        assert server.n_refused == 2
        assert TOKEN not in server.viewers_token

        async def control(ws: Any) -> Any:
            return (await ws.receive_json(timeout=DEADLINE))['hello']

        hello = run(server, control, headers={'Authorization': f'Bearer {TOKEN}'})
        assert [each['name'] for each in hello['controls']] == ['wind']
        assert hello['can_pull'] is True


@pytest.mark.parametrize('is_viewer', [False, True])
def test_a_cookie_replaces_the_token_of_the_address(is_viewer: bool) -> None:
    with PageServer(PageSettings(port=0, token=TOKEN)) as server:
        token = server.viewers_token if is_viewer else TOKEN
        request = f'GET /?token={token} HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n'
        answer = answer_to(server.port, request.encode()).partition(b'\r\n\r\n')[0].decode()
        (line,) = [each for each in answer.split('\r\n') if each.startswith('Set-Cookie: ')]
        assert 'HttpOnly' in line
        assert 'SameSite=Strict' in line
        assert TOKEN not in answer
        cookie = line.removeprefix('Set-Cookie: ').partition(';')[0]
        assert status_of(server.port, '/', f'Cookie: {cookie}') == 200
        assert status_of(server.port, '/', f'Cookie: {cookie}x') == 403
        assert status_of(server.port, '/') == 403

        async def control(ws: Any) -> Any:
            return (await ws.receive_json(timeout=DEADLINE))['hello']['can_pull']

        server._panel = ControlPanel(pull=lambda *_: None)
        assert run(server, control, headers={'Cookie': cookie}) != is_viewer


def test_guesses_of_a_token_are_slowed_by_address(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = SimpleNamespace(monotonic=lambda: now)
    monkeypatch.setattr(guard, 'time', clock)
    now = 100.0
    with PageServer(PageSettings(port=0, token=TOKEN)) as server:
        for number in range(access.GUESSES):
            assert status_of(server.port, f'/?token=guess{number}') == 403
        assert status_of(server.port, '/?token=another') == 429
        assert status_of(server.port, f'/?token={TOKEN}') == 429  # else it would be an answer
        assert status_of(server.port, '/') == 403  # which is no guess
        now += 0.9 * access.GUESSING_TIME
        assert status_of(server.port, f'/?token={TOKEN}') == 429
        now += 0.2 * access.GUESSING_TIME
        assert status_of(server.port, f'/?token={TOKEN}') == 200


def test_an_old_cookie_is_one_guess() -> None:
    with PageServer(PageSettings(port=0, token=TOKEN)) as server:
        for _ in range(3 * access.GUESSES):
            assert status_of(server.port, '/', f'Cookie: tree_sway_{server.port}=old') == 403
        assert status_of(server.port, f'/?token={TOKEN}') == 200


def test_guesses_are_counted_in_bounded_memory() -> None:
    guesses = access.Guesses()
    for number in range(100):
        guesses.note(f'2001:db8::{number:x}', f'guess{number}', 0.0)
    assert guesses.waiting_time('2001:db8::ffff', 0.0) == 81.0
    assert guesses.waiting_time('2001:db8::ffff', 60.0) == 21.0
    assert guesses.waiting_time('2001:db8:0:1::1', 0.0) == 0.0
    for number in range(5000):
        guesses.note(f'10.0.{number // 256}.{number % 256}', 'x', 0.0)
    assert len(guesses._of) <= 1024


def test_pictures_of_other_pages_cause_no_files(tmp_path: Path) -> None:
    """A browser requests the address of an image from any server, without an Origin."""
    asked, may_end, running = [], threading.Event(), [0, 0]

    def written(suffix: str) -> bytes:
        asked.append(suffix)
        running[0] += 1
        running[1] = max(running)
        may_end.wait(DEADLINE)
        running[0] -= 1
        return b'tree'

    with PageServer(PageSettings(port=0), None, None, written) as server:
        origin = f'Origin: http://127.0.0.1:{server.port}'
        host = f'Host: 127.0.0.1:{server.port}'
        for headers in ((), ('Sec-Fetch-Site: cross-site',), ('Referer: http://evil.example/',)):
            assert status_of(server.port, '/tree.html', *headers) == 403
        assert status_of(server.port, '/tree.html', 'Origin: http://evil.example') == 403
        assert asked == []
        statuses: list[int] = []
        own = f'GET /tree.html HTTP/1.1\r\n{host}\r\n{origin}\r\nConnection: close\r\n\r\n'

        def ask() -> None:
            statuses.append(int(answer_to(server.port, own.encode()).split()[1]))

        threads = [threading.Thread(target=ask) for _ in range(12)]
        for thread in threads:
            thread.start()
        until(lambda: statuses.count(503) == 8)
        may_end.set()
        for thread in threads:
            thread.join()
        assert sorted(statuses) == 4 * [200] + 8 * [503]
        assert running[1] == 1


def test_a_page_that_answers_no_ping_is_gone_and_sent_nothing_wrong(
    server: PageServer, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(server_module, '_HEARTBEAT', 0.1)

    async def stay_silent() -> None:
        async with (
            aiohttp.ClientSession() as session,
            session.ws_connect(f'{server.url}stream', autoping=False) as page,
        ):
            while (await page.receive(DEADLINE)).type not in {
                aiohttp.WSMsgType.CLOSE,
                aiohttp.WSMsgType.CLOSED,
                aiohttp.WSMsgType.ERROR,
            }:
                pass

    asyncio.run(stay_silent())
    until(lambda: not server._clients)
    assert server.n_refused == 0
    assert not lines_of(caplog)
