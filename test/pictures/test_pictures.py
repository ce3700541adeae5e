# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Pictures: that they are written, and that what they show is there."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tree_sway.core.leaves.foliage import leaf_clusters
from tree_sway.core.scene.placed_tree import joined, PlacedTree
from tree_sway.core.tree.building import tree_from_segments
from tree_sway.core.tree.tree import Tree
from tree_sway.errors import FormatError, ParameterError
from tree_sway.growth.builtin import builtin_tree
from tree_sway.pictures.animation import animate_poses
from tree_sway.pictures.pictures import figure_in_wind
from tree_sway.pictures.plots import wind_and_tip
from tree_sway.pictures.plotting import save_figure

pytest.importorskip('matplotlib')
Image = pytest.importorskip('PIL.Image')


def pole() -> Tree:
    return tree_from_segments([[0, 0, 0], [0, 0, 1.0]], [[0, 0, 1.0], [0, 0, 2.0]], [0.2, 0.1])


def leaning(tree: Tree, angle: float) -> np.ndarray:
    """Pose block of the tree turned towards the east as a whole."""
    turn = np.array(
        [[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]]
    )
    return replace(tree, start=tree.start @ turn.T, end=tree.end @ turn.T).rest_poses


def pixels(path: Path) -> np.ndarray:
    return np.asarray(Image.open(path).convert('RGB')).astype(float)


def in_calm(tree: Tree, path: Path, **options: Any) -> Path:
    return save_figure(
        figure_in_wind([tree], leaning(tree, 0.0), [0.0, 0.0, 0.0], **options), path
    )


def dark_columns(picture: np.ndarray) -> np.ndarray:
    """Columns that show bark, above the ground and beside the wind."""
    rows = picture[int(0.15 * len(picture)) : int(0.6 * len(picture))]
    return np.flatnonzero((rows.max(axis=2) < 180).any(axis=0))


def test_bark_is_as_thick_as_it_is(tmp_path: Path) -> None:
    picture = pixels(in_calm(pole(), tmp_path / 'pole.png'))
    dark = picture.max(axis=2) < 180
    lower, upper = int(0.65 * len(picture)), int(0.25 * len(picture))
    # 0.2 m below, 0.1 m above; an edge of a pixel or two on top of each.
    assert 1.6 < dark[lower].sum() / dark[upper].sum() < 2.3


def test_wind_from_the_west_leans_the_tree_to_the_right_of_its_shape_at_rest(
    tmp_path: Path,
) -> None:
    tree = pole()
    path = tmp_path / 'wind.png'
    figure = figure_in_wind([tree], leaning(tree, 0.5), [8.0, 0.0, 0.0])
    assert save_figure(figure, path) == path
    picture = pixels(path)
    moved = dark_columns(picture)
    rows = picture[int(0.15 * len(picture)) : int(0.3 * len(picture))]
    ghost = np.flatnonzero((np.abs(rows - [222, 218, 214]).max(axis=2) < 3).any(axis=0))
    # Above the root the tree is to the right of where it is at rest.
    assert moved.min() > ghost.mean()
    assert moved.max() > ghost.mean() + 100
    blue = (picture[..., 2] > picture[..., 0] + 80).any(axis=0)
    half = picture.shape[1] // 2
    assert blue[:half].sum() > 0 == blue[half:].sum()


def test_several_trees_stand_side_by_side(tmp_path: Path) -> None:
    trees = [PlacedTree(f'pole{i}', pole(), x=3.0 * i).placed() for i in range(3)]
    joint = joined(trees)
    leaves = leaf_clusters(trees[1], np.random.default_rng(0), count=30)
    leaves = replace(leaves, segment=leaves.segment + trees[0].n_segments)
    poses = joint.rest_poses
    figure = figure_in_wind(trees, poses, [6.0, 0.0, 0.0], leaves=leaves)
    path = save_figure(figure, tmp_path / 'row.png')
    picture = pixels(path)
    row = picture[int(0.6 * len(picture))]
    dark = np.flatnonzero(row.max(axis=1) < 180)
    assert np.count_nonzero(np.diff(dark) > 50) == 2
    is_green = picture[..., 1] > np.maximum(picture[..., 0], picture[..., 2]) + 25
    green = np.flatnonzero(is_green.any(axis=0))
    assert 0.3 * picture.shape[1] < green.min() < green.max() < 0.7 * picture.shape[1]


