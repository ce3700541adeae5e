# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Hanging, whippy and reed-like trees in storms: error, roughness, lowest tip, largest move."""

from __future__ import annotations

from tree_sway_lab.kinds.kinds import FLEXIBLE, SLENDER
from tree_sway_lab.validation.section import Check, Effort, Section
from tree_sway_lab.validation.sections.kinds import trial_table
from tree_sway_lab.validation.trial import SECONDS, Trial, tried
from tree_sway_lab.validation.truth import FINE, Fineness, FINER

WINDS = ('20', '25', '30', '40')
JUDGED_IN = '25'
"""Wind in which error and roughness have limits."""

FOLDED_IN = '40'
"""Wind that folds twigs of a willow within a piece, so that the coarser truth flings them."""

SEEDS = (1, 101)
ERROR, ROUGHNESS = 0.2, (0.7, 1.5)
LOWER, FURTHER = 0.05, 2.0
"""Most that a tip is below the lowest of the truth [m], and its largest move over the truth's."""


def measure(effort: Effort) -> Section:
    """Try the default model on limp kinds in turbulence of storms."""
    seeds = (*SEEDS, 102, 103) if effort.is_full else SEEDS
    kinds = [f'{kind} {seed}' for kind in (*FLEXIBLE, *SLENDER) for seed in seeds]
    parts = effort.each(tried_in_storms, kinds)
    found = [one for part in parts for one in part]
    text = (
        f'The default model against every segment solved ({FINE}; {FINER} for the willow in '
        f'{FOLDED_IN} m/s, whose twigs fold within a piece) in {SECONDS:g} s of turbulence '
        f'with a mean of {", ".join(WINDS)} m/s, or as long as the truth follows the tips. '
        'Willow, birch and whips; bamboo, shoots of one year and reeds, each of two seeds. '
        'Columns are those of `kinds`.'
    )
    return Section('Limp trees in storms', text, checks(found), trial_table(found))


def tried_in_storms(kind: str) -> list[Trial]:
    """Try the default model on a kind in every wind."""
    return [tried(kind, wind, 'default', fineness_for(kind, wind)) for wind in WINDS]


def fineness_for(kind: str, wind: str) -> Fineness:
    """Choose the fineness at which the truth about a kind in a wind has converged."""
    return FINER if kind.startswith('willow') and wind == FOLDED_IN else FINE


def checks(found: list[Trial]) -> list[Check]:
    """Check trials: errors and roughness in one wind, places and moves of tips in all."""
    judged = [one for one in found if one.wind == JUDGED_IN]
    rough = [one.roughness for one in judged]
    lower = max(one.true_lowest - one.lowest for one in found)
    further = max(one.stride / one.true_stride for one in found)
    return [
        Check(f'{JUDGED_IN} m/s, largest error', max(one.error for one in judged), high=ERROR),
        Check(f'{JUDGED_IN} m/s, least roughness', min(rough), *ROUGHNESS),
        Check(f'{JUDGED_IN} m/s, largest roughness', max(rough), *ROUGHNESS),
        Check("a tip below the truth's lowest, largest [m]", lower, high=LOWER),
        Check("largest move of a tip in a frame over the truth's", further, high=FURTHER),
    ]
