# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The cases where methods of integration fail: how many rows are as they should be."""

from __future__ import annotations

from functools import partial

from tree_sway_lab.battery.report import CASES, load_case
from tree_sway_lab.validation.section import Check, Effort, markdown_table, Section


def measure(effort: Effort) -> Section:
    """Run the battery."""
    found = dict(
        zip(CASES, effort.each(partial(_run, is_full=effort.is_full), CASES), strict=True)
    )
    failed = sum(rows - good for _, rows, good in found.values())
    rows = [
        [name, title, str(rows), str(rows - good)] for name, (title, rows, good) in found.items()
    ]
    text = 'Cases of `tree-sway lab battery`: what must hold does, and known failures are seen.'
    checks = [Check('rows that are not as they should be', failed, high=0.0)]
    head = ['case', 'what it is', 'rows', 'wrong']
    return Section('Stability of methods', text, checks, markdown_table(head, rows))


def _run(name: str, is_full: bool) -> tuple[str, int, int]:
    case = load_case(name)
    rows = case.run(is_full)
    return case.TITLE, len(rows), sum(row.good for row in rows)
