# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The truth about a tree in a wind: every segment solved in pieces, computed once and stored on disk.

A truth is found again by a digest of the tree, the wind, the wood, the pieces and the code that
solves them. It is stored in the folder ``tree_sway_lab`` of the user's cache.

"""

from __future__ import annotations

from functools import cache
import hashlib
import os
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.core.drag import AIR_DENSITY
from tree_sway.core.settings import Settings
from tree_sway.core.species import Species
from tree_sway.core.tree import Tree
from tree_sway.files import whole_file
from tree_sway_lab.example_trees import EXAMPLE_DENSITY, EXAMPLE_MODULUS
from tree_sway_lab.segments import articulated
from tree_sway_lab.segments.articulated import ArticulatedTree
from tree_sway_lab.tip_error import record_tips
from tree_sway_lab.validation.winds import FRAME

DAMPING_RATIO, GRAVITY = 0.05, 9.81
WOOD = Species(
    'example',
    'example',
    EXAMPLE_MODULUS,
    EXAMPLE_DENSITY,
    damping_bare=DAMPING_RATIO,
    shear_ratio=1.0 / 14.0,
)
"""Wood of all trees of the truth; joints twist as the wood does."""

SETTINGS = Settings(gravity=GRAVITY)
"""Settings of the models that are judged."""


class Fineness(NamedTuple):
    """Pieces per segment, and steps per frame of 1/60 s."""

    pieces: int
    substeps: int

    def __str__(self) -> str:
        """Describe it."""
        return f'{self.pieces} pieces per segment at {60 * self.substeps} Hz'


FINE, QUICK = Fineness(4, 8), Fineness(2, 4)
"""As fine as an independent engine confirms to 1 %, and a quick form within 2 to 5 %."""

FINER = Fineness(8, 8)
"""One for twigs of metres in a gale, which fold within a piece of `FINE`."""


def true_model(tree: Tree, fineness: Fineness = FINE) -> ArticulatedTree:
    """Make the model in which every segment is solved, with weight and twist."""
    return ArticulatedTree(
        tree,
        WOOD.modulus,
        WOOD.density,
        DAMPING_RATIO,
        WOOD.bare_drag_coefficient,
        gravity=GRAVITY,
        subdivisions=fineness.pieces,
        twist_ratio=2.0 * WOOD.shear_ratio,
    )


def true_tips(tree: Tree, wind: Floats, fineness: Fineness = FINE) -> Floats:
    """
    Tips over time in [m], (t, b, 3), in a wind given as means of frames in [m/s], (t, 3).

    Fewer frames than those of the wind where even the finest steps do not follow a tip that is
    flung: there the truth ends.
    """
    path = cache_folder() / f'tips-{_digest(tree, fineness, wind)}.npy'
    if path.is_file():
        tips: Floats = np.load(path)
    else:
        model = true_model(tree, fineness)
        tips = record_tips(model, tree, wind, FRAME, substeps=fineness.substeps)
        _keep(path, tips)
    return tips[: frames_until_reset(tips, tree.end[tree.branch_first[1:] - 1])]


def frames_until_reset(tips: Floats, rest: Floats) -> int:
    """Count the frames until all tips are suddenly back near their rest, (b, 3)."""
    away = np.sqrt(np.square(tips - rest).sum(axis=2).mean(axis=1))
    is_reset = (away[1:] < 0.2 * away[:-1]) & (away[:-1] > 0.05)
    return int(np.argmax(is_reset)) + 1 if is_reset.any() else len(tips)


def true_frequencies(tree: Tree, count: int, fineness: Fineness = FINE) -> Floats:
    """Lowest natural frequencies in [Hz], (count,), with weight."""
    path = cache_folder() / f'modes-{_digest(tree, fineness, np.array(count))}.npy'
    if path.is_file():
        cached: Floats = np.load(path)
        return cached
    frequencies = true_model(tree, fineness).linear_modes(count)[0]
    _keep(path, frequencies)
    return frequencies


def cache_folder() -> Path:
    """Folder of what takes long to compute and does not change with our models."""
    home = os.environ.get('XDG_CACHE_HOME') or os.path.expanduser('~/.cache')
    return Path(home) / 'tree_sway_lab'


def _keep(path: Path, array: Floats) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with whole_file(path) as partial:
        np.save(partial, array)


def digest_of_arrays(text: str, *arrays: Floats | Ints) -> str:
    """Digest of a text and of arrays."""
    found = hashlib.blake2b(text.encode(), digest_size=16)
    for array in arrays:
        found.update(np.ascontiguousarray(array).tobytes())
    return found.hexdigest()


def _digest(tree: Tree, fineness: Fineness, asked: Floats) -> str:
    return digest_of_arrays(
        f'{_code()} {WOOD} {GRAVITY} {AIR_DENSITY} {fineness}', tree.start, tree.end,
        tree.base_diameter, tree.tip_diameter, tree.segment_parent, tree.branch_first, asked,
    )  # fmt: skip


@cache
def _code() -> str:
    """Return the code that solves the segments, but its imports: where it is does not count."""
    files = sorted(Path(articulated.__file__).parent.glob('*.py'))
    lines = (line for file in files for line in file.read_text(encoding='utf-8').splitlines())
    return '\n'.join(line for line in lines if not line.startswith(('from ', 'import ')))
