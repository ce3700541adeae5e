# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The section on losses in storms: shares by critical winds that are known."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.validation.section import Effort
from tree_sway_lab.validation.sections import storm_losses
from tree_sway_lab.validation.sections.storm_losses import lost, measure, STORMS, TREES

from tree_sway.forest.risk_kind import KindResult, RiskKind, SeasonCurves
from tree_sway.simulation.critical_wind import ShareCurve
from tree_sway.simulation.exposure import Exposure


def result_of(kind: RiskKind) -> KindResult:
    """Return what fells every tree of a kind at 30 m/s in leaf and at 60 m/s bare."""
    speed = np.array([20.0, 40.0])
    seasons = tuple(
        SeasonCurves(in_leaf, *2 * [ShareCurve(speed, (speed / critical) ** 2)])
        for in_leaf, critical in ((True, 30.0), (False, 60.0))
    )
    exposure = Exposure('open', kind.height, anemometer_height=10.0)
    return KindResult(kind, seasons, kind.slenderness, exposure)


def test_the_city_loses_the_share_of_each_kind_below_the_wind() -> None:
    rows = [
        {'critical_wind_10m [m/s]': wind, 'low_80 [m/s]': wind * np.exp(-1.2816 * 0.3)}
        for wind in (20.0, 40.0)
    ]
    number = np.array([3.0, 1.0])
    assert lost(rows, number, 20.0) == pytest.approx(0.75 * 0.5 + 0.25 * 0.01043, abs=1e-4)
    assert lost(rows, number, 20.0 * np.exp(0.3)) == pytest.approx(
        0.75 * 0.8413 + 0.25 * 0.0951, abs=1e-3
    )


def test_storms_meet_leaves_and_the_published_shares_are_judged(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(storm_losses, 'compute_kind', result_of)
    section = measure(Effort(lambda function, items: [function(item) for item in items]))
    held_out, within, seen, years = section.checks
    assert held_out.measured > 2.0  # at 30 m/s far more trees would fall than did
    assert not held_out.holds
    assert within.measured < 1.0
    assert seen.measured > 4.0
    assert 0.0 <= years.measured <= 1.0
    assert section.table.count('\n') == len(STORMS) + len(TREES) + 5
    assert all(0.0 < storm['share'] < 0.3 for storm in STORMS)
