# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Kinds of trees from another generator: error, roughness and the first frame after a step."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
import itertools
import math

import numpy as np

from tree_sway_lab.kinds.kinds import FLEXIBLE, kind_called, KINDS, SLENDER
from tree_sway_lab.validation.section import Check, Effort, markdown_table, Section
from tree_sway_lab.validation.trial import judged_simulator, SECONDS, Trial, tried
from tree_sway_lab.validation.truth import FINE, Fineness, QUICK, true_frequencies

SPEEDS = ('3', '9', '15')
"""Mean speeds of turbulence in [m/s]."""

WINDS = (*SPEEDS, 'seconds', 'step', 'up', 'reversal')
GALE = '80'
FINELY = (*SPEEDS, 'step')
"""Winds in which the truth is the fine one."""
MODELS = ('default', 'full')

JUDGED = (
    *(kind for kind in KINDS if kind not in ('crooked', 'straight', *SLENDER)),
    'crooked 8',
    'crooked 18',
    'crooked 32',
    'straight 1',
)
"""Kinds of the page; a full run takes a second seed of each."""

ERRORS = {'default': (0.03, 0.04, 0.05), 'full': (0.02, 0.03, 0.04)}
"""Largest errors in turbulence of `SPEEDS`."""

FLEXIBLE_ERRORS = (0.04, 0.06, 0.1)
"""The same where twigs hang or whip."""
ROUGHNESS = (0.8, 1.2)
FIRST_FRAME = 2e-3
MODES = 20
LIMBS = tuple(f'limbs{count}' for count in (2, 4, 8, 16, 32))


def measure(effort: Effort) -> Section:
    """Try the default model and the one of all coordinates on every kind in every wind."""
    kinds = list(JUDGED)
    if effort.is_full:
        kinds += [f'{kind} 2' for kind in JUDGED if ' ' not in kind]
    found = [one for part in effort.each(tried_all, kinds) for one in part]
    checks = [check for model in MODELS for check in _checks(model, found)]
    modes = effort.each(partial(mode_errors, 'full'), LIMBS)
    checks.append(
        Check(
            f'`full`, stems with 2 to 32 limbs, modes 1 to {MODES}, largest relative error',
            max(float(np.abs(each).max()) for each in modes),
            high=0.01,
        )
    )
    text = (
        f'Error over motion, roughness and first frame against every segment solved ({FINE}; '
        f'{QUICK} in all winds but turbulence up to 15 m/s and the step), with weight and twist, '
        f'in {SECONDS:g} s of each wind, or as long as the truth follows the tips; seeds are 1 '
        'where no other is given. '
        "Roughness is the second difference of all tips over the truth's, root mean square. "
        'Winds: turbulence of 3, 9 and 15 m/s; `seconds`: means of 1 s of 9 m/s; `step`: 5 to 10 '
        'm/s in one frame; `up`: 6 m/s straight up; `reversal`: 8 to -8 m/s within 1 s.'
    )
    return Section('Trees of another making', text, checks, trial_table(found))


def tried_all(kind: str) -> list[Trial]:
    """Try the models on a kind in every wind."""
    cases = itertools.product(MODELS, (*WINDS, GALE))
    return [tried(kind, wind, model, FINE if wind in FINELY else QUICK) for model, wind in cases]


def trial_table(trials: Sequence[Trial]) -> str:
    """Return a table of trials in Markdown."""
    head = (
        'tree', 'wind', 'model', 'error', 'roughness',
        'first frame, true [mm]', 'largest move, true [mm]', 'lowest tip, true [mm]',
        'clamped', 'step and place [us]',
    )  # fmt: skip
    rows = [
        (
            one.kind, one.wind, one.model, f'{one.error:.3f}',
            f'{one.roughness:.2f}', _both(one.jump, one.true_jump),
            _both(one.stride, one.true_stride), _both(one.lowest, one.true_lowest),
            str(one.clamped), f'{one.cost:.1f}',
        )
        for one in sorted(trials, key=lambda one: (one.kind, one.model, one.wind.rjust(9)))
    ]  # fmt: skip
    return markdown_table(head, rows)


def mode_errors(model: str, kind: str, fineness: Fineness = FINE) -> np.ndarray:
    """Relative errors of the lowest `MODES` frequencies of a model, or of as many as it has."""
    tree = kind_called(kind)
    mine = judged_simulator(model, tree).frequencies(MODES)  # type: ignore[attr-defined]
    return np.asarray(mine / true_frequencies(tree, MODES, fineness)[: len(mine)] - 1.0)


def _checks(model: str, found: Sequence[Trial]) -> list[Check]:
    mine = [one for one in found if one.model == model]
    checks = []
    for where, limits in (('', ERRORS[model]), (' where twigs hang or whip', FLEXIBLE_ERRORS)):
        of = [one for one in mine if one.kind.startswith(FLEXIBLE) == bool(where)]
        for speed, limit in zip(SPEEDS, limits, strict=True):
            most = max(one.error for one in of if one.wind == speed)
            checks.append(Check(f'`{model}`, {speed} m/s, largest error{where}', most, high=limit))
        rough = [one.roughness for one in of if one.wind != GALE]
        checks += [
            Check(f'`{model}`, {name} roughness{where}', value, *ROUGHNESS)
            for name, value in (('least', min(rough)), ('largest', max(rough)))
        ]
    checks += [
        Check(
            f"`{model}`, first frame after a step beyond the truth's, largest [mm]",
            max(1e3 * abs(one.jump - one.true_jump) for one in mine if one.wind == 'step'),
            high=1e3 * FIRST_FRAME,
        ),
        Check(
            f"`{model}`, {GALE} m/s, largest move of a tip in a frame over the truth's",
            max(one.stride / one.true_stride for one in mine if one.wind == GALE),
            high=1.1,
        ),
    ]
    return checks


def _both(mine: float, true: float) -> str:
    return '-' if math.isnan(mine) else f'{1e3 * mine:.1f}, {1e3 * true:.1f}'
