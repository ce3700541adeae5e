# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Work beside the steps is used at the same step, however long it takes."""

from __future__ import annotations

import os
import threading
from typing import NoReturn

import pytest

from tree_sway.twin.later_work import LaterWork


@pytest.mark.parametrize('is_slow', [False, True])
def test_a_result_is_returned_when_it_is_due(is_slow: bool) -> None:
    asked = threading.Event()

    def find() -> str:
        assert not is_slow or asked.wait(60.0)
        return 'found'

    work = LaterWork(find, 10)
    assert [work.advance() for _ in range(9)] == [None] * 9
    asked.set()
    assert work.advance() == 'found'


def test_a_failure_beside_the_steps_is_raised_when_the_result_is_due() -> None:
    def failing() -> NoReturn:
        raise ArithmeticError

    work = LaterWork(failing, 2)
    assert work.advance() is None
    with pytest.raises(ArithmeticError):
        work.advance()


@pytest.mark.skipif(not hasattr(os, 'fork'), reason='no processes by fork')
@pytest.mark.filterwarnings('ignore:.*fork:DeprecationWarning')
def test_a_forked_process_has_a_thread_of_its_own() -> None:
    assert LaterWork(lambda: 0, 1).advance() == 0
    if not (child := os.fork()):
        threading.Timer(60.0, os._exit, [1]).start()
        os._exit(LaterWork(lambda: 0, 1).advance() or 0)
    assert os.waitpid(child, 0)[1] == 0


@pytest.mark.skipif(not hasattr(os, 'fork'), reason='no processes by fork')
@pytest.mark.filterwarnings('ignore:.*fork:DeprecationWarning')
def test_a_forked_process_finds_what_its_parent_had_begun() -> None:
    asked, parent = threading.Event(), os.getpid()

    def find() -> int:
        assert os.getpid() != parent or asked.wait(60.0)
        return 7

    work = LaterWork(find, 1)
    if not (child := os.fork()):
        threading.Timer(30.0, os._exit, [1]).start()
        os._exit(work.advance() or 0)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7
    asked.set()
    assert work.advance() == 7
