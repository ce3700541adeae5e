# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
from pathlib import Path

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest

from tree_sway.errors import ParameterError, TreeError
from tree_sway.files.trees.cylinders.cylinder_tree import tree_of_cylinders
from tree_sway.files.trees.cylinders.cylinders import Cylinders
from tree_sway.files.trees.tree_options import TreeOptions

FILE = Path('cylinders.txt')


def cylinders_of(rows, continues=None):
    """Rows of start, end, diameter, parent."""
    start, end, width, parent = (list(column) for column in zip(*rows, strict=True))
    return Cylinders(
        np.array(start, dtype=float),
        np.array(end, dtype=float),
        np.stack([width, width], axis=1).astype(float),
        np.array(parent),
        None if continues is None else np.array(continues, dtype=bool),
        [f'cylinder {i}' for i in range(len(rows))],
    )


def built(rows, continues=None, **options):
    options = TreeOptions(**{'twig_diameter': 0.0, 'thicken': False, **options})
    return options.applied(tree_of_cylinders(cylinders_of(rows, continues), FILE))


STEM = [((0, 0, 0), (0, 0, 1), 0.2, -1), ((0, 0, 1), (0, 0, 2), 0.1, 0)]


def test_the_extension_goes_on_though_a_thicker_branch_is_there():
    rows = [*STEM, ((0, 0, 1), (1, 0, 1), 0.15, 0)]
    assert built(rows, [False, True, False]).tree.branch_length[0] == 2.0
    tree = built(rows, None).tree
    np.testing.assert_array_equal(tree.end[1], [1, 0, 1])


def test_of_two_extensions_one_goes_on():
    tree = built([*STEM, ((0, 0, 1), (1, 0, 1), 0.05, 0)], [False, True, True]).tree
    assert tree.n_branches == 2
    np.testing.assert_array_equal(tree.end[1], [0, 0, 2])


def test_loose_branches_are_set_on_the_nearest_cylinder():
    tree_file = built([*STEM, ((0.3, 0, 1.6), (1, 0, 1.6), 0.05, -1)], [False, True, False])
    assert list(tree_file.tree.segment_parent) == [-1, 0, 1]
    np.testing.assert_allclose(tree_file.tree.start[2], [0.3, 0, 1.6])
    assert tree_file.notes == (
        '1 branches had no parent and were joined to the nearest cylinder, at most 0.3 m away',
    )


def test_positions_with_too_few_digits_for_their_place_are_named():
    rng = np.random.default_rng(0)
    places = np.array([531_000.0, 5_340_000.0, 300.0]) + rng.uniform(0.0, 0.3, (20, 3))
    places[:, 2] += np.arange(20.0)

    def faults(nodes):
        pairs = zip(nodes[:-1].tolist(), nodes[1:].tolist(), strict=True)
        return built([(*pair, 0.2, row - 1) for row, pair in enumerate(pairs)]).faults

    assert faults(places) == ()
    assert faults(places - places[0]) == ()
    rounded = places.copy()
    rounded[:, 1] = 5_340_000.0 + np.arange(20.0) % 2.0
    assert faults(rounded)[0].startswith('its positions come in steps of 1 m, as its numbers')
    single = places.astype(np.float32)
    assert 'in steps of 0.' in faults(single.astype(np.float64))[0]


def test_two_trees_are_not_one():
    other = [((9, 0, 0), (9, 0, 1), 0.15, -1)]
    with pytest.raises(TreeError, match='cylinder 2: 2 roots: a forest of trees'):
        built(STEM + other, [False, True, False])


