# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from tree_sway.errors import ParameterError
from tree_sway.simulation.wind.sensor_faults import FAULTS, SensorFaults

RATE = 10


def stream(kind, seconds=5.0):
    """Make a wind that counts samples, 10 per second; a fault of 0.5 s every second."""
    faults = SensorFaults(kind, 1.0, 0.5)
    sent = []
    for k in range(round(seconds * RATE)):
        sent += faults.sent(k / RATE, 10**9 + k, np.array([float(k), 0.0, 0.0]))
    return [(stamp - 10**9, vector[0]) for stamp, vector in sent]


def test_without_a_fault_all_is_sent_as_it_is():
    assert stream('none') == [(k, k) for k in range(50)]


@pytest.mark.parametrize('kind', FAULTS)
def test_before_the_first_and_between_faults_all_is_sent_as_it_is(kind):
    sent = stream(kind)
    assert sent[:10] == [(k, k) for k in range(10)]
    assert {(17, 17), (28, 28), (39, 39)} <= set(sent)


def test_each_fault_is_what_it_is_called():
    during = {kind: stream(kind)[10:] for kind in FAULTS}
    assert during['dropout'][0] == (15, 15)
    assert during['restart'][:2] == [(15, 0), (16, 16)]
    assert during['spike'][0] == (10, 30)
    assert during['freeze'][:6] == [(10, 10), (11, 10), (12, 10), (13, 10), (14, 10), (15, 15)]
    assert np.isnan([value for _, value in during['nan'][:5]]).all()
    assert during['no_reading'][0] == (10, 999.99)
    assert [stamp for stamp, _ in during['delay'][:6]] == [10, 11, 12, 13, 14, 15]
    assert [stamp for stamp, _ in during['reorder'][:6]] == [11, 10, 13, 12, 14, 15]
    assert during['duplicate'][:3] == [(10, 10), (10, 10), (11, 11)]
    assert during['zero_stamp'][0] == (-(10**9), 10)
    assert during['future_stamp'][0][0] > 3600 * 10**9


def test_all_has_each_in_its_turn():
    faults = SensorFaults('all', 1.0, 0.5)
    seen = [faults.at(k + 0.25) for k in range(1, len(FAULTS) - 1)]
    assert seen == list(FAULTS[1:-1])
    assert faults.at(len(FAULTS) - 1 + 0.25) == FAULTS[1]


def test_what_cannot_be_is_refused():
    for arguments in (('fire',), ('nan', 0.0), ('nan', 1.0, 2.0)):
        with pytest.raises(ParameterError):
            SensorFaults(*arguments)
