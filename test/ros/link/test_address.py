# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import pytest

from tree_sway.errors import ParameterError
from tree_sway_ros.link.address import Address, read_address


@pytest.mark.parametrize(
    ('text', 'address'),
    [
        ('tcp://192.168.1.20:10110', Address('tcp', '192.168.1.20', 10110)),
        ('udp://:10110', Address('udp', '', 10110)),
        ('serial:/dev/ttyUSB0:9600', Address('serial', '/dev/ttyUSB0', 9600)),
    ],
)
def test_an_address_is_read_and_written(text, address):
    assert read_address(text) == address
    assert str(address) == text


def test_the_baud_rate_of_nmea_is_the_default():
    assert read_address('serial:/dev/ttyUSB0').number == 4800


@pytest.mark.parametrize(
    'text', ['', 'tcp://:10110', 'tcp://host', 'udp://:0', 'udp://:70000', 'serial:ttyUSB0', 'x']
)
def test_what_is_none_is_refused(text):
    with pytest.raises(ParameterError, match='is no address of an instrument'):
        read_address(text)
