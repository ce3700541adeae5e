# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""True errors over the estimates of them, in winds that are hard on an estimate."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.scene import make_simulator
from tree_sway.core.setup import prepare
from tree_sway.core.tree import tips_of_poses
from tree_sway.fidelity import AdaptiveSimulator, dialled, REVIEW, WindClimate
from tree_sway.files.wind import read_wind
from tree_sway_lab.kinds.kinds import kind_called
from tree_sway_lab.tip_error import record_tips
from tree_sway_lab.validation.section import Check, Effort, markdown_table, Section
from tree_sway_lab.validation.trial import SECONDS
from tree_sway_lab.validation.truth import QUICK, SETTINGS, true_frequencies, true_tips, WOOD
from tree_sway_lab.validation.winds import FRAME, from_record, turbulent, wind_called

WINDS = ('3', '9', '15', 'step', 'up', 'reversal', 'turn', 'sine')
JUDGED = (
    'willow', 'birch', 'limbs8', 'limbs32', 'spire', 'palm', 'leaning', 'shrub', 'candelabra',
    'whips', 'crooked 1', 'crooked 8', 'crooked 32', 'straight 1',
)  # fmt: skip
LIVE = ('crooked 1', 'palm')
TOLERANCES = (0.005, 0.001)
"""Tolerances of `auto` in [m]."""

RECORD = 'wind/sonic_20hz_1245.toa5.dat'
"""Record of a sonic anemometer, in the folder of data."""

_SPELLS, _SPELL = (4.0, 9.0, 4.0), 20.0


class Judged(NamedTuple):
    """One number of coordinates on a kind in a wind: true error over estimated in [-]."""

    kind: str
    wind: str
    coordinates: int
    over: float


def measure(effort: Effort) -> Section:
    """Run every number of coordinates in all winds, and hold its error against the estimate."""
    record = effort.data / RECORD if effort.data and (effort.data / RECORD).is_file() else None
    cases = [(kind, record) for kind in JUDGED]
    found = dict(zip(JUDGED, effort.each(judged, cases), strict=True))
    all_over = np.array([one.over for each in found.values() for one in each])
    winds = list(dict.fromkeys(one.wind for each in found.values() for one in each))
    rows = [
        [kind, *(f'{max(one.over for one in each if one.wind == wind):.2f}' for wind in winds)]
        for kind, each in found.items()
    ]
    running = [(kind, tolerance) for kind in LIVE for tolerance in TOLERANCES]
    reported = dict(zip(running, effort.each(live, running), strict=True))
    live_rows = [
        [kind, f'{1e3 * tolerance:g} mm', f'{np.median(over):.2f}', f'{over.max():.2f}']
        for (kind, tolerance), over in reported.items()
    ]
    text = (
        'True error over estimated error of every number of coordinates that `auto` shows of '
        f'all it has, in {SECONDS:g} s of each wind, straight up among them; truth: every '
        f'segment, {QUICK}. The table has the largest ratio of each tree and wind. Live is what '
        f'`auto` reports as it runs through {_SPELL:g} s each of {_SPELLS[0]:g}, {_SPELLS[1]:g} '
        f'and {_SPELLS[2]:g} m/s, against the truth in each {REVIEW:g} s: it covers the gusts of '
        'the last minute and those that may come before the next look, so that it is too large '
        'for a while once the wind has fallen.'
    )
    checks = [
        Check('largest true error over its estimate', float(all_over.max()), high=1.0),
        Check('median of true error over its estimate', float(np.median(all_over)), low=0.3),
        Check('share of errors beyond their estimate', float(np.mean(all_over > 1.0)), high=0.0),
        Check(
            'live, largest true error over what `auto` reports',
            max(float(over.max()) for over in reported.values()),
            high=1.0,
        ),
    ]
    return Section(
        'Estimates of errors', text, checks, markdown_table(['tree', *winds], rows) + '\n'
        + markdown_table(['tree, live', 'tolerance', 'median', 'largest'], live_rows),
    )  # fmt: skip


def judged(case: tuple[str, Path | None]) -> list[Judged]:
    """Judge every number of coordinates on one kind in all winds."""
    kind, record = case
    tree = kind_called(kind)
    winds = {name: wind_called(name, SECONDS) for name in WINDS[:-1]}
    first = float(true_frequencies(tree, 1, QUICK)[0])
    winds['sine'] = wind_called(f'sine {first:.3f}', SECONDS)
    if record is not None:
        blown = read_wind(record)
        winds |= {
            f'record x{scale:g}': from_record(blown.time, blown.velocity, SECONDS, scale)
            for scale in (3.0,)
        }
    auto = AdaptiveSimulator(prepare(tree, WOOD, SETTINGS))
    shown = make_simulator(tree, WOOD, SETTINGS)
    oscillators = dialled(shown.banks[0])
    hidden = np.zeros(shown.banks[0].oscillators.shapes.shape[1])
    found = []
    for name, wind in winds.items():
        truth = true_tips(tree, wind, QUICK)
        for estimate in auto.estimates(WindClimate.of_samples(wind, 1.0 / FRAME)):
            count = estimate.n_coordinates
            shown.reset()
            oscillators.show(hidden, count)
            apart = record_tips(shown, tree, wind[: len(truth)], FRAME) - truth
            metres = float(np.sqrt(np.square(apart).sum(axis=2).mean()))
            found.append(Judged(kind, name, count, metres / estimate.error))
    return found


def live(case: tuple[str, float]) -> Floats:
    """Return true error over what `auto` reports, in each review of a run in 4, 9 and 4 m/s."""
    kind, tolerance = case
    tree = kind_called(kind)
    wind = np.vstack([turbulent(mean, _SPELL, 1 + k) for k, mean in enumerate(_SPELLS)])
    truth = true_tips(tree, wind, QUICK)
    auto = AdaptiveSimulator(prepare(tree, WOOD, SETTINGS), tolerance=tolerance)
    squares = np.empty((2, len(wind)))
    poses = np.empty((tree.n_segments, 7))
    for frame, blowing in enumerate(wind):
        auto.step(blowing, FRAME)
        apart = tips_of_poses(tree, auto.place(poses)) - truth[frame]
        squares[:, frame] = np.square(apart).sum(axis=1).mean(), auto.choice.error**2
    frames = round(REVIEW / FRAME)
    true, reported = squares[:, : len(wind) // frames * frames].reshape(2, -1, frames).mean(axis=2)
    out: Floats = np.sqrt(true / reported)
    return out
