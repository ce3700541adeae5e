# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a step of a simulator says of itself."""

from __future__ import annotations

from typing import Final


class Outcome:
    """Bits of the result of a step, a plain number; `OK` without any."""

    OK: Final = 0
    WIND_REFUSED: Final = 1
    """The wind was not finite or too fast: the last one was used."""
    LOAD_CLAMPED: Final = 2
    """A load beyond the limit of the model was clamped."""
    RESTARTED: Final = 4
    """The motion was not finite and continued from rest."""
