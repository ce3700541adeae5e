# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A browser for tests of the page."""

from __future__ import annotations

from collections.abc import Callable, Iterator
import functools

import pytest
from tree_sway_lab.browser import Browser, Chromium, chromium


@pytest.fixture(scope='session')
def one_chromium() -> Iterator[Chromium]:
    """Start one Chromium for all tests of a process: each opens a page with storage of its own."""
    if chromium() is None:
        pytest.skip('chromium is not installed here')
    made = Chromium()
    yield made
    made.close()


@pytest.fixture
def browser_class(one_chromium: Chromium) -> Callable[[], Browser]:
    """`Browser`, where there is a Chromium; without a graphics card every pixel costs time."""
    return functools.partial(Browser, one_chromium, scale=0.5)