@pytest.mark.parametrize('name', ['benjamina', 'broadleaf'])
def test_a_whole_tree_fits_its_picture(name: str, tmp_path: Path) -> None:
    picture = pixels(in_calm(builtin_tree(name), tmp_path / 'tree.png'))
    border = np.concatenate([picture[0], picture[-1], picture[:, 0], picture[:, -1]])
    assert border.min() > 250.0
    assert (picture.max(axis=2) < 180).mean() > 0.01


@pytest.mark.parametrize('form', ['GIF', 'WEBP'])
def test_a_moving_picture_has_its_frames_and_its_pace(form: str, tmp_path: Path) -> None:
    tree = pole()
    frames = [leaning(tree, angle) for angle in (0.0, 0.2, 0.4)]
    path = tmp_path / f'sway.{form.lower()}'
    animate_poses(tree, frames, np.ones((3, 3)), path, rate=20.0, pixels=160)
    image = Image.open(path)
    assert (image.format, image.n_frames) == (form, 3)
    first = np.asarray(image.convert('RGB')).astype(float)
    assert image.info['duration'] == pytest.approx(50.0)
    image.seek(2)
    assert np.abs(np.asarray(image.convert('RGB')) - first).max() > 100


def test_leaves_are_green_and_move_with_the_tree(tmp_path: Path) -> None:
    tree = builtin_tree('benjamina')
    leaves = leaf_clusters(tree, np.random.default_rng(0), count=300)
    bare = pixels(in_calm(tree, tmp_path / 'bare.png'))
    green = pixels(in_calm(tree, tmp_path / 'leafy.png', leaves=leaves))

    def is_green(picture: np.ndarray) -> np.ndarray:
        return picture[..., 1] > picture[..., [0, 2]].max(axis=2) + 20

    assert is_green(bare).sum() == 0
    assert is_green(green).mean() > 0.05
    path = tmp_path / 'w.png'
    save_figure(figure_in_wind([tree], leaning(tree, 0.3), [8, 0, 0], leaves=leaves), path)
    calm, moved = is_green(green).sum(axis=0), is_green(pixels(path)).sum(axis=0)
    beyond = [
        np.average(np.arange(len(each)), weights=each) - 0.5 * len(each) for each in (calm, moved)
    ]
    assert beyond[1] > beyond[0] + 30


def test_a_moving_picture_with_leaves(tmp_path: Path) -> None:
    tree = pole()
    leaves = leaf_clusters(tree, np.random.default_rng(0), count=30)
    path = tmp_path / 'leaves.gif'
    still = [leaning(tree, 0.0)] * 2
    animate_poses(tree, still, np.full((2, 3), 5.0), path, rate=7.3, leaves=leaves, pixels=160)
    image = Image.open(path)
    first = np.asarray(image.convert('RGB')).astype(float)
    image.seek(1)
    # The tree is at rest; its leaves are not.
    assert np.abs(np.asarray(image.convert('RGB')) - first).max() > 30


def test_what_is_no_moving_picture_is_refused(tmp_path: Path) -> None:
    tree = pole()
    with pytest.raises(FormatError, match=r"'\.jpg' is no moving picture; .*\.gif"):
        animate_poses(tree, [leaning(tree, 0.0)], np.ones((1, 3)), tmp_path / 'a.jpg')
    with pytest.raises(ParameterError, match='0 frames'):
        animate_poses(tree, [], np.ones((0, 3)), tmp_path / 'a.gif')
    with pytest.raises(FormatError, match='cannot be written'):
        animate_poses(tree, [leaning(tree, 0.0)], np.ones((1, 3)), tmp_path / 'no' / 'a.gif')


def test_plot_of_wind_and_tip(tmp_path: Path) -> None:
    time = np.linspace(0.0, 10.0, 200)
    wind = np.stack([5.0 + np.sin(time), np.zeros(200), np.zeros(200)], axis=1)
    tip = 0.02 * wind
    path = save_figure(wind_and_tip(time, wind, tip, 'a pole'), tmp_path / 'plot.png')
    assert Image.open(path).width > 800
    with pytest.raises(ParameterError, match='do not match'):
        wind_and_tip(time, wind[:-1], tip)


def test_a_name_that_is_no_picture_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match=r"'\.doc' is no picture format; .*\.png"):
        in_calm(pole(), tmp_path / 'tree.doc')
    with pytest.raises(FormatError, match='cannot be written: No such file'):
        in_calm(pole(), tmp_path / 'nowhere' / 'tree.png')
