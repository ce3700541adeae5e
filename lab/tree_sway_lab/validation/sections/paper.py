# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The experiment of Kanda & Ohya in its three forms."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import numpy as np

from tree_sway.core.species import species_named
from tree_sway.growth import builtin_tree
from tree_sway_lab.paper.experiment import (
    CONSTANTS,
    measured_share,
    run_experiment,
    wind_from_the_right,
)
from tree_sway_lab.validation.section import Check, Effort, markdown_table, Section


class _Figures(NamedTuple):
    segments: int
    per_branch: float
    share: float
    angle: float
    reaction: float


def measure(effort: Effort) -> Section:
    """Solve both plants by multipliers, in the reduced form and by the propagator."""
    seconds = 6.0 if effort.is_full else 1.0
    found = dict(
        zip(CONSTANTS, effort.each(partial(_run, seconds=seconds), CONSTANTS), strict=True)
    )
    checks = [
        Check('multipliers against the reduced form, largest angle [rad]',
              max(each.angle for each in found.values()), high=1e-5),
        Check('the same, joint reaction over the largest',
              max(each.reaction for each in found.values()), high=1e-5),
        Check('time of all segments over that of key segments, least',
              min(each.share for each in found.values()), low=5.0),
    ]  # fmt: skip
    rows = [
        [name, str(f.segments), f'{f.per_branch:.1f}', f'{f.share:.1f}', f'{f.angle:.1e}',
         f'{f.reaction:.1e}']
        for name, f in found.items()
    ]  # fmt: skip
    text = (
        f'`tree-sway lab paper`: whole plants in {seconds:g} s of gusty wind of 3 m/s from the'
        " right, their key segments with multipliers (the paper's equation 1) and in the reduced"
        ' form. The'
        ' paper has about six segments per branch and a sixth of the work.'
    )
    head = ['plant', 'segments', 'per branch', 'time ratio', 'angle [rad]', 'reaction']
    return Section("The paper's experiment", text, checks, markdown_table(head, rows))


def _run(plant: str, seconds: float) -> _Figures:
    tree, speed = builtin_tree(plant), wind_from_the_right(3.0, seconds)
    run = run_experiment(tree, species_named(tree.species), speed, *CONSTANTS[plant])
    one, other = run.solutions['multipliers'], run.solutions['reduced']
    counts = np.diff(tree.branch_first)
    return _Figures(
        tree.n_segments,
        float(counts[counts > 1].mean()),
        measured_share(tree, run.keys, speed),
        float(np.abs(one.angle - other.angle).max()),
        float(np.abs(one.reaction - other.reaction).max() / np.abs(other.reaction).max()),
    )
