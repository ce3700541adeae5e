# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway plot --from``: the wind of a picture comes from where it is said to."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.commands import plot
from tree_sway.commands.cli import main

SHORT = ['plot', 'benjamina', '--model', 'branch', '--seconds', '0.5', '--speed', '8']


def mean_wind(monkeypatch, tmp_path, *options):
    """Mean wind of a drawn motion, (3,)."""
    seen = []
    monkeypatch.setattr(plot, 'plot_wind_and_tip', lambda _t, wind, *_a, **_k: seen.append(wind))
    assert main([*SHORT, *options, '-o', str(tmp_path / 'sway.png')]) == 0
    return seen[0].mean(axis=0)


def test_from_the_east_it_blows_to_the_west(monkeypatch, tmp_path):
    west = mean_wind(monkeypatch, tmp_path, '--from', '90')
    east = mean_wind(monkeypatch, tmp_path)
    assert west[0] < -4.0
    assert west[:2] == pytest.approx(-east[:2], abs=1e-9)


def test_a_portrait_leans_away_from_the_wind(monkeypatch, tmp_path):
    seen = []
    monkeypatch.setattr(plot, '_SETTLING', 2.0)
    monkeypatch.setattr(plot, 'picture_in_wind', lambda _t, _p, wind, *_a, **_k: seen.append(wind))
    main([*SHORT, '--portrait', '--from', '180', '-o', str(tmp_path / 'tree.png')])
    assert seen[0] == pytest.approx(np.array([0.0, 8.0, 0.0]), abs=1e-9)


@pytest.mark.parametrize('options', [['--from', '400'], ['--from', '90', '--wind', 'canopy']])
def test_no_direction_and_one_for_a_record_are_refused(options, tmp_path):
    arguments = [*SHORT, *options, '-o', str(tmp_path / 'sway.png')]
    assert main(arguments) != 0
