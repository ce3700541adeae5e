# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Two instruments that send to one address: the second is refused, counted and named."""

from __future__ import annotations

from collections.abc import Iterator
import json
import socket
from typing import Any

import pytest

from test.live.test_live_wind import Told
from tree_sway.live import live_source, live_wind
from tree_sway.live.transports.transport import Message

FIRST, SECOND = b'5.0,270', b'20.0,90'


class Two(Told):
    """Live wind of two senders, on a clock of the test; its link does not rest."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, address: str) -> None:
        super().__init__(monkeypatch, address)
        monkeypatch.setattr(live_source, 'time', live_wind.time)
        monkeypatch.setattr(self.wind.link, 'pause', lambda _seconds: None)

    def alternate(self, first: Message, second: Message, times: int = 100) -> None:
        """Send both once a second, the second half a second later."""
        for _ in range(times):
            self.now += 0.5
            self.wind.link.deliver(first)
            self.now += 0.5
            self.wind.link.deliver(second)

    def begin(self) -> None:
        """Send twice from one sender, which is followed then."""
        for _ in range(2):
            self.now += 1.0
            self.wind.link.deliver(Message(FIRST, 'real:2'))

    @property
    def n_refused(self) -> int:
        return sum(self.wind.refused.values())


@pytest.fixture
def two(monkeypatch: pytest.MonkeyPatch) -> Two:
    return Two(monkeypatch, 'udp:5006')


def form(speed: int, **more: str) -> bytes:
    return '&'.join(
        [f'windspeedmph={speed}', 'winddir=270', *(f'{k}={v}' for k, v in more.items())]
    ).encode()


def told(speed: float, **more: Any) -> bytes:
    return json.dumps({'wind_speed': speed, 'wind_dir': 270, **more}).encode()


@pytest.mark.parametrize(
    ('address', 'first', 'second', 'name'),
    [
        ('udp:5006', Message(FIRST, 'a:1'), Message(SECOND, 'b:1'), 'b:1'),
        ('udp:5006', Message(FIRST, 'a:11'), Message(SECOND, 'a:12'), 'a:12'),
        ('udp:5006', Message(told(5, sn='A1')), Message(told(20, sn='B2')), 'B2'),
        ('mqtt://h/w/#', Message(b'5.0', 'w/a'), Message(b'20.0', 'w/b'), 'w/b'),
        ('mqtt://h/w', Message(told(5, id=7), 'w'), Message(told(20, id=8), 'w'), 'w 8'),
        ('ecowitt:80', Message(form(5), '10.0.0.5'), Message(form(20), '10.0.0.6'), '10.0.0.6'),
        ('ecowitt:80', Message(form(5, ID='A')), Message(form(20, ID='B')), 'B'),
        (
            'ecowitt:80',
            Message(form(5, PASSKEY='AA')),
            Message(form(20, PASSKEY='BB')),
            'station fc686c31',
        ),
    ],
)
def test_the_second_of_two_is_refused(monkeypatch, address, first, second, name) -> None:
    two = Two(monkeypatch, address)
    said: list[str] = []
    monkeypatch.setattr(two.wind, '_log', said.append)
    two.alternate(first, second)
    assert two.wind.state == 'live'
    assert two.wind.newest is not None
    assert two.wind.newest.speed < 6.0
    assert 99 <= two.n_refused <= 100
    assert list(two.wind.refused) == [f'another sender, {name}']
    assert two.wind.source['refused'] == two.wind.refused
    assert len([text for text in said if f'another sender, {name}, until' in text]) == 1


def test_a_sender_that_is_silent_gives_way(two: Two) -> None:
    two.alternate(Message(FIRST, 'a:1'), Message(SECOND, 'b:1'), 10)
    refused = two.n_refused
    for _ in range(60):
        two.now += 1.0
        two.wind.link.deliver(Message(SECOND, 'b:1'))
    assert two.wind.newest is not None
    assert two.wind.newest.speed == 20.0
    assert two.n_refused - refused < 15  # ten seconds of silence
    two.wind.link.deliver(Message(FIRST, 'a:1'))
    assert two.wind.newest.speed == 20.0


@pytest.mark.parametrize('data', [FIRST, told(5)])
def test_a_program_may_open_a_port_for_each_datagram(two: Two, data: bytes) -> None:
    for k in range(100):
        two.now += 1.0
        two.wind.link.deliver(Message(data, f'10.0.0.5:{40_000 + k}'))
    assert two.wind.accepted == 100
    assert two.n_refused == 0


def test_numbers_of_messages_are_no_senders(two: Two) -> None:
    for k in range(100):
        two.now += 1.0
        two.wind.link.deliver(Message(told(5, id=k)))
    assert two.wind.accepted == 100


def test_a_stranger_without_a_good_sample_keeps_nobody_out(two: Two) -> None:
    for line in (b'hello', b'$WIMWV,270.0,R,10.0,N,V', b'\xff\xfe', b'999.0,270'):
        two.now += 1.0
        two.wind.link.deliver(Message(line, 'stranger:1'))
        two.wind.link.deliver(Message(FIRST, 'real:2'))
        two.wind.link.deliver(Message(FIRST, 'real:2'))
    assert two.wind.accepted == 8


def test_a_flood_of_a_stranger_does_not_use_up_the_rate_of_the_first(two: Two) -> None:
    two.begin()
    for _ in range(20):
        for _ in range(1000):
            two.wind.link.deliver(Message(SECOND, 'stranger:1'))
        two.now += 0.1
        two.wind.link.deliver(Message(FIRST, 'real:2'))
    assert two.wind.accepted == 22
    assert two.wind.refused == {'another sender, stranger:1': 20_000}


def test_senders_without_end_are_counted_in_few_words(two: Two, monkeypatch) -> None:
    said: list[str] = []
    monkeypatch.setattr(two.wind, '_log', said.append)
    two.begin()
    said.clear()
    for k in range(1000):
        two.wind.link.deliver(Message(SECOND, f'10.0.{k // 250}.{k % 250}:1'))
    assert two.n_refused == 1000
    assert len(two.wind.refused) <= 21
    assert len(said) <= 20


@pytest.fixture
def sockets() -> Iterator[list[socket.socket]]:
    made = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(2)]
    yield made
    for each in made:
        each.close()


def test_two_programs_on_one_port_of_this_machine(hear, port, sockets) -> None:
    heard = hear(f'udp://127.0.0.1:{port}')
    first, second = sockets
    first.sendto(FIRST, ('127.0.0.1', port))

    def both() -> None:
        first.sendto(FIRST, ('127.0.0.1', port))
        second.sendto(SECOND, ('127.0.0.1', port))

    heard.until(lambda: sum(heard.wind.refused.values()) >= 20, both)
    assert heard.wind.newest.speed == 5.0
    name = f'another sender, 127.0.0.1:{second.getsockname()[1]}'
    assert list(heard.wind.refused) == [name]


def test_one_message_without_a_name_does_not_deafen_a_hub(monkeypatch: pytest.MonkeyPatch) -> None:
    """A hub passes on several instruments from one address: their names are in the messages."""
    two = Two(monkeypatch, 'tempest')
    unnamed = {'type': 'rapid_wind', 'ob': [1493322445, 5.3, 270]}
    named = Message(json.dumps({**unnamed, 'serial_number': 'ST-1'}).encode(), '10.0.0.5:50222')
    two.alternate(named, named, 2)
    two.wind.link.deliver(Message(json.dumps(unnamed).encode(), '10.0.0.5:50222'))
    two.alternate(named, named, 10)
    assert two.wind.accepted == 24
    assert two.n_refused == 1
