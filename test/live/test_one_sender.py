# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

from itertools import count

import pytest

from tree_sway.live.one_sender import OneSender


def admitted(*senders: tuple[str, float, float, float]) -> tuple[OneSender, list[str]]:
    """Admit messages of senders, each with its start, end and period [s]."""
    sent = []
    for name, start, end, period in senders:
        times = (start + period * number for number in count())
        for at in times:
            if at >= end:
                break
            sent.append((at, name))
    one = OneSender()
    return one, [name for at, name in sorted(sent) if one.admit(name, at)]


@pytest.mark.parametrize('period', [0.01, 1.0, 60.0, 3600.0])
@pytest.mark.parametrize('offset', [0.1, 0.5, 0.9])
def test_of_two_senders_one_is_followed_and_the_other_refused(
    period: float, offset: float
) -> None:
    one, names = admitted(
        ('phone', 0.0, 200 * period, period), ('other', offset * period, 200 * period, period)
    )
    assert names[:3] == ['phone', 'other', 'phone'], 'who is heard twice first is followed'
    assert set(names[2:]) == {'phone'}
    assert one.refused == {'other': 199}
    assert 'other' in one.problem
    assert '199 ' in one.problem
    assert one.current == 'phone'


@pytest.mark.parametrize('period', [0.01, 1.0, 60.0])
def test_a_silent_sender_gives_way(period: float) -> None:
    silence = max(2.0, 3.0 * period)
    _, names = admitted(
        ('gone', 0.0, 20.1 * period, period),
        ('phone', 20.5 * period, 20.5 * period + 3.0 * silence, period),
    )
    assert names[-1] == 'phone'
    lost = 3.0 * silence / period - names.count('phone')
    assert lost == pytest.approx(silence / period, abs=1.5)


def test_a_stray_message_does_not_keep_the_sensor_out() -> None:
    _, names = admitted(('stray', 0.0, 1e-3, 1.0), ('phone', 0.005, 1.0, 0.01))
    assert names.count('phone') == 100


def test_a_sender_of_a_new_port_each_time_is_one() -> None:
    one = OneSender()
    assert all(one.admit(f'10.0.0.2:{40000 + number}', number * 0.1) for number in range(500))
    assert one.problem == ''
    assert one.refused == {}


def test_an_outage_is_no_period() -> None:
    one = OneSender()
    for at in [*range(20), 3600.0]:
        assert one.admit('vane', at)
    assert one.patience == 3.0
    assert one.admit('other', 3604.0)
    assert one.current == 'other'


def test_several_messages_at_a_time_are_one_sender_between_them() -> None:
    _, names = admitted(
        *(('station', 0.01 * number, 3600.0, 60.0) for number in range(5)),
        ('other', 30.0, 3600.0, 60.0),
    )
    assert names.count('other') == 1, 'before the period is known'
    assert names[6:] == ['station'] * (5 * 59)


def test_the_counts_are_bounded() -> None:
    one = OneSender()
    one.admit('phone', 0.0)
    one.admit('phone', 0.01)
    for number in range(10_000):
        assert not one.admit(f'stranger {number}', 0.02 + 1e-5 * number)
    assert len(one.refused) <= 32
    assert one.total_refused == 10_000
    assert len(one.problem) < 200
