# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The tree outside the window, picture by picture, and a camera that a person sets up."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.species import Species
from tree_sway.core.tree import tips_of_poses, Tree
from tree_sway.twin import place_on
from tree_sway.twin.camera import Camera, camera_of_clicks, Click, looking, told_by
from tree_sway_lab.twin.gusty_truth import Outside, swayed_outside
from tree_sway_lab.twin.true_tree import DT, pose_at

FRAMES = 30
"""Pictures per second [Hz]."""

SIZE = (1280, 720)
_LIMBS = 4
"""Stoutest limbs that are clicked too."""
_CLICK = 1.5
"""Error of a click in pixels."""


class FilmedTruth(NamedTuple):
    """
    What is filmed, and what is measured beside it.

    Wind of the mast (n, 3), tips (n, b, 3), poses of every segment by picture (k, s, 7), and those
    of the places of sensors by name, (n, 7).
    """

    wind: Floats
    tips: Floats
    poses: Floats
    at: Mapping[str, Floats] = {}


def filmed_truth(
    tree: Tree,
    species: Species,
    outside: Outside,
    places: Sequence[str] = (),
    *,
    in_leaf: bool = False,
) -> FilmedTruth:
    """Sway the tree outside from rest; the first picture is of rest, the next 1 / 30 s later."""
    every = round(1.0 / (FRAMES * DT))
    winds, tips = [], []
    poses = [tree.rest_poses.astype(np.float32)]
    at: dict[str, list[Floats]] = {name: [] for name in places}
    for wind, block in swayed_outside(tree, species, outside, in_leaf=in_leaf):
        winds.append(wind.copy())
        tips.append(tips_of_poses(tree, block))
        for name, felt in at.items():
            felt.append(pose_at(tree, block, place_on(tree, name)))
        if len(winds) % every == 0:
            poses.append(block.astype(np.float32))
    by_place = {name: np.array(each) for name, each in at.items()}
    return FilmedTruth(np.array(winds), np.array(tips), np.array(poses), by_place)


def camera_before(tree: Tree, rng: np.random.Generator) -> Camera:
    """Draw a camera that has all of a tree in its picture, by a phone's focal length."""
    low, high = tree.end.min(axis=0), tree.end.max(axis=0)
    size = max(float(high[2] - low[2]), 0.8 * float(np.linalg.norm((high - low)[:2])))
    focal = 0.75 * SIZE[0]
    distance = 1.25 * size * focal / SIZE[1] + 0.5 * float(np.linalg.norm((high - low)[:2]))
    bearing = rng.uniform(0.0, 2.0 * np.pi)
    middle = np.array([*tree.start[0, :2], 0.5 * (low[2] + high[2])])
    away = distance * np.array([np.sin(bearing), np.cos(bearing), 0.0])
    position = np.array([*tree.start[0, :2], tree.start[0, 2] + 1.5]) - away
    pitch = np.arctan2(middle[2] - position[2], distance)
    axes = looking(bearing + rng.normal() * 0.02, float(pitch), rng.normal() * 0.02)
    return Camera(position, axes, focal, 0.5 * np.array(SIZE))


class SetUp(NamedTuple):
    """The camera that was found, and the text by which a person tells it."""

    camera: Camera
    clicks: str


def set_up(tree: Tree, camera: Camera, rng: np.random.Generator) -> SetUp:
    """Find that camera as a person would: clicks on stem and limbs, bearing and distance."""
    names = tree.branch_names
    limbs = np.flatnonzero(tree.branch_parent == 0)
    first = tree.branch_first
    stout = limbs[np.argsort(tree.base_diameter[first[limbs]])[::-1]][:_LIMBS].tolist()
    shares = [(0, share) for share in (0.0, 0.25, 0.5, 0.75, 0.98)]
    clicks = []
    for branch, share in shares + [(branch, 0.9) for branch in stout]:
        where = f'{names[branch]}:{share}'
        place = place_on(tree, where)
        along = tree.end[place.segment] - tree.start[place.segment]
        at = camera.project((tree.start[place.segment] + place.along * along)[None])[0]
        x, y = at + _CLICK * rng.normal(size=2)
        clicks.append(Click(float(x), float(y), where))
    toward = tree.start[0] - camera.position
    bearing = np.degrees(np.arctan2(toward[0], toward[1])) + 3.0 * rng.normal()
    distance = float(np.hypot(*toward[:2])) * (1.0 + 0.02 * rng.normal())
    lines = [f'{each.x:.1f},{each.y:.1f},{each.place}' for each in clicks]
    text = ';\n'.join([f'bearing={bearing:.1f}', f'distance={distance:.2f}', *lines, ''])
    told = told_by(text)
    return SetUp(camera_of_clicks(tree, SIZE, told.clicks, told.told).camera, text)
