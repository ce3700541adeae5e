# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Parents before what they carry; circles are left out."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from tree_sway.core.tree.parents_first import parents_first


def test_generation_by_generation() -> None:
    assert parents_first([2, 0, -1, 2, 3]) == [2, 0, 3, 1, 4]


def test_a_circle_and_what_hangs_on_it_are_left_out() -> None:
    assert parents_first([-1, 2, 1, 2]) == [0]
    assert parents_first([]) == []


@given(st.data())
def test_every_parent_comes_first(data: st.DataObject) -> None:
    size = data.draw(st.integers(1, 40))
    drawn = [data.draw(st.integers(-1, number - 1)) for number in range(size)]
    named = data.draw(st.permutations(range(size)))
    parents = [-1] * size
    for number, parent in enumerate(drawn):
        parents[named[number]] = named[parent] if parent >= 0 else -1
    order = parents_first(parents)
    assert sorted(order) == list(range(size))
    place = {number: k for k, number in enumerate(order)}
    assert all(place[parents[n]] < place[n] for n in range(size) if parents[n] >= 0)
