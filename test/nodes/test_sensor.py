# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import socket

import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
pytestmark = pytest.mark.ros

from tree_sway.errors import TreeSwayError  # noqa: E402
from tree_sway.files.wind.sensor_line import checksum_of  # noqa: E402
from tree_sway_ros.process.topics import WIND, WIND_FILTERED  # noqa: E402


@pytest.fixture
def say():
    """Send a sentence to a port of this machine, its checksum added."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        yield lambda port, body: sender.sendto(f'${body}*{checksum_of(body)}'.encode(), port)


@pytest.fixture
def port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(('127.0.0.1', 0))
        return probe.getsockname()


def test_a_westerly_of_an_instrument_blows_to_the_east(compose, observer, statuses, port, say):
    nodes = compose(sensor={'address': f'udp://127.0.0.1:{port[1]}', 'heading': 0.0}, wind={})
    said, filtered = observer.listen(WIND), observer.listen(WIND_FILTERED)
    sentence = 'WIMWV,270.0,R,10.0,N,A'
    observer.until(lambda: say(port, sentence) and said and filtered, 'wind')
    assert said[-1].vector.x == pytest.approx(5.144, abs=1e-3)
    assert said[-1].vector.y == pytest.approx(0.0, abs=1e-9)
    for bad in ('WIMWV,270.0,R,10.0,N,V', 'GPGGA,1,2', 'WIMWD,90,T,,M,3,N,,M'):
        say(port, bad)
    sensor = nodes['sensor']
    wind = sensor._wind
    observer.until(lambda: wind.other >= 2 and wind.refused, 'what is refused')
    assert list(wind.refused) == ["status is 'V', not A"]
    status = sensor._report()[0]
    assert (status.level, status.values['reading']) == (0, 'MWV R')


def test_lines_that_are_refused_are_a_warning(compose, observer, statuses, port, say):
    compose(sensor={'address': f'udp://127.0.0.1:{port[1]}'})

    def said():
        say(port, 'WIMWV,270.0,R,10.0,N,A')
        say(port, 'WIMWV,270.0,R,10.0,N,V')
        return getattr(statuses('sensor: link'), 'message', '')

    observer.until(lambda: 'lines refused' in said(), 'a warning', poll=0.1)
    assert 'status is' in said()
    assert statuses('sensor: link').level[0] == 1


def test_what_is_no_address_is_refused(compose):
    with pytest.raises(TreeSwayError, match='is no source of wind'):
        compose(sensor={'address': 'com1'})


def test_lines_that_nobody_understands_are_a_warning_with_the_last_one(
    compose, observer, statuses, port
):
    compose(sensor={'address': f'udp://127.0.0.1:{port[1]}'})

    def said():
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            sender.sendto(b'T=21.5 C, RH=60 %', port)
        return getattr(statuses('sensor: link'), 'message', '')

    observer.until(lambda: 'none was understood' in said(), 'a warning', poll=0.1)
    assert 'the last: T=21.5 C, RH=60 %' in said()


def test_means_are_published_as_gusts_about_them(compose, observer, port):
    compose(sensor={'address': f'udp://127.0.0.1:{port[1]}?mean=600'}, wind={})
    said = observer.listen(WIND)

    def blows():
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            sender.sendto(b'8.0,270', port)
        return len(said) > 20

    observer.until(blows, 'gusts', poll=0.1)
    east = [message.vector.x for message in said]
    assert len(set(east)) > 10
    assert 3.0 < sum(east) / len(east) < 13.0


def test_a_cup_without_a_vane_blows_from_the_bearing_of_the_parameter(compose, observer, port):
    compose(sensor={'address': f'udp://127.0.0.1:{port[1]}?mean=0', 'bearing': 0.0})
    said = observer.listen(WIND)

    def blows():
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            sender.sendto(b'5.3', port)
        return said

    observer.until(blows, 'wind', poll=0.1)
    assert said[-1].vector.y == pytest.approx(-5.3)
