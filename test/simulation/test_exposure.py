# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Exposure: the profile of its kind, ForestGALES' displacement, roughness and edge factor."""

from __future__ import annotations

from dataclasses import replace
import math

import numpy as np
import pytest

from tree_sway.core.species.species import species_named
from tree_sway.core.tree.building import tree_from_segments
from tree_sway.errors import ParameterError
from tree_sway.simulation.exposure import ATTENUATION, Exposure, exposure_of, EXPOSURES
from tree_sway.twin.learned_tree import LearnedTree

SITKA = {'height': 20.0, 'spacing': 2.2, 'crown_width': 4.0, 'crown_depth': 9.8, 'drag': 0.726}


def test_the_open_has_the_log_profile_of_grass_and_the_mean_of_a_station():
    profile = Exposure('open', 20.0).profile()
    z = np.array([2.0, 10.0, 20.0])
    assert profile.over_anemometer(z) == pytest.approx(np.log(z / 0.03) / math.log(10.0 / 0.03))
    assert Exposure('open', 20.0).reference_height == 10.0
    assert Exposure('open', 4.0).reference_height == 4.0


def test_a_stand_has_the_displacement_and_roughness_of_raupach():
    """Computed by hand from the equations of Raupach (1994): L = 5.877, more than 0.6."""
    stand = Exposure('stand', **SITKA)
    area = 4.0 * 0.726 * 9.8 / 2.2**2
    assert stand.frontal_area == pytest.approx(area)
    depth = math.sqrt(7.5 * area)
    d = 20.0 * (1.0 - (1.0 - math.exp(-depth)) / depth)
    assert stand.displacement == pytest.approx(d)
    gamma = 1.0 / math.sqrt(0.003 + 0.3 * 0.3)
    assert stand.friction_ratio == pytest.approx(1.0 / gamma)
    z0 = (20.0 - d) * math.exp(-0.4 * gamma + math.log(2.0) - 1.0 + 0.5)
    assert stand.profile().roughness == pytest.approx(z0)


@pytest.mark.parametrize('kind', ['edge', 'stand'])
def test_the_wind_of_a_stand_is_1_at_its_top_and_less_below_and_more_above(kind):
    profile = Exposure(kind, **SITKA).profile(ground=3.0)
    z = 3.0 + np.array([0.0, 5.0, 10.0, 15.0, 20.0, 30.0])
    ratio = profile.over_anemometer(z)
    assert ratio[4] == pytest.approx(1.0)
    assert (np.diff(ratio) >= 0.0).all()
    assert ratio[0] == 0.0
    assert ratio[-1] > 1.0
    if kind == 'stand':
        assert ratio[2] == pytest.approx(math.exp(-0.5 * ATTENUATION))


def test_the_wind_at_ten_metres_does_not_depend_on_where_the_anemometer_is():
    assert Exposure('open', 20.0).at_ten_metres == 1.0
    low = Exposure('open', 4.0)
    assert low.at_ten_metres == pytest.approx(np.log(10 / 0.03) / np.log(4 / 0.03))
    top = Exposure('stand', **SITKA)
    above = Exposure('stand', **SITKA, anemometer_height=top.displacement + 10.0)
    assert top.height < above.anemometer_height
    assert above.at_ten_metres == pytest.approx(1.0)
    assert top.at_ten_metres == pytest.approx(
        float(top.profile().over_anemometer(np.array(above.anemometer_height)))
    )


def test_a_street_has_the_wind_and_the_gusts_of_eurocode_terrain_three():
    """EN 1991-1-4: c_r(10 m) = 1.007 in II and 0.755 in III; I_v 0.285 there at a point."""
    street = Exposure('street', 20.0, crown_width=10.0)
    assert street.at_ten_metres == pytest.approx(1.007 / 0.755, rel=0.002)
    scale = 300.0 * (12.0 / 200.0) ** (0.67 + 0.05 * math.log(0.3))
    background = 1.0 / (1.0 + 0.9 * (30.0 / scale) ** 0.63)
    assert street.intensity == pytest.approx(0.285 * math.sqrt(background), rel=0.05)
    small = Exposure('street', 20.0, crown_width=1.0)
    assert small.intensity > street.intensity


def test_an_anemometer_above_a_stand_sees_more_wind_than_its_top():
    low = Exposure('stand', **SITKA).profile()
    high = Exposure('stand', **SITKA, anemometer_height=40.0).profile()
    z = np.array([10.0, 20.0, 40.0])
    assert high.over_anemometer(z)[-1] == pytest.approx(1.0)
    of_low = low.over_anemometer(z)
    assert high.over_anemometer(z) == pytest.approx(of_low / of_low[-1])


