# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""First frequencies of scanned trees, against a beam frame."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from tree_sway.core.settings import Settings
from tree_sway.core.setup import TreeReductions
from tree_sway.errors import TreeError
from tree_sway.files.trees import open_tree
from tree_sway_lab.frame.frame import frame_model
from tree_sway_lab.validation.section import Check, Effort, markdown_table, Section

LIMIT = 0.03


class Frequencies(NamedTuple):
    """
    A file's first frequency.

    Parameters
    ----------
    branches, segments
        How many it has.
    model, frame
        First frequency in [Hz] by the model and by the beam frame.
    has_weight
        Whether it is stable under its weight; else frequencies leave it out.

    """

    branches: int
    segments: int
    model: float
    frame: float
    has_weight: bool


def measure(effort: Effort) -> Section:
    """Read every tree of the folder of data."""
    folder = effort.data / 'trees' if effort.data else None
    files = tree_files(folder) if folder and folder.is_dir() else []
    found = dict(zip(files, effort.each(first_frequencies, files), strict=True))
    checks = [
        Check(f'`{file.name}`, relative error', abs(each.model / each.frame - 1.0), high=LIMIT)
        for file, each in found.items()
        if each.has_weight
    ]
    rows = [
        [file.name, str(each.branches), str(each.segments), 'yes' if each.has_weight else 'no',
         f'{each.frame:.4f}', f'{each.model / each.frame - 1.0:+.4f}']
        for file, each in found.items()
    ]  # fmt: skip
    text = (
        'First frequency of trees that others scanned or digitised, bare, in wood of the species '
        'table with a shear modulus of E/14, against Euler-Bernoulli elements in space with '
        'weight and twist. A tree that buckles under its weight is compared without it, outside '
        'of the limit.'
    )
    head = ['file', 'branches', 'segments', 'stable', 'f1 of the frame [Hz]', 'error']
    return Section('First frequencies of scanned trees', text, checks, markdown_table(head, rows))


def tree_files(folder: Path) -> list[Path]:
    """Return the files of a folder that are trees."""
    return sorted(file for file in folder.iterdir() if file.suffix != '.LICENSE')


def first_frequencies(file: Path) -> Frequencies:
    """Find the first frequency of a tree by the model and by the frame."""
    opened = open_tree(file)
    tree, wood = opened.tree, opened.species
    has_weight, gravity = True, Settings.gravity
    try:
        frame = _of_frame(file, gravity)
    except TreeError:
        has_weight, gravity = False, 0.0
        frame = _of_frame(file, gravity)
    settings = Settings(gravity=gravity, in_leaf=False)
    model = float(TreeReductions(tree, wood, settings).natural_frequencies(1)[0])
    return Frequencies(tree.n_branches, tree.n_segments, model, frame, has_weight)


def _of_frame(file: Path, gravity: float) -> float:
    opened = open_tree(file)
    wood = opened.species
    frame = frame_model(
        opened.tree, wood.modulus, wood.density, gravity,
        shear_ratio=wood.shear_ratio, root_stiffness=wood.root_stiffness,
    )  # fmt: skip
    return float(frame.frequencies(1)[0])
