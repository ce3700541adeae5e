# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import socket
import sys
import threading
import time

import pytest

from tree_sway.errors import MissingDependencyError
from tree_sway.live.transports.modbus import Modbus
from tree_sway.live.transports.serial_port import SerialPort
from tree_sway.live.transports.stream_lines import Question
from tree_sway.live.transports.tcp import Tcp
from tree_sway.live.transports.udp import Udp


def test_a_connection_that_breaks_is_made_again(hear, server):
    heard = hear(Tcp(*server.getsockname()))
    for line in (b'one', b'two'):
        connection, _ = server.accept()
        connection.sendall(line + b'\r\n')
        heard.until(lambda line=line: line in heard.data)
        connection.close()
    heard.until(lambda: any('closed by the other side' in text for text in heard.said))
    assert heard.data == [b'one', b'two']
    assert heard.link.connections >= 2


def test_a_connection_that_falls_silent_is_made_again(hear, server):
    heard = hear(Tcp(*server.getsockname()), silence=0.1)
    first, _ = server.accept()
    second, _ = server.accept()
    second.sendall(b'again\n')
    heard.until(lambda: heard.data == [b'again'])
    assert any('nothing for 0.1 s' in text for text in heard.said)
    first.close()
    second.close()


def test_a_port_that_is_silent_is_told_of_once_and_hears_again(hear, udp_port):
    """It is opened again and again, at once each time."""
    heard = hear(Udp('127.0.0.1', udp_port), silence=0.05)
    address = f'udp://127.0.0.1:{udp_port}'
    heard.until(lambda: heard.link.is_up)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        sender.sendto(b'first', ('127.0.0.1', udp_port))
        heard.until(lambda: heard.data == [b'first'])
        connections = heard.link.connections
        heard.until(lambda: heard.link.connections >= connections + 20)

        def sent():
            sender.sendto(b'again', ('127.0.0.1', udp_port))
            return len(heard.data) > 1

        heard.until(sent)
    assert f'{address}: messages come again' in heard.said
    silent = f'{address}: nothing for 0.05 s; trying again'
    # Once after each message, however often it is opened again.
    assert 0 < heard.said.count(silent) < heard.link.connections / 2


def test_nobody_there_is_said_once_and_tried_again(hear, server):
    address = server.getsockname()
    server.close()
    heard = hear(Tcp(*address))
    heard.until(lambda: heard.said)
    with socket.create_server(address) as again:
        again.settimeout(10.0)
        connection, _ = again.accept()
        connection.sendall(b'hello\n')
        heard.until(lambda: heard.data == [b'hello'])
        connection.close()
    assert sum('refused' in text for text in heard.said) == 1


def test_an_instrument_that_waits_for_a_question_is_asked(hear, server):
    heard = hear(Tcp(*server.getsockname(), Question(b'0R0!', 0.05)))
    connection, _ = server.accept()
    with connection, connection.makefile('rb') as stream:
        for _ in range(2):
            assert stream.read(4) == b'0R0!'
            connection.sendall(b'0+332+000.04+00\r\n')
        heard.until(lambda: len(heard.data) >= 2)


def test_datagrams_are_messages(hear, udp_port):
    heard = hear(Udp('127.0.0.1', udp_port))
    heard.until(lambda: heard.link.is_up)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        sender.sendto(b'$WIMWD,1\r\na', ('127.0.0.1', udp_port))
    heard.until(lambda: heard.data == [b'$WIMWD,1\r\na'])


def test_a_flood_does_not_keep_a_link_from_ending(hear, udp_port):
    heard = hear(Udp('127.0.0.1', udp_port))
    heard.until(lambda: heard.link.is_up)
    over = threading.Event()

    def flood():
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            while not over.wait(0.0001):
                sender.sendto(b'late\n', ('127.0.0.1', udp_port))

    sending = threading.Thread(target=flood)
    sending.start()
    heard.until(lambda: heard.messages)
    heard.link.stop()
    over.set()
    sending.join()
    assert not heard.link._thread.is_alive()


def test_endless_bytes_without_a_line_take_no_memory(hear, server):
    heard = hear(Tcp(*server.getsockname()))
    connection, _ = server.accept()
    with connection:
        for _ in range(100):
            connection.sendall(b'x' * 65_536)
        connection.sendall(b'\n$WIMWD,1\r\n')
        heard.until(lambda: heard.data)
    assert heard.data == [b'$WIMWD,1']


def test_an_error_of_the_reader_is_told_and_the_link_goes_on(hear, server):
    heard = hear(Tcp(*server.getsockname()))

    def fail(message):
        raise RuntimeError('no reader')

    heard.link.take = fail
    connection, _ = server.accept()
    connection.sendall(b'one\n')
    heard.until(lambda: any('RuntimeError: no reader' in text for text in heard.said))
    server.accept()[0].close()
    connection.close()


@pytest.mark.parametrize('seconds', [0.0, 0.3])
def test_a_link_ends_at_once(hear, server, seconds):
    """Also while it waits for a server that does not answer."""
    heard = hear(Tcp(*server.getsockname()))
    threading.Event().wait(seconds)
    begin = time.monotonic()
    heard.link.stop()
    assert time.monotonic() - begin < 0.5


@pytest.mark.parametrize(
    ('module', 'make'),
    [
        ('serial', lambda: SerialPort('/dev/ttyUSB0')),
        ('serial', lambda: Modbus('/dev/ttyUSB0', 0, 1, baud=9600)),
    ],
)
def test_a_missing_library_is_named_with_its_cure(monkeypatch, module, make):
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(MissingDependencyError, match=f"'{module}'.*(sensors|in_venv)"):
        make()
