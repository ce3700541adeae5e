# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The section on ForestGALES: what it compares, by winds that are known."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.validation.section import Effort
from tree_sway_lab.validation.sections import forestgales
from tree_sway_lab.validation.sections.forestgales import inventory_with, measure, TREES

from tree_sway.forest.risk_kind import KindResult, RiskKind, SeasonCurves
from tree_sway.simulation.critical_wind import ShareCurve
from tree_sway.simulation.exposure import Exposure
from tree_sway.simulation.strength_band import root_band, wood_band


def curve_to(critical: float, used: float) -> ShareCurve:
    """Return a curve by the square of the wind that is used up at a critical one [m/s]."""
    speed = np.array([10.0, 40.0])
    return ShareCurve(speed, (speed / critical) ** 2 / used)


def result_of(kind: RiskKind) -> KindResult:
    """Return what breaks every tree of a kind at 15 m/s and overturns it at 18 m/s."""
    wood, roots = (float(band(in_leaf=True)[0]) for band in (wood_band, root_band))
    curves = SeasonCurves(True, curve_to(15.0, wood), curve_to(18.0, roots))
    exposure = Exposure(kind.exposure, kind.height, 0.18 * kind.height)
    return KindResult(kind, (curves,), kind.slenderness, exposure)


def test_the_table_has_what_the_program_writes() -> None:
    sample = [tree for tree in TREES if tree['source'] == 'sample']
    assert len(sample) == 1000
    assert len(TREES) == 1017
    inventory = inventory_with(TREES)
    assert not any('not in the table' in note for note in inventory.notes)
    np.testing.assert_allclose(inventory.diameter, [tree['diameter'] for tree in TREES])


def test_one_wind_for_all_is_no_better_than_one_wind(monkeypatch: pytest.MonkeyPatch) -> None:
    """The spread of a model with one critical wind is that of the baseline."""
    few = [tree for tree in TREES if tree['source'] == 'rotation'][:3]
    few += [tree for tree in TREES if tree['source'] == 'sample'][:3]
    monkeypatch.setattr(forestgales, 'TREES', few)
    monkeypatch.setattr(forestgales, 'compute_kind', result_of)
    section = measure(Effort(lambda function, items: [function(item) for item in items]))
    medians = {check.what: check.measured for check in section.checks if 'median' in check.what}
    published = [tree['breaks'] for tree in few[:3]]
    stated = medians['stands, wind that breaks, ours over `fg_rou`, median']
    assert stated == pytest.approx(15.0 / np.median(published), rel=0.02)
    for check in section.checks:
        if 'spread' in check.what:
            assert check.measured == pytest.approx(check.high, rel=0.1)
    assert section.table.count('| rotation |') == 3
