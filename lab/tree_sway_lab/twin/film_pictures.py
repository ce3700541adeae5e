# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A film of the tree outside: its wood drawn before a sky, with what disturbs a tracker.

Clouds pass, a shadow wanders over the tree, leaves flutter at the tips of twigs, a bird crosses,
the sensor has noise, and the film is compressed where it is written to a file.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.tree import ends_of_poses, Tree
from tree_sway.twin.camera import Camera, drawn_wood
from tree_sway_lab.twin.film_truth import FRAMES, SIZE

_FINER = 2
_NOISE = 3.0


def pictures(
    cv2: Any, tree: Tree, poses: Floats, camera: Camera, rng: np.random.Generator
) -> Iterator[Any]:
    """Yield the pictures of a film in grey, (720, 1280)."""
    wide, high = SIZE
    cloud = _smooth(cv2, rng, (high, 3 * wide), 90.0)
    shade = _smooth(cv2, rng, (high, 3 * wide), 60.0)
    ground = 150.0 + 12.0 * _smooth(cv2, rng, (high, wide), 3.0)
    foot = camera.project(tree.start[:1])[0, 1]
    mask = (np.arange(high) > foot)[:, None]
    bark = 45.0 + 30.0 * rng.random(tree.n_segments)
    slender = tree.length / tree.base_diameter
    knots = np.repeat(np.arange(tree.n_segments), np.clip(slender, 1.0, 10.0).astype(int))
    along = rng.random(len(knots)) * tree.length[knots]
    aside = rng.uniform(-0.4, 0.4, len(knots))
    shine = rng.uniform(-35.0, 45.0, len(knots))
    tips = tree.branch_first[1:] - 1
    leafy = rng.permutation(tips)[: len(tips) // 3]
    hang = rng.normal(size=(len(leafy), 2)) * 3.0
    for k, block in enumerate(poses.astype(np.float64)):
        ends = ends_of_poses(block, tree.length)
        first, last, width, depth = drawn_wood(camera, *ends, tree.base_diameter)
        first_column = round(1.2 * k) % (2 * wide)
        passing = cloud[:, first_column : first_column + wide]
        sky = 195.0 + 18.0 * np.clip(passing, -2.0, 2.0)
        canvas = np.where(mask, ground, sky).astype(np.float32)
        canvas = cv2.resize(canvas, (wide * _FINER, high * _FINER))
        for s in np.argsort(-depth):
            _line(cv2, canvas, first[s], last[s], width[s], bark[s])
        on = ends_of_poses(block[knots], along)[1]
        spots = camera.project(on)
        spots[:, 0] += aside * width[knots]
        for spot, s, light in zip(spots, knots, shine, strict=True):
            if width[s] > 3.0:
                size = max(0.2 * width[s], 1.0) * _FINER
                _disc(cv2, canvas, spot, size, bark[s] + light)
        fluttered = last[leafy] + hang + 1.5 * rng.normal(size=hang.shape)
        for leaf in fluttered:
            _disc(cv2, canvas, leaf, 2.0 * _FINER, 95.0)
        bird = (k % (10 * FRAMES)) * 12.0 - 300.0
        _disc(cv2, canvas, np.array([bird, 0.35 * high + 0.1 * bird]), 9.0 * _FINER, 25.0)
        grey = cv2.resize(canvas, (wide, high), interpolation=cv2.INTER_AREA)
        late = round(1.7 * k) % (2 * wide)
        lit = np.clip(1.0 + 0.35 * shade[:, late : late + wide], 0.5, 1.2)
        grey = np.where(grey < 135.0, grey * lit, grey)
        grey = grey + _NOISE * rng.standard_normal(grey.shape, dtype=np.float32)
        yield np.clip(grey, 0.0, 255.0).astype(np.uint8)


def write_film(
    cv2: Any, path: str, tree: Tree, poses: Floats, camera: Camera, rng: np.random.Generator
) -> None:
    """Write a film as MPEG-4."""
    film = cv2.VideoWriter(path, cv2.VideoWriter_fourcc(*'mp4v'), FRAMES, SIZE)
    for each in pictures(cv2, tree, poses, camera, rng):
        film.write(cv2.cvtColor(each, cv2.COLOR_GRAY2BGR))
    film.release()


def _smooth(cv2: Any, rng: np.random.Generator, shape: tuple[int, int], size: float) -> Any:
    """Return smooth noise of unit deviation, with structures of a size in pixels."""
    coarse = [max(int(n / size), 2) for n in shape]
    noise = rng.standard_normal(coarse, dtype=np.float32)
    fine = cv2.resize(noise, shape[::-1], interpolation=cv2.INTER_CUBIC)
    return fine / fine.std()


def _line(cv2: Any, canvas: Any, a: Floats, b: Floats, width: float, light: float) -> None:
    """Draw wood; what is thinner than a pixel of the canvas is as much lighter."""
    if not np.isfinite([*a, *b]).all():
        return
    ends = [tuple((16.0 * _FINER * each).astype(int).tolist()) for each in (a, b)]
    thick = max(_FINER * width, 1.0)
    covers = min(_FINER * width, 1.0)
    colour = covers * light + (1.0 - covers) * 190.0
    cv2.line(canvas, *ends, float(colour), max(round(thick), 1), cv2.LINE_AA, 4)


def _disc(cv2: Any, canvas: Any, at: Floats, size: float, light: float) -> None:
    if np.isfinite(at).all():
        centre = tuple((16.0 * _FINER * at).astype(int).tolist())
        cv2.circle(canvas, centre, int(16.0 * size), float(light), -1, cv2.LINE_AA, 4)
