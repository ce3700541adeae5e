# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The paper's planar problem of every branch, and what it refuses."""

from __future__ import annotations

import numpy as np
import pytest
from tree_sway_lab.paper.key_segments import key_segments

from tree_sway.core.species.species import species_named
from tree_sway.errors import ParameterError

WEST = (-1.0, 0.0, 0.0)


def test_planes_hold_chord_and_wind(fork):
    tree = fork()
    keys = key_segments(tree, species_named('broadleaf'), WEST, 1e4, 10.0)
    assert np.linalg.norm(keys.across, axis=1) == pytest.approx(1.0)
    assert np.sum(keys.along * keys.across, axis=1) == pytest.approx(0.0, abs=1e-12)
    pressure = np.linalg.norm(keys.load, axis=1)[:, None]
    wind = keys.load[:, :1] * keys.along + keys.load[:, 1:] * keys.across
    assert wind / pressure == pytest.approx(np.tile(WEST, (tree.n_branches, 1)), abs=1e-12)


def test_constants_scale_frequency_and_damping(fork):
    rows = [
        key_segments(fork(), species_named('broadleaf'), WEST, k1, k2)
        for k1, k2 in ((1e4, 10.0), (4e4, 10.0), (1e4, 20.0))
    ]
    assert rows[1].frequency == pytest.approx(2.0 * rows[0].frequency)
    assert rows[1].damping_ratio == pytest.approx(0.5 * rows[0].damping_ratio)
    assert rows[2].damping_ratio == pytest.approx(2.0 * rows[0].damping_ratio)


def test_a_branch_along_the_wind_feels_no_moment(stem):
    tree = stem(direction=WEST)
    keys = key_segments(tree, species_named('broadleaf'), WEST, 1e4, 10.0)
    assert keys.load[0, 1] == 0.0
    assert np.linalg.norm(keys.across[0]) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ('direction', 'k1', 'k2', 'words'),
    [
        ((0.0, 0.0, 0.0), 1.0, 1.0, 'wind direction'),
        (WEST, 0.0, 1.0, 'k1 constant 0'),
        (WEST, 1.0, float('nan'), 'k2 constant nan'),
    ],
)
def test_what_has_no_meaning_is_refused(stem, direction, k1, k2, words):
    with pytest.raises(ParameterError, match=words):
        key_segments(stem(), species_named('broadleaf'), direction, k1, k2)
