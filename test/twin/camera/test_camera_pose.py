# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A camera is found from clicks, and what they do not tell is said."""

from __future__ import annotations

import numpy as np
import pytest

from tree_sway.core.tree import Tree
from tree_sway.errors import ParameterError
from tree_sway.growth import grow
from tree_sway.twin import place_on
from tree_sway.twin.camera import Camera, camera_of_clicks, Click, looking, told_by
from tree_sway.twin.camera.camera_pose import Told

SIZE = 1280, 720
BEARING, DISTANCE = 250.0, 14.0


@pytest.fixture(scope='module')
def tree() -> Tree:
    return grow('spruce', 6.0, rng=np.random.default_rng(3))


@pytest.fixture(scope='module')
def camera() -> Camera:
    bearing = np.radians(BEARING)
    away = DISTANCE * np.array([np.sin(bearing), np.cos(bearing), 0.0])
    axes = looking(bearing + 0.02, 0.1, 0.01)
    return Camera(np.array([0.0, 0.0, 1.4]) - away, axes, 950.0, np.array([640.0, 360.0]))


def clicked(tree: Tree, camera: Camera, places: list[str]) -> list[Click]:
    found = []
    for where in places:
        place = place_on(tree, where)
        first, last = tree.start[place.segment], tree.end[place.segment]
        x, y = camera.project((first + place.along * (last - first))[None])[0].tolist()
        found.append(Click(x, y, where))
    return found


STEM = ['0', '1.5', '3', '4.5', '5.8']


def test_exact_clicks_give_the_camera(tree: Tree, camera: Camera) -> None:
    first = tree.branch_first
    sizes = [float(tree.length[first[b] : first[b + 1]].sum()) for b in range(tree.n_branches)]
    limbs = [f'{tree.branch_names[k]}:0.9' for k in np.argsort(sizes)[-5:-1]]
    clicks = clicked(tree, camera, STEM + limbs)
    found = camera_of_clicks(tree, SIZE, clicks, Told(distance=DISTANCE))
    assert found.missed < 0.5
    np.testing.assert_allclose(found.camera.position, camera.position, atol=0.25)
    assert abs(found.camera.focal / camera.focal - 1.0) < 0.02
    assert found.errors['bearing'] < 10.0


def test_a_stem_alone_does_not_tell_the_bearing(tree: Tree, camera: Camera) -> None:
    clicks = clicked(tree, camera, STEM)
    with pytest.raises(ParameterError, match='nothing tells its bearing'):
        camera_of_clicks(tree, SIZE, clicks, Told(distance=DISTANCE))
    found = camera_of_clicks(tree, SIZE, clicks, Told(bearing=BEARING, distance=DISTANCE))
    np.testing.assert_allclose(found.camera.position, camera.position, atol=0.3)
    assert found.errors['bearing'] == pytest.approx(5.0, rel=0.1)


def test_without_a_distance_its_error_is_large(tree: Tree, camera: Camera) -> None:
    clicks = clicked(tree, camera, STEM)
    told, untold = (
        camera_of_clicks(tree, SIZE, clicks, Told(bearing=BEARING, distance=distance)).errors
        for distance in (DISTANCE, None)
    )
    assert told['distance'] < 0.05 * DISTANCE < untold['distance']


def test_clicks_of_another_tree_fit_no_camera(tree: Tree, camera: Camera) -> None:
    clicks = clicked(tree, camera, STEM)
    clicks[2] = clicks[2]._replace(x=clicks[2].x + 300.0)
    with pytest.raises(ParameterError, match='no camera fits the clicks'):
        camera_of_clicks(tree, SIZE, clicks, Told(bearing=BEARING, distance=DISTANCE))


def test_a_click_beside_its_place_is_named(tree: Tree, camera: Camera) -> None:
    clicks = clicked(tree, camera, STEM)
    told = Told(bearing=BEARING, distance=DISTANCE)
    assert 'check' not in str(camera_of_clicks(tree, SIZE, clicks, told))
    clicks[2] = clicks[2]._replace(x=clicks[2].x + 15.0)
    beside = f'check {clicks[2].x:.0f},{clicks[2].y:.0f},3, which misses by'
    assert beside in str(camera_of_clicks(tree, SIZE, clicks, told))
    clicks[2] = clicks[2]._replace(x=clicks[2].x + 285.0)
    with pytest.raises(ParameterError, match=',3, which misses by'):
        camera_of_clicks(tree, SIZE, clicks, told)


def test_too_few_clicks_are_refused(tree: Tree, camera: Camera) -> None:
    with pytest.raises(ParameterError, match='2 clicked points'):
        camera_of_clicks(tree, SIZE, clicked(tree, camera, STEM[:2]))


def test_what_is_told_is_read() -> None:
    text = (
        'bearing=240; distance = 14 # paces\n 640,705,0;\n800.5,300,b12:0.9; late=0.1; check=c.png'
    )
    found = told_by(text)
    assert found.told == Told(bearing=240.0, distance=14.0)
    assert found.clicks == [Click(640.0, 705.0, '0'), Click(800.5, 300.0, 'b12:0.9')]
    assert (found.late, found.check) == (0.1, 'c.png')


@pytest.mark.parametrize(
    ('text', 'what'),
    [
        ('bearng=240', "'bearng' is not known"),
        ('1,2', "'1,2' is no clicked point"),
        ('a,2,0', 'has no number'),
        ('distance=0', 'distance=0'),
        ('late=9', 'late=9'),
        ('bearing=nan', 'has no number'),
    ],
)
def test_what_cannot_be_read_is_refused(text: str, what: str) -> None:
    with pytest.raises(ParameterError, match=what):
        told_by(text)
