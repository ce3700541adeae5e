# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""How response spectra of grown trees fall above their first frequency."""

from __future__ import annotations

from functools import partial

from tree_sway_ros.core.wind.crown_wind import USUAL_COHERENCE
from tree_sway_ros.study.validation.response_slopes import response_slopes, Slopes, SPECIES
from tree_sway_ros.study.validation.section import Check, Effort, markdown_table, Section

STEEPEST, FLATTEST = -6.2, -2.0


def measure(effort: Effort) -> Section:
    """Measure slopes with gusts limb by limb and in one wind for the whole crown."""
    cases = [
        (species, in_leaf, share)
        for species in SPECIES
        for in_leaf in (False, True)
        for share in (USUAL_COHERENCE, 1.0)
    ]
    seconds = 1200.0 if effort.is_full else 400.0
    found = dict(zip(cases, effort.each(partial(_sloped, seconds=seconds), cases), strict=True))
    checks = [
        Check(
            f'{species}, {"in leaf" if in_leaf else "bare"}, {name}',
            found[species, in_leaf, USUAL_COHERENCE].strain[k],
            STEEPEST,
            FLATTEST,
        )
        for species in SPECIES
        for in_leaf in (False, True)
        for k, name in enumerate(('along the wind', 'across it'))
    ]
    rows = [
        [species, 'on' if in_leaf else 'off', *(_cell(found[species, in_leaf, s], part)
         for part in ('strain', 'tip') for s in (USUAL_COHERENCE, 1.0))]
        for species in SPECIES for in_leaf in (False, True)
    ]  # fmt: skip
    text = (
        'Slope in logarithms of the power spectrum between 1.3 and 3.5 times the first frequency, '
        f'along the wind and across it, in {seconds:g} s of simulated wind of 7 m/s; checked is '
        'the strain of the stem at its base with gusts that meet the crown limb by limb '
        f'(`crown_coherence` {USUAL_COHERENCE:g}), as strain is what was measured on real trees: '
        '-5.5 to -1.6 in nine tenths of 47 conifers, -5.3 to -0.5 of 21 broadleaved trees in '
        'forests (one-hour records of Jackson et al. 2021, fitted in the same way). The '
        'highest tip tells of the limb that bears it too.'
    )
    head = ['species', 'leaves', 'strain', 'in one wind', 'tip', 'in one wind']
    return Section('Slopes of response spectra', text, checks, markdown_table(head, rows))


def _sloped(case: tuple[str, bool, float], seconds: float) -> Slopes:
    species, in_leaf, share = case
    return response_slopes(species, coherence=share, in_leaf=in_leaf, seconds=seconds)


def _cell(slopes: Slopes, part: str) -> str:
    return ', '.join(f'{each:.1f}' for each in getattr(slopes, part))
