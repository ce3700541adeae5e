# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""True errors over the ladder's estimates of them, in winds that are hard on an estimate."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.core.fidelity.adaptive import AdaptiveSimulator, REVIEW
from tree_sway_ros.core.reference.measure import tips_of_poses
from tree_sway_ros.files.wind.wind_file import read_wind
from tree_sway_ros.study.tip_error import record_tips
from tree_sway_ros.study.validation.crooked_trees import crooked_tree
from tree_sway_ros.study.validation.judge import Judge, SETTINGS, Verdict, WOOD
from tree_sway_ros.study.validation.section import Check, Effort, markdown_table, Section
from tree_sway_ros.study.validation.sections.models import MORE_SEEDS, SEEDS
from tree_sway_ros.study.validation.winds import FRAME, from_record, hard_cases, turbulent

TOLERANCES = (0.005, 0.001)
"""Of `auto` in [m]."""

_SPELLS, _SPELL = (4.0, 9.0, 4.0), 20.0

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
    cases = [(seed, tolerance) for seed in SEEDS for tolerance in TOLERANCES]
    told = effort.each(_live_of, cases)
    live = [
        [
            each.tree,
            f'{1e3 * tolerance:g} mm',
            f'{np.median(each.over):.2f}',
            f'{max(each.over):.2f}',
        ]
        for (_, tolerance), each in zip(cases, told, strict=True)
    ]
    text = (
        'True error over estimated error of every model of the ladder, sets with branches frozen '
        f'among them, in {seconds:g} s of each wind; truth in {_PIECES} pieces at '
        f'{60 * _SUBSTEPS} Hz. The table has the largest ratio of each tree and wind. Live is '
        f'what `auto` tells as it runs through {_SPELL:g} s each of '
        f'{_SPELLS[0]:g}, {_SPELLS[1]:g} and {_SPELLS[2]:g} m/s, against the truth in each '
        f'{REVIEW:g} s: it covers the gusts of the last minute and those that may come before '
        'the next look, so that it is told too large for a while once the wind has fallen.'
    )
    checks = [
        Check('largest true error over its estimate', max(over), high=1.0),
        Check('median of true error over its estimate', float(np.median(over)), low=0.3),
        Check(
            'share of errors beyond their estimate', float(np.mean(np.array(over) > 1.0)), high=0.0
        ),
        Check(
            'live, largest true error over what `auto` tells',
            max(float(each.over.max()) for each in told),
            high=1.0,
        ),
    ]
    return Section(
        'Estimates of errors', text, checks, markdown_table(['tree', *winds], rows) + '\n'
        + markdown_table(['tree, live', 'tolerance', 'median', 'largest'], live),
    )  # fmt: skip


class _Told(NamedTuple):
    """What `auto` told of its error in each review of a run, the truth over it in [-]."""

    tree: str
    over: Floats


def _live_of(case: tuple[int, float]) -> _Told:
    """Let `auto` run in 4, 9 and 4 m/s, and hold what it tells against the truth."""
    seed, tolerance = case
    judge = Judge(crooked_tree(seed), pieces=_PIECES, substeps=_SUBSTEPS)
    wind = np.vstack([turbulent(mean, _SPELL, seed + k) for k, mean in enumerate(_SPELLS)])
    truth = record_tips(judge.truth, judge.tree, wind, FRAME, substeps=_SUBSTEPS)
    auto = AdaptiveSimulator(judge.tree, WOOD, SETTINGS, tolerance=tolerance)
    squares = np.empty((2, len(wind)))
    poses = np.empty((judge.tree.n_segments, 7))
    for frame, blowing in enumerate(wind):
        auto.step(blowing, FRAME)
        apart = tips_of_poses(judge.tree, auto.place(poses)) - truth[frame]
        squares[:, frame] = np.square(apart).sum(axis=1).mean(), auto.choice.error**2
    frames = round(REVIEW / FRAME)
    true, told = squares[:, : len(wind) // frames * frames].reshape(2, -1, frames).mean(axis=2)
    return _Told(judge.tree.name, np.sqrt(true / told))


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
