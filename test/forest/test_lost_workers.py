# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A worker that is ended is reported, whether it did its work or had just done it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from tree_sway.forest.lost_workers import told_lost_workers


class Client:
    """A client whose scheduler reports what a test says."""

    hear: Callable[[tuple[float, Any]], None]

    def subscribe_topic(self, _topic: str, hear: Callable[[tuple[float, Any]], None]) -> None:
        """Give events to a function."""
        self.hear = hear

    def unsubscribe_topic(self, _topic: str) -> None:
        """Give it none any more."""


@pytest.mark.parametrize(
    ('had', 'is_told'),
    [
        ({'processing-tasks': ['a']}, True),
        ({'processing-tasks': [], 'lost-computed-tasks': ['b']}, True),
        ({'processing-tasks': ['c'], 'lost-computed-tasks': []}, False),
        ({}, False),
    ],
)
def test_a_worker_that_had_work_is_reported(
    had: dict[str, list[str]], is_told: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    client = Client()
    with told_lost_workers(client, ['a', 'b']):
        client.hear((0.0, {'action': 'remove-worker', 'worker': 'tls://here', **had}))
    assert capsys.readouterr().err.count('a worker was ended') == is_told
