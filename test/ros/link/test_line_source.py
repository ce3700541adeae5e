# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import socket
import sys
import threading

import pytest

from tree_sway.errors import MissingDependencyError
from tree_sway_ros.link.address import Address
from tree_sway_ros.link.line_source import LineSource


class Heard:
    """The lines of a source, and what it logs."""

    def __init__(self, address, **options):
        self.lines, self.said = [], []
        self._more = threading.Condition()
        self.source = LineSource(address, self._take, self._log, first_pause=0.02, **options)
        self.source.start()

    def _take(self, line):
        with self._more:
            self.lines.append(line)
            self._more.notify_all()

    def _log(self, text):
        with self._more:
            self.said.append(text)
            self._more.notify_all()

    def until(self, condition):
        with self._more:
            assert self._more.wait_for(condition, 10.0), (self.lines, self.said)


@pytest.fixture
def hear():
    made = []

    def start(*arguments, **options):
        made.append(Heard(*arguments, **options))
        return made[-1]

    yield start
    for each in made:
        each.source.stop()
        assert not each.source._thread.is_alive()


@pytest.fixture
def server():
    with socket.create_server(('127.0.0.1', 0)) as made:
        made.settimeout(10.0)
        yield made


def test_a_link_that_breaks_is_taken_up_again(hear, server):
    heard = hear(Address('tcp', *server.getsockname()))
    for line in ('one', 'two'):
        connection, _ = server.accept()
        connection.sendall(f'{line}\r\n'.encode())
        heard.until(lambda line=line: line in heard.lines)
        connection.close()
    heard.until(lambda: any('closed by the other side' in text for text in heard.said))
    assert heard.lines == ['one', 'two']
    assert heard.source.links >= 2


def test_a_link_that_falls_silent_is_made_again(hear, server):
    heard = hear(Address('tcp', *server.getsockname()), silence=0.1)
    first, _ = server.accept()
    second, _ = server.accept()
    second.sendall(b'again\n')
    heard.until(lambda: heard.lines == ['again'])
    assert any('nothing for 0.1 s' in text for text in heard.said)
    first.close()
    second.close()


def test_a_flood_of_datagrams_does_not_keep_it_from_ending(hear):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(('127.0.0.1', 0))
        address = probe.getsockname()
    heard = hear(Address('udp', *address))
    heard.until(lambda: heard.source.is_up)
    over = threading.Event()

    def flood():
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            while not over.wait(0.0001):
                sender.sendto(b'late\n', address)

    sending = threading.Thread(target=flood)
    sending.start()
    heard.until(lambda: heard.lines)
    heard.source.stop()
    over.set()
    sending.join()
    assert not heard.source._thread.is_alive()


def test_nobody_there_is_said_once_and_tried_again(hear, server):
    address = server.getsockname()
    server.close()
    heard = hear(Address('tcp', *address))
    heard.until(lambda: heard.said)
    with socket.create_server(address) as again:
        again.settimeout(10.0)
        connection, _ = again.accept()
        connection.sendall(b'hello\n')
        heard.until(lambda: heard.lines == ['hello'])
        connection.close()
    assert sum('Connect' in text for text in heard.said) == 1


def test_datagrams_are_lines(hear):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(('127.0.0.1', 0))
        address = probe.getsockname()
    heard = hear(Address('udp', *address))
    heard.until(lambda: heard.source.is_up)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        sender.sendto(b'$WIMWD,1', address)
        sender.sendto(b'a\r\nb\r\n', address)
    heard.until(lambda: heard.lines == ['$WIMWD,1', 'a', 'b'])


def test_a_serial_port_needs_pyserial(monkeypatch):
    monkeypatch.setitem(sys.modules, 'serial', None)
    with pytest.raises(MissingDependencyError, match='pip install pyserial'):
        LineSource(Address('serial', '/dev/ttyUSB0', 4800), print, print)
