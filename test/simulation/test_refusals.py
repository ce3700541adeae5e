# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a simulation refuses before its first step, with a cure."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.core.tree import tree_from_segments
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


@pytest.mark.parametrize(
    ('wind', 'options'),
    [
        (np.full((3, 3), np.nan), {}),
        (np.full((3, 3), 1000.0), {}),
        (np.ones((3, 2)), {}),
        (np.ones((3, 3)), {'seconds': -1.0}),
        (np.ones((3, 3)), {'rate': 0.0}),
        (np.ones((3, 3)), {'branches': ['stem']}),
    ],
)
def test_what_is_wrong_is_said_before_the_tree_is_set_up(fork, monkeypatch, wind, options):
    def set_up(*_: object) -> None:
        raise AssertionError

    monkeypatch.setattr('tree_sway.simulation.rig.TreeReductions', set_up)
    with pytest.raises(ParameterError):
        simulate(fork(), wind, model=2, **options)


class Table:
    """A data frame, whose columns have names."""

    columns = ('time', 'speed', 'direction')

    def __array__(self, *_: object, **__: object) -> np.ndarray:
        return np.array([[0.0, 5.0, 90.0], [0.1, 5.0, 90.0]])


def test_columns_with_names_are_not_taken_for_east_north_and_up(fork):
    with pytest.raises(ParameterError, match=r'wind: .*time, speed, direction.*to_numpy'):
        simulate(fork(), Table(), model=2)
    with pytest.raises(ParameterError, match=r'start: .*time, speed, direction.*to_numpy'):
        tree_from_segments(Table(), np.ones((2, 3)), [0.1, 0.1])


def test_steps_whose_wind_was_refused_are_told(fork):
    record = simulate(
        fork(), [[5, 0, 0], [60, 0, 0], [5, 0, 0]], model=2, rate=60.0, max_wind=40.0
    )
    (note,) = record.notes
    assert note.startswith('the wind of 1 of 3 steps was refused, faster than 40 m/s')


def test_a_record_shows_its_notes_where_it_is_looked_at(fork):
    record = simulate(fork(), np.ones((6, 3)), model=2, seconds=100.0)
    assert 'note: the wind has 0.1 s of the 100 s' in repr(record)
    assert 'note' not in str(record)


@pytest.mark.parametrize('branches', ['stem', ['b1'], [0.5], 3])
def test_branches_that_are_no_numbers_are_refused(fork, branches):
    with pytest.raises(ParameterError, match='not numbers of branches'):
        simulate(fork(), np.zeros((3, 3)), model=2, branches=branches)


@pytest.mark.parametrize('rate', ['3', b'3', [1.0], {}, 1j], ids=repr)
def test_a_rate_that_is_no_number_is_named(fork, rate):
    with pytest.raises(ParameterError, match='is not a number'):
        simulate(fork(), np.zeros((60, 3)), model=2, rate=rate)


@pytest.mark.parametrize('motion', [3, 'a'])
def test_what_is_no_motion_is_refused(fork, motion):
    with pytest.raises(ParameterError):
        simulate(fork(), np.zeros((9, 3)), model=2, motion=motion)
