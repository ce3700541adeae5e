# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The Python client: poses as the sender has them, a line that comes back, the page's playout."""

from __future__ import annotations

import base64
from collections.abc import Callable, Iterator
from contextlib import suppress
import hashlib
import json
import os
from pathlib import Path
import shutil
import socket
import subprocess
import sys
import threading
import time
from typing import Any

import numpy as np
import pytest

pytest.importorskip('aiohttp', reason='aiohttp is not installed')


from tree_sway.core.arrays import Floats  # noqa: E402
from tree_sway.core.model.state_basis import FULL_SCALE  # noqa: E402
from tree_sway.errors import ParameterError, TransportError  # noqa: E402
from tree_sway.page.page_settings import PageSettings  # noqa: E402
from tree_sway.page.server import PageServer  # noqa: E402
from tree_sway.stream.client import StreamClient  # noqa: E402
from tree_sway.stream.controls import Control, ControlPanel  # noqa: E402
from tree_sway.stream.placing import Placer  # noqa: E402
from tree_sway.stream.playout import ClockOffset, Moment, Playout  # noqa: E402
from tree_sway.stream.protocol import (  # noqa: E402
    decode_description,
    encode_description,
    encode_frame,
    Frame,
    RESTARTED,
)

DEADLINE = 60.0
HERE = Path(__file__).parent
STATIC = HERE.parents[1] / 'tree_sway' / 'page' / 'static'
DESCRIPTION = (HERE / 'vectors' / 'description.bin').read_bytes()
PLACER = Placer(decode_description(DESCRIPTION))
N = len(PLACER.description.scale)


def shape(time_s: float) -> Floats:
    """Coordinates as shares of their scale at a time [s]."""
    return 0.05 * np.sin(2.0 * time_s + np.arange(N))


class Sender(threading.Thread):
    """Publishes a smooth motion, 60 times per second."""

    def __init__(self, server: PageServer) -> None:
        super().__init__(daemon=True)
        self.server, self.ended = server, threading.Event()
        self.sequence = 0

    def run(self) -> None:
        while not self.ended.wait(1.0 / 60.0):
            now = time.time_ns()
            steps = np.rint(FULL_SCALE * shape(1e-9 * now % 1e4)).astype(np.int16)
            identity = PLACER.description.short_identity
            frame = Frame(identity, self.sequence, now, 0, np.array([3.0, 0.0, 0.0]), steps)
            self.sequence += 1
            self.server.publish(encode_frame(frame))


def until(holds: Callable[[], bool]) -> None:
    """Wait for a condition, no longer than the deadline."""
    end = time.monotonic() + DEADLINE
    while not holds():
        assert time.monotonic() < end, 'it did not come to pass'
        time.sleep(0.005)


def serving(port: int = 0) -> tuple[PageServer, Sender]:
    refuse = Control('mean_speed', 'Wind', 3.0, minimum=0.0, maximum=9.0)
    server = PageServer(PageSettings(port=port), ControlPanel((refuse,), lambda *_: None))
    server.start()
    server.describe(DESCRIPTION)
    sender = Sender(server)
    sender.start()
    return server, sender


def end(server: PageServer, sender: Sender) -> None:
    sender.ended.set()
    sender.join()
    server.close()


@pytest.fixture
def server() -> Iterator[PageServer]:
    made = serving()
    yield made[0]
    end(*made)


def test_poses_are_those_of_the_sender_a_delay_ago(server: PageServer) -> None:
    with StreamClient(server.url) as client:
        client.wait(DEADLINE, frames=20)
        now = time.time()
        moment, poses = client.sample(now), client.poses(now)
        assert moment is not None and poses is not None  # noqa: PT018
        assert 0.1 < now - moment.stamp < 0.5
        scale = PLACER.description.scale
        exact = PLACER.place(scale * shape(moment.stamp % 1e4))
        assert np.linalg.norm(poses[:, :3] - exact[:, :3], axis=1).max() < 1e-3
        assert client.round_trip < 1.0
        assert client.state == 'open'
        client.set('mean_speed', 99.0)
        until(lambda: 'out of range' in client.problem)


def test_the_address_of_the_stream_is_that_of_the_page(server: PageServer) -> None:
    with StreamClient(f'{server.url}stream') as client:
        client.wait(DEADLINE)


def test_a_client_that_was_not_entered_says_so(server: PageServer) -> None:
    with pytest.raises(TransportError, match='not connected; with StreamClient'):
        StreamClient(server.url).wait(DEADLINE)


