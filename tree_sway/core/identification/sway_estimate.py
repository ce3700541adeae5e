# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a record of a swaying tree says of one sway, whichever way it was found."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar


@dataclass(frozen=True)
class SwayEstimate:
    """
    One sway: undamped frequency [Hz], damping ratio with the air's, and standard errors of both.

    `kind` is that of the record, ``release`` or ``ambient``; the answer rests on a number of
    cycles.
    """

    kind: ClassVar[str] = ''
    frequency: float
    damping_ratio: float
    frequency_error: float
    damping_error: float
    cycles: float
