# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Wrong units are refused or reported, with the option that mends them."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

from tree_sway.core.scene.make import make_simulator
from tree_sway.core.setup.preparation import prepare
from tree_sway.core.species.species import species_keys, species_named
from tree_sway.core.tree.plausibility import oddities, refuse_implausible
from tree_sway.core.tree.tree import Tree
from tree_sway.errors import ParameterError, TreeError
from tree_sway.growth.builtin import builtin_tree, BUILTIN_TREES
from tree_sway.growth.growing import grow

OAK = species_named('oak')
SHAPE = ('start', 'end', 'base_diameter', 'tip_diameter')


@cache
def oak(height: float = 12.0) -> Tree:
    return grow('oak', height, rng=np.random.default_rng(0))


@cache
def goldcrest() -> Tree:
    return builtin_tree('goldcrest')


def in_units(tree: Tree, length: float = 1.0, diameter: float = 1.0) -> Tree:
    return replace(
        tree,
        start=length * tree.start,
        end=length * tree.end,
        base_diameter=diameter * tree.base_diameter,
        tip_diameter=diameter * tree.tip_diameter,
    )


@pytest.mark.parametrize('name', BUILTIN_TREES)
def test_nothing_is_odd_about_the_trees_of_the_package(name: str) -> None:
    tree = builtin_tree(name)
    refuse_implausible(tree, species_named(tree.species))
    assert oddities(tree, species_named(tree.species)) == ()


@pytest.mark.parametrize('size', ['usual', pytest.param('extreme', marks=pytest.mark.long)])
@pytest.mark.parametrize('key', species_keys())
def test_nothing_is_odd_about_grown_trees(key: str, size: str) -> None:
    wood = species_named(key)
    usual, extremes = (1.5, (0.4, 3.0)) if wood.habit == 'pot' else (12.0, (1.5, 45.0))
    for height in (usual,) if size == 'usual' else extremes:
        tree = grow(key, height, rng=np.random.default_rng(1))
        refuse_implausible(tree, wood)
        assert oddities(tree, wood) == ()


@pytest.mark.parametrize(
    ('wood', 'cure'),
    [
        ({'modulus': 9.4}, 'give 1e\\+07 to 5e\\+11 Pa'),
        ({'density': 0.95}, 'give 40 to 10000 kg/m\\^3'),
        ({'modulus': 9.4e18}, 'give 1e\\+07 to 5e\\+11 Pa'),
        ({'density': float('nan')}, 'give 40 to 10000 kg'),
    ],
)
def test_wood_in_another_unit_is_refused(wood: dict[str, float], cure: str) -> None:
    with pytest.raises(ParameterError, match=cure):
        refuse_implausible(oak(), replace(OAK, **wood))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ('length', 'diameter'),
    [(1.0, 1000.0), (1.0, 100.0), (100.0, 1.0), (1000.0, 1.0), (100.0, 100.0), (1000.0, 1000.0)],
)
def test_lengths_in_another_unit_are_refused(length: float, diameter: float) -> None:
    for height in (8.0, 20.0):
        with pytest.raises(TreeError, match=r'length_unit=0\.01 .* diameter_unit=0\.01 .* 0\.001'):
            refuse_implausible(in_units(oak(height), length, diameter), OAK)


@pytest.mark.parametrize(
    ('change', 'oddity'),
    [
        (
            {'modulus': 1e9},
            'a modulus of 1 GPa, where green wood has 3 to 20 GPa: check --modulus',
        ),
        ({'density': 300.0}, 'a density of 300 kg/m^3, where green wood has 400 to 1300'),
    ],
)
def test_odd_wood_is_reported(change: dict[str, float], oddity: str) -> None:
    wood = replace(OAK, **change)  # type: ignore[arg-type]
    refuse_implausible(oak(), wood)
    (reported,) = oddities(oak(), wood)
    assert reported.startswith(oddity)


def test_a_tree_whose_file_has_y_up_is_reported_to_lie() -> None:
    lying = oak()
    lying = replace(lying, start=lying.start[:, [0, 2, 1]], end=lying.end[:, [0, 2, 1]])
    refuse_implausible(lying, OAK)
    (reported,) = oddities(lying, OAK)
    assert reported.startswith('a lean of 9')
    assert reported.endswith('add --option up=y')


def test_odd_sizes_are_reported() -> None:
    stout = oddities(in_units(oak(), diameter=8.0), OAK)
    assert stout[0].startswith('a height over diameter of 5')
    assert 'too thin' in oddities(in_units(oak(), diameter=0.1), OAK)[0]
    assert oddities(in_units(oak(), 12.0, 12.0), OAK)[0].startswith('a height of 144 m')
    small = oddities(in_units(oak(), 0.001, 0.001), OAK)
    assert small[0].startswith('a height of 0.012 m')


@given(length=st.floats(1e-4, 1e4), diameter=st.floats(1e-4, 1e4), modulus=st.floats(1e-2, 1e14))
def test_whatever_is_given_is_refused_or_reported_in_sentences(
    length: float, diameter: float, modulus: float
) -> None:
    tree = in_units(goldcrest(), length, diameter)
    wood = replace(OAK, modulus=modulus)
    try:
        refuse_implausible(tree, wood)
        reported = oddities(tree, wood)
    except (ParameterError, TreeError) as error:
        reported = (error.cure,)
    assert all(len(each) > 20 for each in reported)


@pytest.mark.parametrize(('unit', 'factor'), [(1e-3, '0.001'), (1e-2, '0.01'), (1e3, '1000')])
@pytest.mark.parametrize('make', [prepare, make_simulator])
def test_a_tree_that_is_not_in_metres_is_no_simulator(unit, factor, make):
    tree = oak(20.0)
    arrays = {name: getattr(tree, name) / unit for name in SHAPE}
    with pytest.raises(TreeError, match=f'a height of .* m, .* multiply .* by {factor}$'):
        make(replace(tree, **arrays))