def test_a_change_without_a_connection_is_refused(server: PageServer) -> None:
    client = StreamClient(server.url)
    with pytest.raises(TransportError, match=r"'mean_speed' is not changed: .* connecting"):
        client.set('mean_speed', 5.0)
    with client:
        client.wait(DEADLINE)
    with pytest.raises(TransportError, match=r"'mean_speed' is not changed: .* lost"):
        client.set('mean_speed', 5.0)
    with pytest.raises(RuntimeError, match='entered once'), client:
        pass


def test_a_server_that_falls_silent_is_no_unreadable_message(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr('tree_sway.stream.client._SILENCE', 0.2)
    with socket.create_server(('127.0.0.1', 0)) as listener:
        answering = threading.Thread(target=shake_hands, args=(listener,))
        answering.start()
        with StreamClient(f'http://127.0.0.1:{listener.getsockname()[1]}/') as client:
            until(lambda: 'the line broke' in client.problem)
            assert client.unreadable == 0
        answering.join()


def shake_hands(listener: socket.socket) -> None:
    """Accept one WebSocket, read what it sends, and never say a word."""
    line, _ = listener.accept()
    with line:
        asked = line.recv(4096).decode()
        key = asked.split('Sec-WebSocket-Key: ')[1].split('\r\n')[0]
        magic = '258EAFA5-E914-47DA-95CA-C5AB0DC85B11'  # RFC 6455, section 4.2.2
        accepted = base64.b64encode(hashlib.sha1((key + magic).encode()).digest()).decode()
        line.sendall(
            'HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\n'
            f'Connection: Upgrade\r\nSec-WebSocket-Accept: {accepted}\r\n\r\n'.encode()
        )
        with suppress(ConnectionError):
            while line.recv(4096):
                pass


def test_a_line_that_is_lost_is_made_again() -> None:
    server, sender = serving()
    with StreamClient(server.url) as client:
        client.wait(DEADLINE)
        end(server, sender)
        until(lambda: client.state == 'lost')
        came = client.received
        assert client.poses() is not None  # the last state stays
        again = serving(server.port)
        client.wait(DEADLINE, frames=came + 5)
        assert client.state == 'open'
        end(*again)


def test_a_listener_that_fails_is_named_and_ends_nothing(server: PageServer) -> None:
    def fail(*_: object) -> None:
        raise KeyError('mine')

    with StreamClient(server.url, on_frame=fail) as client:
        client.wait(DEADLINE, frames=5)
        assert 'KeyError' in client.problem
        assert client.unreadable == 0


def test_who_asks_for_the_wind_only_gets_28_bytes_and_no_poses(server: PageServer) -> None:
    heard: list[Frame] = []
    with StreamClient(
        server.url, wind_only=True, on_frame=lambda frame, _: heard.append(frame)
    ) as client:
        client.wait(DEADLINE, frames=5)
        assert client.poses() is None
        assert client.unreadable == 0
    assert {len(frame.coordinates) for frame in heard} == {0}
    assert heard[0].wind == pytest.approx([3.0, 0.0, 0.0])


def test_a_state_is_placed_by_its_own_description(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = decode_description(DESCRIPTION)
    place = whole.arrays['tree_place'][:1]
    header = {**whole.header, 'trees': whole.header['trees'][:1]}
    other = decode_description(encode_description(header, {**whole.arrays, 'tree_place': place}))
    client = StreamClient('http://127.0.0.1:9/')
    client._describe(whole)
    moment = Moment(1.0, np.zeros(len(whole.scale)), np.zeros(3), 0)
    describers = [threading.Thread(target=client._describe, args=(other,))]

    def sample(_now: float | None = None) -> Moment:
        describers[0].start()
        describers[0].join(0.3)  # a new tree is described just now
        return moment

    monkeypatch.setattr(client, 'sample', sample)
    poses = client.poses()
    describers[0].join()
    assert poses is not None
    assert len(poses) == Placer(whole).n_segments
    assert client.description is other


def test_no_message_shows_the_token() -> None:
    with StreamClient('http://127.0.0.1:9/?token=confidential') as client:
        until(lambda: bool(client.problem))
        with pytest.raises(TransportError) as error:
            client.wait(0.0)
        assert 'confidential' not in f'{client.problem} {error.value} {client.url}'
    with pytest.raises(ParameterError, match='address'):
        StreamClient('http://[')


@pytest.mark.parametrize(
    'text', ['there:8765', 'there', '', 'http:///8765', 'file:///tmp', 'ftp://a']
)
def test_what_has_no_scheme_or_no_host_is_refused_with_the_cure(text: str) -> None:
    with pytest.raises(ParameterError, match='give http:// or https://'):
        StreamClient(text)


def refused(url: str) -> str:
    """Return the error of waiting at a server that refuses, which comes long before the time."""
    began = time.monotonic()
    with StreamClient(url) as client, pytest.raises(TransportError) as error:
        client.wait(DEADLINE)
    assert time.monotonic() - began < 0.5 * DEADLINE
    return str(error.value)


def test_a_wrong_token_is_an_error_at_once() -> None:
    with PageServer(PageSettings(port=0, token='the right one')) as server:
        assert 'give the token' in refused(f'{server.url}?token=wrong')
        assert 'give the token' in refused(server.url)


def certificate(folder: Path, name: str) -> tuple[str, str]:
    """Certificate that its own key has signed, and that key."""
    openssl = shutil.which('openssl')
    if openssl is None:
        pytest.skip('openssl is not installed here')
    files = str(folder / 'own.pem'), str(folder / 'own.key')
    subprocess.run(
        [openssl, 'req', '-x509', '-newkey', 'rsa:2048', '-nodes', '-days', '2', '-subj',
         '/CN=test', '-addext', f'subjectAltName={name}', '-out', files[0], '-keyout', files[1]],
        check=True, capture_output=True,
    )  # fmt: skip
    return files


WAITING = """
import sys
from tree_sway.errors import TransportError
from tree_sway.stream.client import StreamClient
with StreamClient(sys.argv[1]) as client:
    try:
        client.wait(60.0)
    except TransportError as error:
        raise SystemExit(str(error))
"""


def test_a_certificate_that_is_not_trusted_names_the_variable(tmp_path: Path) -> None:
    """The cure is the one that works: with the certificate in it, frames come."""
    certified, key = certificate(tmp_path, 'IP:127.0.0.1')
    settings = PageSettings(port=0, certificate=certified, private_key=key)
    with PageServer(settings) as server:
        server.describe(DESCRIPTION)
        sender = Sender(server)
        sender.start()
        error = refused(server.url)
        assert 'self-signed certificate' in error
        assert 'set SSL_CERT_FILE' in error
        environment = os.environ | {'SSL_CERT_FILE': certified}
        command = [sys.executable, '-c', WAITING, server.url]
        done = subprocess.run(command, env=environment, capture_output=True, timeout=DEADLINE)
        assert (done.returncode, done.stderr) == (0, b'')
        sender.ended.set()


def test_a_certificate_of_another_name_says_so(tmp_path: Path) -> None:
    certified, key = certificate(tmp_path, 'DNS:there')
    settings = PageSettings(port=0, certificate=certified, private_key=key)
    with PageServer(settings) as server:
        environment = os.environ | {'SSL_CERT_FILE': certified}
        command = [sys.executable, '-c', WAITING, server.url]
        done = subprocess.run(
            command, env=environment, capture_output=True, text=True, timeout=DEADLINE
        )
    assert 'use a host name that the certificate contains' in done.stderr


def test_http_where_there_is_tls_says_so(tmp_path: Path) -> None:
    certified, key = certificate(tmp_path, 'IP:127.0.0.1')
    settings = PageSettings(port=0, certificate=certified, private_key=key)
    with PageServer(settings) as server:
        with StreamClient(server.url.replace('https:', 'http:')) as client:
            until(lambda: 'if it has a certificate, give https://' in client.problem)


def test_https_where_there_is_no_tls_says_so(server: PageServer) -> None:
    assert 'give http://' in refused(server.url.replace('http:', 'https:'))


def test_who_is_not_there_or_sends_an_older_form_is_reported(server: PageServer) -> None:
    with StreamClient('http://127.0.0.1:9/') as client:
        with pytest.raises(TransportError, match='0 frames within'):
            client.wait(0.2)
        until(lambda: bool(client.problem))
    server.describe(b'TSWD' + bytes(80))
    with StreamClient(server.url) as client:
        until(lambda: 'version 0' in client.problem)
        assert client.poses() is None


def arrivals() -> list[dict[str, object]]:
    """Make a stream as it comes: late, twice, out of order, cut, from another clock."""
    rng = np.random.default_rng(4)
    frames: list[dict[str, object]] = []
    moment = latest = 1_000.0
    for number in range(240):
        moment += 1.2 if number == 90 else 1.0 / 30.0
        stamp = moment - (7.0 if number > 200 else 0.0)  # the sender's clock is set back
        flags = RESTARTED if number == 150 else 0
        held_up = 0.25 * (number % 50 == 49)
        at = moment + 5.04 + 0.05 * float(rng.exponential()) + held_up
        if held_up:  # and so is what comes behind it
            latest = at
        at = max(at, latest)
        values = np.sin(moment + np.arange(4)).tolist()
        if 40 <= number < 70:  # a branch is pulled
            values += [7.0, 0.1 * values[0]]
        frames.append({'stamp': stamp, 'at': at, 'values': values, 'flags': flags})
        if rng.random() < 0.1:
            frames.append({**frames[-1], 'at': at + 0.001})
    return sorted(frames, key=lambda each: each['at'])  # type: ignore[arg-type,return-value]


@pytest.mark.parametrize('delay', [0.17, None])
def test_javascript_plays_out_the_same(
    delay: float | None, javascript: Callable[..., Any]
) -> None:
    arrived = arrivals()
    program = f"""
      import {{ Playout }} from "{(STATIC / 'playout.js').as_uri()}";
      let text = "";
      for await (const chunk of process.stdin) text += chunk;
      const playout = new Playout({'170' if delay else ''}), out = [];
      for (const f of JSON.parse(text)) {{
        const at = 1000 * f.at;
        playout.push({{ stamp: 1000 * f.stamp, flags: f.flags, wind: [f.values[0], 1, 2],
          coordinates: Float32Array.from(f.values) }}, at);
        for (const later of [0, 11]) {{
          out.push([...playout.sample(at + later), playout.wind[0]]);
        }}
      }}
      console.log(JSON.stringify({{ out, late: playout.late, received: playout.received }}));
    """
    theirs = javascript(program, json.dumps(arrived))
    playout, ours = Playout(delay), []
    for each in arrived:
        values = np.array(each['values'])
        wind = np.array([values[0], 1.0, 2.0])
        at = float(each['at'])  # type: ignore[arg-type]
        stamp = float(each['stamp'])  # type: ignore[arg-type]
        flags = int(each['flags'])  # type: ignore[call-overload]
        moment = Moment(stamp, values, wind, flags)
        playout.push(moment, at)
        for later in (0.0, 0.011):
            shown = playout.sample(at + later)
            assert shown is not None
            ours.append([*shown.coordinates, shown.wind[0]])
    for own, other in zip(ours, theirs['out'], strict=True):
        np.testing.assert_allclose(own, other, atol=2e-5)
    assert (playout.late, playout.received) == (theirs['late'], theirs['received'])
    assert playout.late > 0


@pytest.mark.parametrize(
    ('late', 'each', 'shortest', 'longest'),
    [
        (0.004, 1, 0.003, 0.008),
        (0.03, 1, 0.025, 0.04),
        (0.1, 90, 0.06, 0.15),
        (0.3, 90, 0.12, 0.15),
    ],
)
def test_the_delay_is_what_the_line_asks_for(
    late: float, each: int, shortest: float, longest: float
) -> None:
    """Frames of 60 Hz that are late by up to some [s], all of them or one of some."""
    playout, rng, shown = Playout(), np.random.default_rng(3), []
    stamps = np.arange(3600) / 60.0
    delays = rng.uniform(0.0, np.where(np.arange(3600) % each == 0, late, 0.002))
    # What is late holds up what comes after it, as on TCP.
    on_the_way = list(zip(np.maximum.accumulate(stamps + delays), stamps, strict=True))
    for now in np.arange(1.0, 60.0, 1.0 / 60.0):
        while on_the_way and on_the_way[0][0] <= now:
            arrival, stamp = on_the_way.pop(0)
            values = np.array([np.sin(2.0 * np.pi * stamp)])
            playout.push(Moment(stamp, values, np.zeros(3)), arrival)
        moment = playout.sample(now)
        assert moment is not None
        shown.append(moment.stamp)
        # A sway of 1 Hz is where it is, though the next state is only expected.
        assert abs(moment.coordinates[0] - np.sin(2.0 * np.pi * moment.stamp)) < 0.002
        if now < 30.0:
            playout.late = 0
    assert shortest < playout.delay <= longest
    pace = 60.0 * np.diff(shown[1800:])
    uneven = float(np.mean(np.abs(pace - 1.0) > 0.3))
    print(f'{1e3 * playout.delay:.0f} ms, {playout.late} late, {uneven:.4f} of pictures uneven')
    # What comes later than the longest delay is missed, whatever is done.
    assert late > 0.15 or playout.late < 0.003 * 1800
    assert uneven < (0.01 if late < 0.15 else 0.05)


def test_the_offset_is_the_least_of_the_last_half_minute() -> None:
    clock = ClockOffset()
    for k in range(100):
        clock.add(float(k), k + 2.0 + 0.01 * (k % 7))
    assert clock.value == pytest.approx(2.0)
    clock.add(200.0, 202.5)
    assert clock.value == pytest.approx(2.5)


@pytest.mark.parametrize(
    ('address', 'changes'),
    [(None, {}), ('http://there', {'rate': '3'}), ('http://there', {'delay': -1.0})],
)
def test_what_a_client_cannot_take_is_refused(address, changes):
    with pytest.raises(ParameterError):
        StreamClient(address, **changes)
