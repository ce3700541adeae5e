# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import threading

import pytest

from tree_sway import worker
from tree_sway.errors import TransportError
from tree_sway.worker import Worker


class Stuck(Worker):
    """Work that does not end before `may_end`."""

    def __init__(self):
        super().__init__('stuck')
        self.may_end, self.begun = threading.Event(), 0

    def _run(self):
        self.begun += 1
        while not self._stopping.is_set():
            self.may_end.wait(10.0)


def test_a_start_does_not_revive_work_that_was_stopped(monkeypatch):
    monkeypatch.setattr(worker, '_PATIENCE', 0.05)
    made = Stuck()
    made.start()
    old = made._thread
    made.stop()
    assert old.is_alive()
    with pytest.raises(TransportError, match='has not ended'):
        made.start()
    made.may_end.set()
    old.join(10.0)
    assert not old.is_alive()
    made.start()
    made.stop()
    assert made.begun == 2
