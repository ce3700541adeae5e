# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The cache of a tree that was set up, so that it sways sooner the next time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol


class SetUpCache(Protocol):
    """Set-ups by their digests, on disk or wherever the caller has them."""

    def read(self, digest: str) -> dict[str, Any] | None:
        """Arrays by name, as they were written under this digest; None if there are none."""

    def write(self, digest: str, arrays: Mapping[str, Any]) -> None:
        """Keep arrays, or leave it."""
