# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
First frequencies of scans that were cut at a thickness, beside those of measured trees.

The scans are no part of this package: ``QSMs`` of TobyDJackson/WindAndTrees_FEM, as the folder
``QSMs`` in the folder of data. The measured trees are those of ``forest_broadleaves.csv``.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.settings import Settings
from tree_sway.core.setup import TreeReductions
from tree_sway.core.tree import breast_height_diameter
from tree_sway.errors import TreeError
from tree_sway.files.trees import open_tree
from tree_sway_lab.validation.section import Check, Effort, markdown_table, Section
from tree_sway_lab.validation.sections.published import FOREST_BROADLEAVES

NEAR = 0.05
"""Largest difference of the logarithms of diameter and height of a scan and a measured tree."""
WAYS = {'as scanned': 0.0, 'by the second rule': None, 'twigs corrected': 0.0029}
"""Diameters of twigs with which a scan is opened."""
_RULE = 'by the second rule'
_TEXT = (Path(__file__).with_suffix('.md')).read_text(encoding='utf-8')


class Scored(NamedTuple):
    """A scan: its stem diameter and height in [m], and its first frequency by `WAYS` in [Hz]."""

    diameter: float
    height: float
    frequencies: list[float]


def measure(effort: Effort) -> Section:
    """Open each scan of the folder of data that a measured tree is near to."""
    folder = effort.data / 'QSMs' if effort.data else None
    files = sorted(folder.glob('*.mat')) if folder and folder.is_dir() else []
    sizes = np.array(effort.each(size, files)).reshape(-1, 2)
    pairs = nearest_pairs(sizes)
    found = effort.each(frequencies, [files[scan] for scan, _ in pairs])
    rows = list[list[str]]()
    ratios = np.zeros((len(pairs), len(WAYS)))
    for number, ((scan, row), each) in enumerate(zip(pairs, found, strict=True)):
        tree = FOREST_BROADLEAVES[row]
        ratios[number] = np.array(each) / tree['frequency']
        rows.append([
            files[scan].stem.removeprefix('cyl_data_').partition('_')[0], tree['species'],
            f'{sizes[scan, 0]:.3f}', f'{sizes[scan, 1]:.2f}', f'{tree["frequency"]:.3f}',
            *(f'{ratio:.2f}' for ratio in ratios[number]),
        ])  # fmt: skip
    head = ['scan', 'species', 'diameter [m]', 'height [m]', 'measured [Hz]',
            *(f'{way}, over measured' for way in WAYS)]  # fmt: skip
    checks = list[Check]()
    if rows:
        ruled = ratios[:, list(WAYS).index(_RULE)]
        within = float(np.mean((ruled > 0.5) & (ruled < 2.0)))
        checks = [
            Check('by the second rule, over measured, median', float(np.median(ruled)), 0.85, 1.2),
            Check('by the second rule, share within a factor of 2', within, 1.0),
        ]
        sums = {'median': np.median(ratios, axis=0), 'log-deviation': _spreads(ratios)}
        rows += [
            [name, *[''] * 4, *(f'{each:.2f}' for each in of_ways)]
            for name, of_ways in sums.items()
        ]
    title = 'First frequencies of scans that were cut'
    return Section(title, _TEXT, checks, markdown_table(head, rows))


def _spreads(ratios: Floats) -> Floats:
    return np.asarray(np.std(np.log(ratios), axis=0))


def size(file: Path) -> tuple[float, float]:
    """Return stem diameter and height of a scan in [m]; nan for one without a diameter."""
    tree = open_tree(file, thicken=False).tree
    return breast_height_diameter(tree) or math.nan, tree.height


def nearest_pairs(sizes: Floats) -> list[tuple[int, int]]:
    """Return scans and measured trees that are nearest to each other, as pairs of numbers."""
    known = np.array([(tree['diameter'], tree['height']) for tree in FOREST_BROADLEAVES])
    far = np.abs(np.log(sizes[:, None]) - np.log(known)).max(axis=2)
    return [
        (scan, row)
        for scan, row in enumerate(far.argmin(axis=1).tolist())
        if far[:, row].argmin() == scan and far[scan, row] < NEAR
    ]


def frequencies(file: Path) -> list[float]:
    """Return the first frequency of a scan, bare, by each of `WAYS` in [Hz]."""
    found = list[float]()
    for twig in WAYS.values():
        opened = open_tree(file, in_leaf=False, twig_diameter=twig)
        reductions = TreeReductions(opened.tree, opened.species, Settings(in_leaf=False))
        try:
            found.append(float(reductions.natural_frequencies(1)[0]))
        except TreeError:
            found.append(math.nan)
    return found
