# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""True errors over the ladder's estimates of them, in winds that are hard on an estimate."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np

from tree_sway_ros.files.wind.wind_file import read_wind
from tree_sway_ros.study.validation.crooked_trees import crooked_tree
from tree_sway_ros.study.validation.judge import Judge, Verdict
from tree_sway_ros.study.validation.section import Check, Effort, markdown_table, Section
from tree_sway_ros.study.validation.sections.models import MORE_SEEDS, SEEDS
from tree_sway_ros.study.validation.winds import from_record, hard_cases, turbulent

RECORD = 'wind/sonic_20hz_1245.toa5.dat'
"""Of a sonic anemometer, in the folder of data."""

_PIECES, _SUBSTEPS = 2, 4


def measure(effort: Effort) -> Section:
    """Run all models in gusts, steps, turns, a sine at the first frequency, and a record."""
    seeds = SEEDS + (MORE_SEEDS if effort.is_full else ())
    seconds = 8.0 if effort.is_full else 5.0
    record = effort.data / RECORD if effort.data and (effort.data / RECORD).is_file() else None
    found = effort.each(partial(_judged, seconds=seconds, record=record), seeds)
    verdicts = [one for each in found for one in each if np.isfinite(one.over_estimate)]
    over = [one.over_estimate for one in verdicts]
    winds = list(dict.fromkeys(one.wind for one in verdicts))
    rows = [
        [
            each[0].tree,
            *(f'{max(v.over_estimate for v in each if v.wind == w):.2f}' for w in winds),
        ]
        for each in ([v for v in part if np.isfinite(v.over_estimate)] for part in found)
    ]
    text = (
        'True error over estimated error of every model of the ladder, sets with branches frozen '
        f'among them, in {seconds:g} s of each wind; truth in {_PIECES} pieces at '
        f'{60 * _SUBSTEPS} Hz. The table has the largest ratio of each tree and wind.'
    )
    checks = [
        Check('largest true error over its estimate', max(over), high=1.0),
        Check('median of true error over its estimate', float(np.median(over)), low=0.3),
        Check(
            'share of errors beyond their estimate', float(np.mean(np.array(over) > 1.0)), high=0.0
        ),
    ]
    return Section('Estimates of errors', text, checks, markdown_table(['tree', *winds], rows))


def _judged(seed: int, seconds: float, record: Path | None) -> list[Verdict]:
    judge = Judge(crooked_tree(seed), pieces=_PIECES, substeps=_SUBSTEPS)
    winds = {'7 m/s': turbulent(7.0, seconds, seed)}
    winds |= hard_cases(seconds, judge.first_frequency)
    if record is not None:
        blown = read_wind(record)
        winds |= {
            f'record x{scale:g}': from_record(blown.time, blown.velocity, seconds, scale)
            for scale in (1.0, 3.0)
        }
    return judge.verdicts(winds)
