# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Prepared models in the cache on disk: programs choose it, the library by itself does not."""

from __future__ import annotations

from tree_sway.cache import MODELS
from tree_sway.core.model import PREPARED


def use_disk_cache() -> None:
    """Find models that are prepared from now on again, also in later processes."""
    PREPARED.behind = MODELS