def test_crowns_that_touch_damp_a_tree_in_leaf_unless_its_damping_was_measured():
    oak = species_named('oak')
    alone, street, edge, inside = (
        Exposure(kind, **SITKA).in_contact(oak).damping_in_leaf for kind in EXPOSURES
    )
    assert alone == street == oak.damping_in_leaf
    assert edge == pytest.approx(1.25 * alone)
    assert inside == pytest.approx(1.5 * alone)
    stand = Exposure('stand', **SITKA)
    assert stand.in_contact(oak).damping_bare == oak.damping_bare
    measured = replace(oak, damping_in_leaf=0.07)
    assert stand.in_contact(measured) is measured


def test_crowns_that_touch_damp_a_tree_whose_own_damping_sensors_told():
    oak = species_named('oak')
    learned = LearnedTree(0.5, 0.8, 0.03, 1.2, 0.1, 0.9, 0.2, 1.0)
    own = learned.of(oak, in_leaf=True)
    alone, stand = Exposure('open', **SITKA), Exposure('stand', **SITKA)
    among = stand.in_contact(own, learned.damping)
    assert among.damping_in_leaf == pytest.approx(1.5 * 1.2 * oak.damping_in_leaf)
    assert alone.in_contact(own, learned.damping).damping_in_leaf == own.damping_in_leaf
    bare = stand.in_contact(learned.of(oak, in_leaf=False), learned.damping)
    assert bare.damping_in_leaf == pytest.approx(1.5 * oak.damping_in_leaf)


@pytest.mark.parametrize(('ratio', 'factor'), [(0.11, 4.486), (0.2, 2.482), (0.45, 1.340)])
def test_the_edge_factor_is_that_of_forestgales(ratio, factor):
    """By `edge_gap_factor_fun` of the R package fgr, gap of ten heights, distance 0."""
    s_h, deep = ratio, 9
    inside, edge = 2.7193 * s_h - 0.061, -1.273 * s_h + 0.9701
    decay = 1.1127 * s_h + 0.0311
    expected = (inside + edge * decay**deep + edge * (1.0 - decay**deep)) / (
        inside + edge * decay**deep
    )
    found = Exposure('edge', height=20.0, spacing=20.0 * ratio).edge_factor
    assert found == pytest.approx(expected)
    assert found == pytest.approx(factor, rel=1e-3)


def test_the_shelter_grows_as_trees_stand_closer():
    means = []
    for spacing in (2.0, 4.0, 12.0, 40.0):
        edge = Exposure('edge', **{**SITKA, 'spacing': spacing})
        stand = Exposure('stand', **{**SITKA, 'spacing': spacing})
        means.append(edge.edge_factor)
        assert edge.displacement == stand.displacement
    assert means == sorted(means, reverse=True)


def test_the_exposure_of_a_tree_is_of_its_size_and_says_its_height():
    tree = tree_from_segments(
        [[0, 0, 2], [0, 0, 8], [0, 0, 8]], [[0, 0, 12], [3, 0, 10], [-3, 0, 10]],
        [0.2, 0.05, 0.05], parent=[-1, 0, 0], branch=[0, 1, 2],
    )  # fmt: skip
    for kind in EXPOSURES:
        found = exposure_of(tree, species_named('oak'), kind)
        assert found.height == pytest.approx(10.0)
        assert found.crown_depth == pytest.approx(4.0, rel=0.01)
        assert 'mean wind 10 m above the ground' in str(found)
    assert 'in a stand, trees 1.8 m apart' in str(exposure_of(tree, species_named('oak'), 'stand'))


@pytest.mark.parametrize('height', [0.05, 0.5])
def test_a_seedling_has_an_exposure(height):
    tree = tree_from_segments([[0, 0, 0]], [[0, 0, height]], [0.002], parent=[-1], branch=[0])
    for kind in EXPOSURES:
        found = exposure_of(tree, species_named('oak'), kind)
        assert np.isfinite(found.intensity)
        assert 0.0 <= found.profile().over_anemometer(np.array(height)) < 2.0
    assert exposure_of(tree, species_named('oak')).scaled(0.03).height == 0.03


@pytest.mark.parametrize(
    'wrong', [{'kind': 'wood'}, {'spacing': 0.0}, {'height': -1.0}, {'crown_width': 0.0}]
)
def test_wrong_values_are_refused(wrong):
    with pytest.raises(ParameterError):
        Exposure(**wrong)
