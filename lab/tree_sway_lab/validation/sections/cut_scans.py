# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
First frequencies of scans that were cut at a thickness, beside those of measured trees.

The scans are no part of this package: ``QSMs`` of TobyDJackson/WindAndTrees_FEM, as the folder
``QSMs`` in the folder of data. The measured trees are those of ``forest_broadleaves.csv``.
"""

from __future__ import annotations

from dataclasses import replace
import math
from pathlib import Path
from typing import Any

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.settings import Settings
from tree_sway.core.setup import standing_tree, TreeReductions
from tree_sway.files.trees import open_tree, TreeFile
from tree_sway.growth import breast_height_diameter
from tree_sway.simulation import simulate
from tree_sway_lab.validation.drawn_scans import by_one_length, by_one_ratio, TWIG
from tree_sway_lab.validation.section import Check, Effort, markdown_table, Section
from tree_sway_lab.validation.sections.published import FOREST_BROADLEAVES

NEAR = 0.05
"""Largest difference of the logarithms of diameter and height of a scan and a measured tree."""
RULES = {'first rule': by_one_length, 'second rule': by_one_ratio}
WAYS = ('as scanned', *RULES, 'twigs corrected')
"""How a scan is opened; the first is what the program does."""
_RATE = 20
_BLOWN, _LEFT = 20, 80
"""Frames per second, and seconds with a steady wind and after it."""
_TEXT = Path(__file__).with_suffix('.md').read_text(encoding='utf-8')


def measure(effort: Effort) -> Section:
    """Open each scan of the folder of data that a measured tree is near to."""
    folder = effort.data / 'QSMs' if effort.data else None
    files = sorted(folder.glob('*.mat')) if folder and folder.is_dir() else []
    sizes = np.array(effort.each(size, files)).reshape(-1, 2)
    pairs = nearest_pairs(sizes)
    trees = [FOREST_BROADLEAVES[row] for _, row in pairs]
    found = np.array(effort.each(frequencies, [files[scan] for scan, _ in pairs]))
    checks = list[Check]()
    rows = list[list[str]]()
    if pairs:
        measured = np.array([tree['frequency'] for tree in trees])
        ratios = found.reshape(len(pairs), -1) / measured[:, None]
        for number, way in enumerate(WAYS[: 1 + len(RULES)]):
            of_way = ratios[:, number]
            within = float(np.mean((of_way > 0.5) & (of_way < 2.0)))
            checks += [
                Check(f'{way}, over measured, median', float(np.median(of_way)), 0.85, 1.2),
                Check(f'{way}, share within a factor of 2', within, 1.0),
            ]
        names = [files[scan].stem.removeprefix('cyl_data_').partition('_')[0] for scan, _ in pairs]
        for name, tree, each in zip(names, trees, ratios, strict=True):
            rows.append([name, tree['species'], f'{tree["frequency"]:.3f}', *_two(each)])
        rows.append(['median', '', '', *_two(np.median(ratios, axis=0))])
        rows.append(['log-deviation', '', '', *_two(np.std(np.log(ratios), axis=0))])
    head = ['scan', 'species', 'measured [Hz]', *WAYS, *(f'{way}, gauge' for way in WAYS)]
    title = 'First frequencies of scans that were cut'
    return Section(title, _TEXT, checks, markdown_table(head, rows))


def _two(values: Floats) -> list[str]:
    return [f'{each:.2f}' for each in values]


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
    """Return the slowest modes of a scan, bare, by `WAYS`, then what a gauge on it feels [Hz]."""
    trees = [opened(file, way) for way in WAYS]
    return [*map(slowest, trees), *map(felt, trees)]


def opened(file: Path, way: str) -> TreeFile:
    """Open a scan, bare, in one of `WAYS`."""
    found = open_tree(file, in_leaf=False, twig_diameter=TWIG if way == WAYS[-1] else 0.0)
    if way not in RULES:
        return found
    whole = open_tree(file, twig_diameter=0.0, thicken=False).tree
    tree, _ = standing_tree(RULES[way](whole), found.species, in_leaf=False)
    return replace(found, tree=tree)


def slowest(found: TreeFile) -> float:
    """Return the frequency of the slowest mode in [Hz]."""
    reductions = TreeReductions(found.tree, found.species, Settings(in_leaf=False))
    return float(reductions.natural_frequencies(1)[0])


def felt(found: TreeFile) -> float:
    """Return the peak of the moment at the base after a steady wind has ended in [Hz]."""
    wind = np.zeros((_RATE * (_BLOWN + _LEFT), 3))
    wind[: _RATE * _BLOWN, 0] = 8.0
    record: Any = simulate(found, wind, rate=_RATE, in_leaf=False)
    moment = record.base_moment[_RATE * _BLOWN :, 1]
    spectrum = np.abs(np.fft.rfft((moment - moment.mean()) * np.hanning(len(moment)), 2**15))
    frequency = np.fft.rfftfreq(2**15, 1.0 / _RATE)
    return float(frequency[np.argmax(np.where(frequency < 0.04, 0.0, spectrum))])
