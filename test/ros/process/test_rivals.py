# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from types import SimpleNamespace

import pytest

from tree_sway_ros.process import rivals


@pytest.fixture
def clock(monkeypatch):
    made = SimpleNamespace(now=0.0)
    monkeypatch.setattr(rivals, 'time', SimpleNamespace(monotonic=lambda: made.now))
    return made


def test_two_of_other_names_are_reported_at_once(clock):
    text = rivals.Rivals().warning('/wind', ['/player', '/anemometer'])
    assert text == '2 nodes publish /wind: /anemometer and /player; what they send mixes'


def test_a_node_that_was_started_again_is_no_second_one_until_its_ghost_is_gone(clock):
    looked = rivals.Rivals()
    for clock.now in (0.0, 10.0, 20.0):
        assert looked.warning('/wind', ['/anemometer', '/anemometer']) == ''
    assert looked.warning('/wind', ['/anemometer']) == ''
    clock.now = 30.0
    assert looked.warning('/wind', ['/anemometer', '/anemometer']) == ''
    clock.now += rivals.GHOST
    assert '2 nodes' in looked.warning('/wind', ['/anemometer', '/anemometer'])
