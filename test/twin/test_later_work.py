# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Work that is due later is found in parts or beside, and used at the same step."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tree_sway.twin.later_work import LaterWork, Submit
from tree_sway.worker import submit_beside


def parts(n: int) -> Iterator[str | None]:
    yield from [None] * n
    yield 'found'


@pytest.mark.parametrize('submit', [None, submit_beside])
@pytest.mark.parametrize('n_parts', [0, 3, 50])
def test_a_result_is_returned_when_it_is_due(n_parts: int, submit: Submit | None) -> None:
    work = LaterWork(parts(n_parts), 10, submit)
    assert [work.advance() for _ in range(10)] == [None] * 9 + ['found']


def test_a_failure_beside_the_steps_is_raised_when_the_result_is_due() -> None:
    def failing() -> Iterator[str | None]:
        yield None
        raise ArithmeticError

    work = LaterWork(failing(), 2, submit_beside)
    assert work.advance() is None
    with pytest.raises(ArithmeticError):
        work.advance()
