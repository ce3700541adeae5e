# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import math

import numpy as np
import pytest

from tree_sway.core.checks import three_numbers, within
from tree_sway.errors import ParameterError


@pytest.mark.parametrize('value', [0, 1, 0.5, True, np.float32(0.25), np.int64(1)])
def test_a_number_in_the_range_comes_back_as_float(value):
    number = within('x', value, 0.0, 1.0)
    assert type(number) is float
    assert number == value


@pytest.mark.parametrize('value', [-0.1, 1.1, math.nan, math.inf, -math.inf, 10**400])
def test_anything_else_is_refused_with_the_range(value):
    with pytest.raises(ParameterError, match=r'x: .* is out of range; use 0 to 1 m'):
        within('x', value, 0.0, 1.0, 'm')


@pytest.mark.parametrize('value', ['one', '3', None, [1.0], 1j])
def test_what_is_no_number_is_named_with_the_range(value):
    with pytest.raises(ParameterError, match=r'x: .* is not a number; use 0 to 1 m'):
        within('x', value, 0.0, 1.0, 'm')


def test_the_lower_end_can_be_excluded():
    assert within('x', 0.0, 0.0, 1.0) == 0.0
    with pytest.raises(ParameterError, match=r'use above 0, up to 1$'):
        within('x', 0.0, 0.0, 1.0, above=True)


@pytest.mark.parametrize('vector', [(1, 2, 3), [1.0, 2.0, 3.0], np.array([1.0, 2.0, 3.0])])
def test_three_numbers(vector):
    assert three_numbers('wind', vector) == (1.0, 2.0, 3.0)


def test_three_numbers_need_not_be_finite():
    x, y, z = three_numbers('wind', (math.nan, math.inf, 1e300))
    assert math.isnan(x)
    assert (y, z) == (math.inf, 1e300)


@pytest.mark.parametrize(
    'vector', [1.0, (1, 2), (1, 2, 3, 4), np.eye(3), 'abc', None, (1, 2, 10**400)]
)
def test_what_is_not_three_numbers_is_refused(vector):
    with pytest.raises(ParameterError, match=r'wind: .* is not three numbers'):
        three_numbers('wind', vector)


@pytest.mark.parametrize(
    ('high', 'above', 'allowed'),
    [
        (5.0, False, '0 to 5 s'),
        (5.0, True, 'above 0, up to 5 s'),
        (math.inf, False, 'at least 0 s'),
        (math.inf, True, 'above 0 s'),
    ],
)
def test_a_refused_number_is_told_its_range(high: float, above: bool, allowed: str) -> None:
    with pytest.raises(ParameterError) as error:
        within('x', -1.0, 0.0, high, 's', above=above)
    assert error.value.cure == f'use {allowed}'
