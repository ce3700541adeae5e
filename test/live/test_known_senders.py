# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Messages of stations at a plain port: each is read in its units, as by its own source."""

from __future__ import annotations

import json
import math

import pytest

from tree_sway.files.wind import Reading, WindReading
from tree_sway.live.readers.documents import read_document
from tree_sway.live.readers.instrument_lines import InstrumentLines
from tree_sway.live.readers.named_values import WindNames
from tree_sway.live.transports.transport import Message

MPH = 0.44704
CONDITIONS = {
    'did': '001D0A700002', 'ts': 1531754005,
    'conditions': [
        {'lsid': 3187671188, 'data_structure_type': 3, 'bar_sea_level': 30.1},
        {'lsid': 48308, 'data_structure_type': 1, 'txid': 1, 'wind_speed_last': 10.0,
         'wind_dir_last': 270, 'wind_speed_avg_last_10_min': 4.0,
         'wind_speed_hi_last_2_min': 20.0},
    ],
}  # fmt: skip
TEMPEST = {
    'serial_number': 'SK-00008453', 'type': 'rapid_wind', 'hub_sn': 'HB-00000001',
    'ob': [1493322445, 2.3, 128],
}  # fmt: skip


def deltas(**values: float) -> list[dict[str, object]]:
    return [
        {'context': 'vessels.self', 'updates': [
            {'$source': 'n2k', 'values': [{'path': f'environment.wind.{path}', 'value': value}]}
        ]}
        for path, value in values.items()
    ]  # fmt: skip


def read(*documents: object) -> list[Reading]:
    reader = InstrumentLines()
    return [
        each for document in documents for each in reader(Message(json.dumps(document).encode()))
    ]


@pytest.mark.parametrize('wrapped', [False, True])
def test_conditions_of_davis_are_in_miles_per_hour(wrapped: bool) -> None:
    document = {'data': CONDITIONS, 'error': None} if wrapped else CONDITIONS
    for found in (read(document), read_document(document, WindNames())):
        assert isinstance(found[0], WindReading)
        assert found[0].speed == pytest.approx(10.0 * MPH)
        assert found[0].bearing == pytest.approx(math.radians(270.0))
        assert found[0].gust == pytest.approx(20.0 * MPH)


def test_a_tempest_is_read_with_its_sender() -> None:
    status = {'serial_number': 'HB-00000001', 'type': 'hub_status', 'hub_sn': 'HB-00000001'}
    (found,) = read(status, TEMPEST)
    assert isinstance(found, WindReading)
    assert found.speed == pytest.approx(2.3)
    assert found.bearing == pytest.approx(math.radians(128.0))
    assert found.sender == 'SK-00008453'


def test_deltas_of_signal_k_are_in_radians() -> None:
    (found,) = read(*deltas(directionTrue=1.5, speedTrue=4.0))
    assert isinstance(found, WindReading)
    assert (found.speed, found.bearing) == pytest.approx((4.0, 1.5))
