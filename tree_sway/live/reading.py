# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a message says: readings of a wind, or refusals of one."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from tree_sway.files.wind import Reading as Reading
from tree_sway.files.wind import Refusal as Refusal
from tree_sway.files.wind import WindReading as WindReading
from tree_sway.live.transports.transport import Message

Read = Callable[[Message], Sequence[Reading]]
"""What a message says; empty if it is not about the wind. Never raises."""
