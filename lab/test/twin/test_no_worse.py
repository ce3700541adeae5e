# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Sensors make no tree worse than the wind alone: not where they tell little of it either."""

from __future__ import annotations

import pytest
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
