# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import threading

import pytest

from tree_sway.errors import ParameterError
from tree_sway_ros.timing import handshake
from tree_sway_ros.timing.handshake import Answers, Audience, Reach, required


def test_topics_with_and_without_a_number():
    assert required('wind wind/filtered /clock:2') == {'wind': 1, 'wind/filtered': 1, '/clock': 2}
    assert required('') == {}
    for wrong in ('wind:two', ':2'):
        with pytest.raises(ParameterError, match='names no topic and number'):
            required(wrong)


def test_an_audience_is_there_once_all_have_listened_for_a_while(monkeypatch):
    now, here, said = [100.0], {'wind': 1, '/clock': 1}, []
    monkeypatch.setattr(handshake.time, 'monotonic', lambda: now[0])
    audience = Audience({'wind': 1, '/clock': 2}, here.__getitem__, said.append)
    assert not audience.is_there()
    assert not audience.is_there()
    assert said == ['waiting for subscribers of /clock (1 of 2)']
    here['/clock'] = 2
    assert not audience.is_there()
    now[0] += handshake.SETTLING
    assert audience.is_there()
    here['wind'] = 0
    assert not audience.is_there()
    assert Audience({}, here.__getitem__, said.append).is_there()


def test_what_was_answered_is_waited_for_no_longer():
    answers = Answers(10, patience=30.0)
    assert answers.wait()
    answers.sent(5_000)
    threading.Timer(0.02, answers.heard, [4_990]).start()
    assert answers.wait()
    assert answers.missing == 0


def test_an_answer_may_lag_by_the_slack_and_a_step():
    answers = Answers(10, patience=0.0)
    answers.heard(1_000)
    answers.heard(1_100)
    answers.sent(1_210)
    assert answers.wait()
    answers.sent(1_211)
    assert not answers.wait()


def test_what_is_never_answered_is_waited_for_once_until_something_is_heard():
    answers = Answers(0, patience=0.01)
    for time, missing in ((5_000, 1), (6_000, 1)):
        answers.sent(time)
        assert not answers.wait()
        assert answers.missing == missing
    answers.heard(6_000)
    assert answers.wait()
    answers.sent(20_000)
    assert not answers.wait()
    assert answers.missing == 2


def test_the_last_is_sent_again_until_its_own_answer_comes():
    answers, sent = Answers(100, patience=30.0), []
    answers.heard(1_000)
    answers.heard(1_010)
    answers.sent(1_050)

    def send(time):
        sent.append(time)
        if len(sent) == 3:
            threading.Thread(target=answers.heard, args=[1_045]).start()

    assert answers.wait()  # within the slack
    answers.end(send)
    assert sent == [1_050] * 3
    Answers(0, patience=0.0).end(send)
    deaf = Answers(0, patience=0.01)
    deaf.sent(5_000)
    deaf.end(sent.append)
    assert set(sent[3:]) == {5_000}


MS = 1_000_000


def test_samples_that_go_ahead_are_waited_for():
    reach, coming = Reach(patience=30.0), [1100, 1150]
    reach.add(1000 * MS)
    reach.add(1050 * MS)
    reach.wait(1140 * MS, lambda: reach.add(coming.pop(0) * MS), lambda: 0)
    assert coming == []


@pytest.mark.parametrize('stamps', [[], [1000], [1000, 2000]])
def test_those_before_and_after_a_gap_are_not(stamps):
    reach, taken = Reach(patience=30.0), []
    for stamp in stamps:
        reach.add(stamp * MS)
    reach.wait(5000 * MS, lambda: taken.append(1), lambda: 0)
    assert taken == [1]


@pytest.mark.parametrize(('patience', 'clock'), [(0.01, 0), (30.0, 2451)])
def test_a_sample_that_never_comes_is_waited_for_once(patience, clock):
    """Until the clock goes on without it, or all patience is at its end."""
    reach, taken = Reach(patience), []
    for stamp in (1000, 1050):
        reach.add(stamp * MS)
    reach.wait(2000 * MS, lambda: None, lambda: clock * MS)
    reach.wait(2000 * MS, lambda: taken.append(1), lambda: 0)
    assert taken == [1]


def test_a_wait_ends_with_the_node():
    reach = Reach(patience=30.0)
    for stamp in (1000, 1050):
        reach.add(stamp * MS)
    threading.Timer(0.02, reach.end).start()
    reach.wait(2000 * MS, lambda: None, lambda: 0)
    assert reach._newest == 1050 * MS
