# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Shares of a city's trees that fall in storms: ``tree-sway risk`` beside published counts.

``street_trees.csv`` has species with their number, and medians of height and diameter [m];
``storm_losses.csv`` winds as stated [m/s], and the shares of trees that fell.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
import math
from pathlib import Path
from typing import Any

import numpy as np
from scipy.special import ndtr

from tree_sway.core.arrays import Floats
from tree_sway.forest import compute_kind, KindResult, risk_work, rows_of_kind
from tree_sway.tables import table_beside
from tree_sway_lab.validation.section import Check, Effort, markdown_table, Section
from tree_sway_lab.validation.sections.forestgales import inventory_with

Row = dict[str, Any]

TREES = table_beside(__file__, 'street_trees.csv')
STORMS = table_beside(__file__, 'storm_losses.csv')
TO_MEAN = {'gust': 1.0 / 1.53, 'minute': 0.9}
"""Mean of ten minutes over a wind, by how it is stated [-]."""
ONE_WIND, WISHED = 42.0 / 1.53, 22.5
"""Mean winds that fell the median tree by the baselines [m/s]."""
SPREAD = 0.33
"""Log-deviation of critical winds of the baselines."""
WITHIN_80 = 1.2816
"""Deviations on one side of the mean that hold 80 % on both."""
YEARS = 20.0, 200.0
_CRITICAL, _FALL = 'critical_wind_10m [m/s]', 'fall_in_50_years [%]'
_TEXT = Path(__file__).with_suffix('.md').read_text(encoding='utf-8')


def measure(effort: Effort) -> Section:
    """Compute the critical winds of the trees, and the shares that fall in each storm."""
    work = risk_work(inventory_with(TREES), exposure='street')
    results: list[KindResult] = effort.each(compute_kind, list(work.kinds))
    rows = sorted((row for each in results for row in rows_of_kind(work, each)), key=_line)
    leafed = [replace(each, seasons=each.seasons[:1]) for each in results]
    in_leaf = sorted((row for each in leafed for row in rows_of_kind(work, each)), key=_line)
    number = np.array([tree['number'] for tree in TREES])
    means = np.array([storm['wind'] * TO_MEAN[storm['averaging']] for storm in STORMS])
    shares = np.array([lost(in_leaf, number, mean) for mean in means])
    published = np.array([storm['share'] for storm in STORMS])
    is_seen = np.array([storm['seen'] for storm in STORMS])
    ratios = shares / published
    held_out = ratios[~is_seen]
    years = np.array([row['years'] for row in rows])
    within = float(np.mean((years >= YEARS[0]) & (years <= YEARS[1])))
    of_three = float(np.mean((held_out > 1.0 / 3.0) & (held_out < 3.0)))
    what = 'share that falls, computed over published'
    checks = [
        Check(f'storms that were not seen, {what}, median', float(np.median(held_out)), 0.5, 2.0),
        Check('storms that were not seen, share within a factor of 3', of_three, 0.6),
        Check(f'hurricanes that were seen, {what}, median', float(np.median(ratios[is_seen])),
              0.5, 2.0),
        Check('kinds whose median tree falls once in 20 to 200 years, share', within, 0.8),
    ]  # fmt: skip
    parts = _storms(means, shares), _trees(rows, in_leaf)
    return Section('Losses in storms', _TEXT, checks, '\n'.join(parts))


def lost(rows: Sequence[Row], number: Floats, wind: float) -> float:
    """Return the share of trees whose critical wind is below a mean wind [m/s]."""
    middle, low = (np.array([row[name] for row in rows]) for name in (_CRITICAL, 'low_80 [m/s]'))
    deviation = np.log(middle / low) / WITHIN_80
    return float(ndtr(np.log(wind / middle) / deviation) @ number / number.sum())


def _line(row: Row) -> int:
    return int(row['line'])


def _storms(means: Floats, shares: Floats) -> str:
    """Return a table of the storms, with both baselines."""
    head = ['storm', 'place', 'wind as stated', 'mean of ten minutes [m/s]', 'fell, published',
            'computed', 'computed over published', 'one wind, gusts of 42 m/s',
            'all at 22.5 m/s', 'seen', 'from']  # fmt: skip
    found = list[list[str]]()
    for storm, mean, share in zip(STORMS, means.tolist(), shares.tolist(), strict=True):
        one, wished = (float(ndtr(math.log(mean / wind) / SPREAD)) for wind in (ONE_WIND, WISHED))
        found.append([
            storm['storm'], storm['place'], storm['stated'], f'{mean:.1f}',
            f'{"at most " * storm["at_most"]}{_percent(storm["share"])}', _percent(share),
            f'{share / storm["share"]:.2f}', _percent(one), _percent(wished),
            'yes' if storm['seen'] else 'no', storm['source'],
        ])  # fmt: skip
    return markdown_table(head, found)


def _trees(rows: Sequence[Row], in_leaf: Sequence[Row]) -> str:
    """Return a table of the trees."""
    head = ['species', 'number', 'height [m]', 'diameter [m]', 'limited by', 'critical wind [m/s]',
            'in leaf [m/s]', 'of it, weakest of ten [m/s]', 'years, inland',
            _FALL, 'assumed']  # fmt: skip
    found = [
        [
            tree['species'], str(tree['number']), f'{tree["height"]:g}', f'{tree["diameter"]:.2f}',
            row['limited_by'], f'{row[_CRITICAL]:.0f}', f'{leafed[_CRITICAL]:.0f}',
            f'{leafed["low_80 [m/s]"]:.0f}', f'{row["years"]:g}', f'{row[_FALL]:g}',
            row['assumed'],
        ]
        for tree, row, leafed in zip(TREES, rows, in_leaf, strict=True)
    ]  # fmt: skip
    return markdown_table(head, found)


def _percent(share: float) -> str:
    return f'{float(f"{100.0 * share:.2g}"):g} %'
