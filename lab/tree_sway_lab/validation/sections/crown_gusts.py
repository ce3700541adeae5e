# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Background, peak and slope of the strain of grown trees, in the open and in a stand."""

from __future__ import annotations

from functools import partial

import numpy as np

from tree_sway.core.settings import Settings
from tree_sway.core.wind.gusts import USUAL_COHERENCE
from tree_sway_lab.validation.gust_response import (
    CLEAR_PEAK,
    gust_response,
    GustCase,
    GustResponse,
    SPECIES,
)
from tree_sway_lab.validation.section import Check, Effort, markdown_table, Section

DEFAULT = Settings.crown_coherence
SHARES = {'open': (0.64, 0.71), 'stand': (0.45, 0.55)}
"""Share of the variance below 0.6 f1 in records, by site."""
SLOPES = {'open': (-6.0, -4.0), 'stand': (-5.5, -1.6)}
"""Slope above f1 in records, by site: medians of groups, and nine tenths of 47 conifers."""
CLEAR = 175.0 / 237.0
"""Share of records with a clear peak."""


def measure(effort: Effort) -> Section:
    """Let eight trees sway at two sites; in full, also in gusts that meet limb after limb."""
    coherences = (DEFAULT, USUAL_COHERENCE) if effort.is_full else (DEFAULT,)
    cases = [
        GustCase(species, site, coherence)
        for coherence in coherences
        for site in SHARES
        for species in SPECIES
    ]
    seconds = 1200.0 if effort.is_full else 600.0
    responses = effort.each(partial(gust_response, seconds=seconds), cases)
    found: dict[GustCase, GustResponse] = dict(zip(cases, responses, strict=True))
    checks = []
    for site in SHARES:
        of_site = [found[GustCase(species, site, DEFAULT)] for species in SPECIES]
        share = float(np.mean([each.share for each in of_site]))
        slope = float(np.median([each.slope for each in of_site]))
        clear = float(np.mean([each.has_clear_peak for each in of_site]))
        checks += [
            Check(f'{site}, share of the variance below 0.6 f1, mean', share, *SHARES[site]),
            Check(f'{site}, slope above f1, median', slope, *SLOPES[site]),
            Check(f'{site}, share of trees with a clear peak', clear, CLEAR),
        ]
    rows = [
        [case.species, case.exposure, f'{case.coherence:g}', f'{each.first:.2f}',
         f'{each.share:.2f}', f'{each.slope:.1f}', f'{each.peak:.1f}']
        for case, each in found.items()
    ]  # fmt: skip
    text = (
        f'Strain at the base of grown trees in leaf, mean of along and across the wind, in '
        f'{seconds:g} s of 7 m/s at the reference height of the site, with the turbulence of the '
        f'site, by 20 coordinates. Checked is the default (`crown_coherence` {DEFAULT:g}); '
        f'`--full` adds {USUAL_COHERENCE:g}. One-hour records of Jackson et al. (2021) have 0.45 '
        '(broadleaves) and 0.55 (conifers) of the variance below 0.6 f1 in forests and 0.64 to '
        '0.71 in the open, slopes of -2.5 to -2.6 and of -4 to -6, and a clear peak in 175 of '
        '237. A peak is '
        f'clear here with {CLEAR_PEAK:g} times the least power between 0.3 and 0.9 f1. By this '
        'very estimator records of strain alone have a clear peak in 56 of 68 in forests and 6 '
        'of 7 in the open, and 0.65 and 0.83 of the variance below 0.6 f1 where only what is '
        'slower than 10 minutes is left out, as gauges drift. Crowns of a stand touch.'
    )
    head = ['species', 'site', 'coherence', 'f1 [Hz]', 'share below 0.6 f1', 'slope', 'peak']
    title = 'Gusts and the strain of the stem'
    return Section(title, text, checks, markdown_table(head, rows))
