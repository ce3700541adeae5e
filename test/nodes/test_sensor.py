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
    observer.until(lambda: sensor._other >= 2 and sensor._refused, 'what is refused')
    assert list(sensor._refused) == ['status is']
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
    with pytest.raises(TreeSwayError, match='no address of an instrument'):
        compose(sensor={'address': 'com1'})
