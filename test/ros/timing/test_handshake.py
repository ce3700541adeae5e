# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import threading

import pytest

from tree_sway_ros.errors import ParameterError
from tree_sway_ros.ros.timing import handshake
from tree_sway_ros.ros.timing.handshake import Answers, Audience, required


def test_topics_with_and_without_a_number():
    assert required("wind wind/filtered /clock:2") == {"wind": 1, "wind/filtered": 1, "/clock": 2}
    assert required("") == {}
    for wrong in ("wind:two", ":2"):
        with pytest.raises(ParameterError, match="names no topic and number"):
            required(wrong)


def test_an_audience_is_there_once_all_have_listened_for_a_while(monkeypatch):
    now, here, said = [100.0], {"wind": 1, "/clock": 1}, []
    monkeypatch.setattr(handshake.time, "monotonic", lambda: now[0])
    audience = Audience({"wind": 1, "/clock": 2}, here.__getitem__, said.append)
    assert not audience.is_there()
    assert not audience.is_there()
    assert said == ["waiting for subscribers of /clock (1 of 2)"]
    here["/clock"] = 2
    assert not audience.is_there()
    now[0] += handshake.SETTLING
    assert audience.is_there()
    here["wind"] = 0
    assert not audience.is_there()
    assert Audience({}, here.__getitem__, said.append).is_there()


def test_what_came_back_is_waited_for_no_longer():
    answers = Answers(patience=30.0)
    assert answers.wait()
    answers.sent(5_000_000_000)
    threading.Timer(0.02, answers.heard, [5_000_000_100]).start()
    assert answers.wait()
    assert answers.missing == 0


def test_what_never_comes_back_is_waited_for_once():
    answers = Answers(patience=0.01)
    answers.sent(5_000_000_000)
    assert not answers.wait()
    assert answers.wait()
    assert answers.missing == 1
