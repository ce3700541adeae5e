# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Sway in steady winds that lean a tree by 10, 20 and 30 % of its height."""

from __future__ import annotations

from tree_sway_ros.study.validation.crooked_trees import crooked_tree
from tree_sway_ros.study.validation.judge import Judge, SWAYS
from tree_sway_ros.study.validation.section import Check, Effort, markdown_table, Section
from tree_sway_ros.study.validation.sections.models import MORE_SEEDS, SEEDS

LIMITS = (0.02, 0.04, 0.08)


def measure(effort: Effort) -> Section:
    """Compare the steady sway of `coupled` with the truth's."""
    seeds = SEEDS + MORE_SEEDS if effort.is_full else SEEDS[:3]
    found = dict(zip(seeds, effort.each(_swayed, seeds), strict=True))
    checks = [
        Check(
            f'sway of {share:.0%} of the height, largest relative error'.replace('%', ' %'),
            max(abs(each[k]) for each in found.values()),
            high=limit,
        )
        for k, (share, limit) in enumerate(zip(SWAYS, LIMITS, strict=True))
    ]
    rows = [
        [crooked_tree(seed).name, *(f'{each:+.3f}' for each in errors)]
        for seed, errors in found.items()
    ]
    text = (
        "Sway of the highest tip under `coupled` over the truth's, less 1, in a steady wind that "
        'leans the tree by these shares of its height; truth in 2 pieces.'
    )
    head = ['tree', *(f'{share:.0%}'.replace('%', ' %') for share in SWAYS)]
    return Section('Steady sway', text, checks, markdown_table(head, rows))


def _swayed(seed: int) -> list[float]:
    return Judge(crooked_tree(seed), pieces=2, substeps=4).steady_sway()