@pytest.mark.parametrize(
    ('rows', 'continues', 'n', 'parents'),
    [
        # In the middle of a branch: goes to the one before, and what it bears with it.
        ([*STEM, ((0, 0, 2), (0, 0, 2), 0.1, 1), ((0, 0, 2), (0, 0, 3), 0.1, 2),
          ((0, 0, 2), (1, 0, 2), 0.05, 2)], [0, 1, 1, 1, 0], 4, [-1, 0, 1, 1]),
        # First of a branch: what it bears sits on its parent.
        ([*STEM, ((0, 0, 1), (0, 0, 1), 0.05, 0), ((0, 0, 1), (1, 0, 1), 0.05, 2),
          ((0, 0, 1), (0, 1, 1), 0.04, 2)], [0, 1, 0, 1, 0], 4, [-1, 0, 0, 0]),
        # A branch of nothing else.
        ([*STEM, ((0, 0, 1), (0, 0, 1), 0.05, 0), ((0, 0, 1), (1, 0, 1), 0.05, 2)],
         [0, 1, 0, 0], 3, [-1, 0, 0]),
        # The root itself.
        ([((0, 0, 0), (0, 0, 0), 0.2, -1), ((0, 0, 0), (0, 0, 1), 0.2, 0),
          ((0, 0, 1), (0, 0, 2), 0.1, 1)], [0, 1, 1], 2, [-1, 0]),
        # Two in a row at the base of a branch.
        ([*STEM, ((0, 0, 1), (0, 0, 1), 0.05, 0), ((0, 0, 1), (0, 0, 1), 0.05, 2),
          ((0, 0, 1), (1, 0, 1), 0.05, 3), ((0, 0, 1), (0, 1, 1), 0.04, 2)],
         [0, 1, 0, 1, 1, 0], 4, [-1, 0, 0, 0]),
    ],
)  # fmt: skip
def test_cylinders_of_no_length_are_left_out(rows, continues, n, parents):
    tree_file = built(rows, continues)
    assert tree_file.tree.n_segments == n
    assert list(tree_file.tree.segment_parent) == parents
    assert tree_file.notes == (f'{len(rows) - n} cylinders of zero length were left out',)


@settings(deadline=None, max_examples=30)
@given(seed=st.integers(0, 2**32 - 1))
def test_leaving_out_keeps_volume_and_reach(seed):
    rng = np.random.default_rng(seed)
    n = 20
    reach = np.where(rng.random(n) < 0.3, 0.0, rng.uniform(0.3, 1.0, n))
    reach[0] = 1.0
    z = np.concatenate([[0.0], np.cumsum(reach)])
    width = rng.uniform(0.05, 0.2, n)
    rows = [((0, 0, z[i]), (0, 0, z[i + 1]), width[i], i - 1) for i in range(n)]
    tree = built(rows, [i > 0 for i in range(n)]).tree
    assert tree.n_segments == np.count_nonzero(reach)
    assert tree.height == pytest.approx(z[-1], abs=1e-9)
    assert tree.volume.sum() == pytest.approx((np.pi / 4 * width**2 * reach).sum(), rel=1e-9)


@pytest.mark.parametrize(
    ('rows', 'message'),
    [
        ([((0, 0, 0), (0, 0, np.nan), 0.1, -1)], 'cylinder 0: a number that is not finite'),
        ([((0, 0, 0), (0, 0, 1e9), 0.1, -1)], 'cylinder 0: .* too large'),
        ([((0, 0, 0), (0, 0, 1), 0.0, -1)], 'cylinder 0: diameter'),
        ([((0, 0, 0), (0, 0, 0), 0.1, -1)], 'cylinder 0: zero length'),
        ([((0, 0, 0), (0, 0, 1), 0.1, 0)], 'cylinder 0: cyclic'),
        ([((0, 0, 0), (0, 0, 1), 0.1, 7)], 'cylinder 0: orphan'),
        ([((0, 0, 0), (0, 0, 1), 0.1, -2)], 'cylinder 0: orphan'),
    ],
)
def test_what_cannot_be(rows, message):
    with pytest.raises(TreeError, match=message):
        built(rows)


@pytest.mark.parametrize('options', [{'trusted_diameter': -1.0}, {'twig_diameter': float('nan')}])
def test_options_are_checked(options):
    with pytest.raises(ParameterError, match=next(iter(options))):
        TreeOptions(**options)
