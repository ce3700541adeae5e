# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A browser for tests of the page."""

from __future__ import annotations

import pytest
from tree_sway_lab.browser import Browser, chromium


@pytest.fixture
def browser_class() -> type[Browser]:
    """`Browser`, where there is a Chromium."""
    if chromium() is None:
        pytest.skip('chromium is not installed here')
    return Browser
