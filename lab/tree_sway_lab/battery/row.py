# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""One line of the battery's report."""

from __future__ import annotations

from dataclasses import dataclass

PASS, FAIL = 'pass', 'FAIL'
REPRODUCED, NOT_REPRODUCED = 'failure reproduced', 'FAILURE NOT SEEN'


@dataclass(frozen=True)
class Row:
    """
    What was tried, what must hold, what was measured, and the verdict.

    Parameters
    ----------
    case
        The case and the method.
    must_hold
        The bound, or the failure that is to be seen.
    measured
        The figure.
    verdict
        "pass", "FAIL", "failure reproduced" or "FAILURE NOT SEEN".

    """

    case: str
    must_hold: str
    measured: str
    verdict: str

    @property
    def good(self) -> bool:
        """Whether the row is as it should be."""
        return self.verdict in (PASS, REPRODUCED)


def holds(case: str, must_hold: str, measured: str, is_met: bool) -> Row:
    """Row of something that must hold."""
    return Row(case, must_hold, measured, PASS if is_met else FAIL)


def fails(case: str, failure: str, measured: str, seen: bool) -> Row:
    """Row of a known failure that must be seen."""
    return Row(case, failure, measured, REPRODUCED if seen else NOT_REPRODUCED)
