# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Which changes of a worker are reported, and how often."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from tree_sway.forest.lost_workers import told_lost_workers

Hear = Callable[[tuple[float, Any]], None]


class Events:
    """What a Dask client offers to hear about its scheduler."""

    def __init__(self) -> None:
        self.hear: Hear | None = None

    def subscribe_topic(self, _topic: str, hear: Hear) -> None:
        self.hear = hear

    def unsubscribe_topic(self, _topic: str) -> None:
        self.hear = None

    def lose(self, *tasks: str, action: str = 'remove-worker') -> None:
        assert self.hear is not None
        self.hear((0.0, {'action': action, 'worker': 'tcp://a', 'processing-tasks': {*tasks}}))


@pytest.mark.parametrize('n_lost', [0, 1, 3])
def test_a_lost_worker_is_reported_once_and_all_are_counted(
    n_lost: int, capsys: pytest.CaptureFixture[str]
) -> None:
    events = Events()
    with told_lost_workers(events, ['case 1', 'case 2']):
        for _ in range(n_lost):
            events.lose('case 2', 'of somebody else')
        events.lose()
        events.lose('of somebody else')
        events.lose('case 1', action='add-worker')
        assert events.hear is not None
        events.hear((0.0, 'another event'))
    assert events.hear is None
    said = capsys.readouterr().err
    assert said.count('a worker was ended') == min(n_lost, 1)
    assert ('3 workers were ended' in said) == (n_lost > 1)
