# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What is shown while a command works: nothing for short waits, a bar or lines for long ones."""

from __future__ import annotations

import io
import sys
import time

import pytest

from tree_sway.commands import progress


class Terminal(io.StringIO):
    """A terminal that remembers what was written."""

    def isatty(self) -> bool:
        return True


def test_a_short_wait_shows_nothing(capsys: pytest.CaptureFixture[str]) -> None:
    assert list(progress.bar(range(5), 'working')) == [0, 1, 2, 3, 4]
    with progress.waiting('working'):
        pass
    assert capsys.readouterr().err == ''


def test_a_long_wait_without_a_terminal_shows_a_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(progress, 'PATIENCE', 0.0)
    before = set(progress.threading.enumerate())
    for _ in progress.bar(range(3), 'working'):
        for thread in set(progress.threading.enumerate()) - before:
            thread.join()
    assert capsys.readouterr().err == 'working ...\n'


def test_longer_work_without_a_terminal_tells_what_is_left(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    now = iter([0.0, 12.0, 20.0, 31.0, 42.0])
    monkeypatch.setattr(progress.time, 'monotonic', lambda: next(now))
    with progress.counting(50, 'working') as tell:
        for done in (1, 5, 20, 31):  # the first took eleven seconds to set up
            tell(done)
    assert capsys.readouterr().err == (
        'working: 1 of 50\nworking: 20 of 50, about 30 s left\n'
        'working: 31 of 50, about 19 s left\n'
    )


def test_a_long_wait_on_a_terminal_shows_a_bar(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip('tqdm')
    terminal = Terminal()
    monkeypatch.setattr(sys, 'stderr', terminal)
    monkeypatch.setattr(sys, '__stderr__', terminal)
    monkeypatch.setattr(progress, 'PATIENCE', 0.0)
    assert list(progress.bar(range(3), 'working')) == [0, 1, 2]
    assert 'working:' in terminal.getvalue()
    assert '/3' in terminal.getvalue()


def test_what_counts_by_itself_is_shown_as_a_bar(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip('tqdm')
    terminal = Terminal()
    monkeypatch.setattr(sys, 'stderr', terminal)
    monkeypatch.setattr(sys, '__stderr__', terminal)
    monkeypatch.setattr(progress, 'PATIENCE', 0.0)
    end = time.monotonic() + 20.0
    with progress.counting(3, 'setting up') as tell:
        while '2/3' not in terminal.getvalue():  # drawn anew after a tenth of a second
            assert time.monotonic() < end, terminal.getvalue()
            tell(2)
    with progress.counting(1, 'alone') as tell:
        tell(1)
    assert 'alone:' not in terminal.getvalue()


def test_a_wait_that_is_not_counted_is_reported(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(progress, 'PATIENCE', 0.0)
    before = set(progress.threading.enumerate())
    with progress.waiting('calibrating') as nothing:
        for thread in set(progress.threading.enumerate()) - before:
            thread.join()
    assert nothing is None
    assert capsys.readouterr().err == 'calibrating ...\n'
