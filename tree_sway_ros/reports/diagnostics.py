# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The state of a node for `/diagnostics`: a level, a sentence and some values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

OK = 0
WARN = 1
ERROR = 2


@dataclass(frozen=True)
class Status:
    """One line of a report of a part, as ``wind``: level, a sentence, and figures by name."""

    name: str
    level: int
    message: str
    values: Mapping[str, object] = field(default_factory=dict)


def status_array(statuses: list[Status], *, prefix: str, hardware: str, stamp: Any) -> Any:
    """Make a DiagnosticArray of some statuses."""
    message = DiagnosticArray()
    message.header.stamp = stamp
    for status in statuses:
        item = DiagnosticStatus()
        item.level = bytes([status.level])
        item.name = f'{prefix}: {status.name}'
        item.message = status.message
        item.hardware_id = hardware
        item.values = [
            KeyValue(key=str(key), value=_text(value)) for key, value in status.values.items()
        ]
        message.status.append(item)
    return message


def _text(value: object) -> str:
    return f'{value:.6g}' if isinstance(value, float) else str(value)
