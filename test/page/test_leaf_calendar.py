# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Leaves over the year."""

from dataclasses import replace

import numpy as np
import pytest

from tree_sway.core.leaves.foliage import foliage_of
from tree_sway.core.species.species import SPECIES
from tree_sway.errors import ParameterError
from tree_sway.growth.growing import grow
from tree_sway.page.leaf_calendar import is_bare, leaf_share, species_in_month
from tree_sway.page.session import Choices

OAK = SPECIES['oak']


@pytest.mark.parametrize('key', ['oak', 'birch', 'larch', 'spruce'])
def test_leaves_come_in_spring_and_fall_in_autumn(key: str) -> None:
    species = SPECIES[key]
    year = np.linspace(1.0, 13.0, 240)
    shares = np.array([leaf_share(species, month) for month in year])
    if species.leaves.is_evergreen:
        assert (shares == 1.0).all()
        return
    assert shares[0] == shares[-1] == 0.0
    assert is_bare(species, 1.5)
    assert leaf_share(species, 7.0) == 1.0
    peak = int(shares.argmax())
    assert (np.diff(shares[: peak + 1]) >= 0.0).all()
    assert (np.diff(shares[year > 9.0]) <= 0.0).all()


@pytest.mark.parametrize('month', [5.0, 7.0, 11.0])
def test_the_wind_meets_the_leaves_of_the_month(month: float) -> None:
    tree = grow('oak', 12.0, rng=np.random.default_rng(3))
    whole, now = (
        foliage_of(tree, traits=each.leaves) for each in (OAK, species_in_month(OAK, tree, month))
    )
    share = leaf_share(OAK, month)
    np.testing.assert_allclose(now.mass, share * whole.mass, rtol=1e-9)
    np.testing.assert_allclose(now.area, share * whole.area, rtol=1e-9)
    assert (now.drag_area <= whole.drag_area * (1.0 + 1e-12)).all()
    assert (now.drag_area >= share * whole.drag_area * (1.0 - 1e-9)).all()  # they hide less


def test_colours_go_from_fresh_to_green_to_those_of_autumn() -> None:
    tree = grow('birch', 8.0, rng=np.random.default_rng(0))
    birch = SPECIES['birch']
    looks = [species_in_month(birch, tree, month).look for month in (4.6, 7.0, 11.0)]
    assert [each.green for each in looks] == [
        birch.look.fresh,
        birch.look.green,
        birch.look.autumn,
    ]
    assert species_in_month(SPECIES['spruce'], tree, 11.0) == SPECIES['spruce']


def test_damping_lies_between_bare_and_in_leaf() -> None:
    tree = grow('oak', 12.0, rng=np.random.default_rng(3))
    damping = [species_in_month(OAK, tree, month).damping_in_leaf for month in (4.9, 5.2, 7.0)]
    assert OAK.damping_bare < damping[0] < damping[1] < damping[2] == OAK.damping_in_leaf


def test_a_month_outside_the_year_is_refused() -> None:
    with pytest.raises(ParameterError, match='month'):
        leaf_share(OAK, 14.0)


@pytest.mark.parametrize(('month', 'northern'), [(1.5, 7.5), (7.5, 1.5), (13.0, 7.0)])
def test_the_south_is_half_a_year_ahead(month: float, northern: float) -> None:
    choices = Choices('oak', month=month)
    assert choices.northern_month == pytest.approx((month - 1.0) % 12.0 + 1.0)
    assert replace(choices, is_south=True).northern_month == pytest.approx(northern)
