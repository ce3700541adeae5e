# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Sensors make no tree worse than the wind alone: not where they tell little of it either."""

from __future__ import annotations

import pytest
from tree_sway_lab.twin.gusty_truth import gusty_motion, mast_of, Outside
from tree_sway_lab.twin.trial import twin_score
from tree_sway_lab.twin.true_tree import Circumstances, sensor_places, tree_called, true_motion

from tree_sway.core.setup.threads import one_thread

MOST = 1.03
"""Largest error with sensors over that without [-]."""

KINDS = ('birch', 'willow', 'shrub', 'crooked', 'straight')


def errors(kind: str, seed: int, seconds: float, counts: tuple[int, ...]) -> list[float]:
    """Errors over those without sensors, with numbers of sensors."""
    tree, species = tree_called(kind)
    places = sensor_places(tree, max(counts))
    around = Circumstances(seconds=seconds, seed=seed)
    true = true_motion(tree, species, places, around, in_leaf=False, model=120)
    alone, *scores = (
        twin_score(tree, species, true, places[:count], in_leaf=False, has_band=False)
        for count in (0, *counts)
    )
    found = [each.error for each in scores]
    print(f'{kind} {seed}: {alone.error:.3f} without', *(f'{each:.3f}' for each in found))
    return [each / alone.error for each in found]


def test_a_sensor_on_the_stem_does_not_move_hanging_twigs_wrongly() -> None:
    with one_thread():
        assert max(errors('birch', 504, 60.0, (1,))) < MOST


@pytest.mark.long
@pytest.mark.parametrize('seed', range(51, 61))
@pytest.mark.parametrize('kind', KINDS)
def test_one_and_two_sensors_make_no_kind_worse(kind: str, seed: int) -> None:
    with one_thread():
        assert max(errors(kind, seed, 90.0, (1, 2))) < MOST


@pytest.mark.long
def test_a_sensor_on_a_limb_takes_nothing_from_one_on_the_stem() -> None:
    tree, species = tree_called('pine 12 2')
    places = ['stem:0.8', 'b188:0.5']
    outside = Outside(seconds=90.0, seed=941).drawn(tree)
    distance, bearing = mast_of(outside)
    with one_thread():
        true = gusty_motion(tree, species, places, outside, in_leaf=False)
        alone, one, two = (
            twin_score(
                tree, species, true, places[:count], in_leaf=False, has_band=False,
                anemometer_distance=distance, anemometer_bearing=bearing,
            ).error
            for count in (0, 1, 2)
        )  # fmt: skip
    print(f'{alone:.3f} without, {one:.3f}, {two:.3f}')
    assert one < 0.3 * alone
    assert two < 1.1 * one
