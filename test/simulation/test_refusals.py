# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a simulation refuses before its first step, with a cure."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.errors import ParameterError
from tree_sway.simulation.rig import simulate


@pytest.mark.parametrize('wind', ['wind.csv', 'canopy', [['a', 'b', 'c']], [[1.0], [2.0, 3.0]]])
def test_what_is_no_wind_is_refused_with_a_cure(fork, wind):
    with pytest.raises(ParameterError, match=r'no wind; open a file by read_wind'):
        simulate(fork(), wind, model=2)


@pytest.mark.parametrize('wind', [5.0, np.nan, np.zeros((5, 7)), [[1.0, 2.0]]])
def test_a_wind_of_another_shape_is_refused(fork, wind):
    with pytest.raises(ParameterError, match=r'wind (of shape|that is not finite)'):
        simulate(fork(), wind, model=2)


@pytest.mark.parametrize('branches', ['stem', ['b1'], [0.5], 3])
def test_branches_that_are_no_numbers_are_refused(fork, branches):
    with pytest.raises(ParameterError, match='not numbers of branches'):
        simulate(fork(), np.zeros((3, 3)), model=2, branches=branches)


@pytest.mark.parametrize('rate', ['3', None, b'3', [1.0], {}, 1j], ids=repr)
def test_a_rate_that_is_no_number_is_named(fork, rate):
    with pytest.raises(ParameterError, match='is not a number'):
        simulate(fork(), np.zeros((60, 3)), model=2, rate=rate)


@pytest.mark.parametrize('motion', [3, 'a'])
def test_what_is_no_motion_is_refused(fork, motion):
    with pytest.raises(ParameterError):
        simulate(fork(), np.zeros((9, 3)), model=2, motion=motion)
