# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a record of a swaying tree says of one sway, whichever way it was found."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar


@dataclass(frozen=True)
class SwayEstimate:
    """
    One sway; `kind` is that of the record, ``release`` or ``ambient``.

    Parameters
    ----------
    frequency
        Natural frequency, undamped, in [Hz].
    damping_ratio
        Share of critical damping in [-], that of the air included.
    frequency_error, damping_error
        Their standard errors.
    cycles
        How many cycles the answer rests on.

    """

    kind: ClassVar[str] = ""
    frequency: float
    damping_ratio: float
    frequency_error: float
    damping_error: float
    cycles: float
