# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The port for stations: who may set the wind through it."""

from __future__ import annotations

from contextlib import suppress
import http.client
import socket
from typing import Any
from urllib.error import HTTPError
from urllib.request import Request, urlopen

import pytest

from tree_sway.errors import ParameterError
from tree_sway.live.registry import open_source

WIND = 'windspeedmph=10&winddir=270'
KEY = 'a-word-of-the-farm'


@pytest.fixture
def station(hear, port) -> Any:
    """Listen to a port of this machine; what sends a request to it, and what is heard."""

    def start(options: str = '') -> tuple[Any, Any]:
        heard = hear(f'ecowitt:{port}{options}')
        heard.until(lambda: heard.wind.link.is_up)

        def ask(path: str = f'/?{WIND}', body: str = '', **headers: str) -> int:
            named = {name.replace('_', '-'): value for name, value in headers.items()}
            url = f'http://127.0.0.1:{port}{path}'
            try:
                with urlopen(Request(url, body.encode() or None, named), timeout=5.0) as answer:
                    return int(answer.status)
            except HTTPError as error:
                return error.code

        return heard, ask

    return start


def test_a_port_is_of_this_machine_alone(station, port) -> None:
    heard, ask = station()
    assert str(heard.wind.link.transport) == f'http://127.0.0.1:{port}'
    assert ask() == 200
    heard.until(lambda: heard.wind.accepted == 1)


@pytest.mark.parametrize('host', ['0.0.0.0', '192.168.1.4', '::'])
def test_an_open_port_needs_a_passkey(host: str, tmp_path) -> None:
    with pytest.raises(ParameterError, match='open to the network, without a passkey'):
        open_source(f'ecowitt:8080?host={host}')
    (tmp_path / 'key').write_text(KEY)
    opened = open_source(f'ecowitt:8080?host={host}&passkey_file={tmp_path / "key"}')
    assert KEY not in repr(opened)


@pytest.mark.parametrize(
    'headers',
    [
        {'Origin': 'http://evil.example'},
        {'Origin': 'null'},
        {'Referer': 'http://evil.example/page.html'},
        {'Sec_Fetch_Site': 'cross-site'},
        {'Sec_Fetch_Site': 'same-origin', 'Host': 'evil.example:8080'},
        {'Accept_Language': 'en', 'User_Agent': 'Mozilla/5.0', 'Accept': 'image/*'},
    ],
)
def test_no_page_of_a_browser_sets_a_wind(station, headers: dict[str, str]) -> None:
    heard, ask = station()
    assert ask(**headers) == 403
    assert ask(body=WIND, **headers) == 403
    assert heard.wind.accepted == 0
    assert heard.wind.refused == {'a request of a browser': 2}
    assert 'a request of a browser' in heard.wind.problem


def test_the_passkey_is_a_field_or_a_part_of_the_path(station, tmp_path) -> None:
    (tmp_path / 'key').write_text(f'{KEY}\n')
    heard, ask = station(f'?passkey_file={tmp_path / "key"}')
    for path, body in [
        (f'/?{WIND}', ''),
        (f'/?{WIND}&PASSWORD=', ''),
        (f'/?{WIND}&PASSWORD={KEY}x', ''),
        (f'/?{WIND}&other={KEY}', ''),
        ('/data/report/', f'{WIND}&PASSKEY=0123'),
        ('/', '&'.join(['a=b'] * 1000)),
    ]:
        assert ask(path, body) == 403
    assert heard.wind.accepted == 0
    assert heard.wind.refused == {'a request without the passkey': 6}
    assert ask(f'/?{WIND}&PASSWORD={KEY}') == 200
    assert ask('/data/report/', f'{WIND}&PASSKEY={KEY}') == 200
    assert ask(f'/{KEY}/report', WIND) == 200
    heard.until(lambda: heard.wind.accepted == 3)


def test_headers_of_100_kb_are_refused_without_a_traceback(station, port, capfd) -> None:
    heard, ask = station()
    with socket.create_connection(('127.0.0.1', port), 5.0) as link:
        link.sendall(b'GET / HTTP/1.1\r\nHost: a\r\nX: ' + b'x' * 100_000 + b'\r\n\r\n')
        assert b'400' in link.recv(100)
    for noise in (b'\x00\x01\x02\r\n\r\n', b'GET / HTTP/9.9\r\n\r\n', b'\x16\x03\x01' * 99):
        with socket.create_connection(('127.0.0.1', port), 5.0) as link:
            link.sendall(noise + b'\r\n\r\n')
            link.recv(100)
    assert ask() == 200
    heard.until(lambda: heard.wind.accepted == 1)
    assert capfd.readouterr() == ('', '')
    assert heard.wind.refused['a request that is not HTTP'] >= 1


def test_sockets_that_never_ask_do_not_keep_a_station_out(station, port) -> None:
    heard, ask = station()
    silent = [socket.create_connection(('127.0.0.1', port), 5.0) for _ in range(100)]
    for each in silent:
        each.sendall(b'GET / HT')
    assert ask() == 200
    for each in silent:
        each.close()
    heard.until(lambda: heard.wind.accepted == 1)


def test_a_body_that_never_ends_is_refused(station, port) -> None:
    heard, _ = station()
    link = http.client.HTTPConnection('127.0.0.1', port, timeout=5.0)

    def endless() -> Any:
        while True:
            yield b'x' * 10_000

    status = 413  # or the connection is closed before that is read
    with suppress(OSError, http.client.HTTPException):
        link.request('POST', '/', endless(), {'Transfer-Encoding': 'chunked'}, encode_chunked=True)
        status = link.getresponse().status
    assert status == 413
    heard.until(lambda: heard.wind.refused)
