# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Trees at rest and in a steady westerly, as the pages show them, and what each picture was made of.

``portraits.csv`` has a row per picture: its own digest, that of the code that drew it, and the
figures of the trees, so that a picture older than the code is found.

"""

from __future__ import annotations

import ast
from collections.abc import Iterable
import csv
import hashlib
from pathlib import Path
from typing import Any

import numpy as np

from tree_sway import pictures
from tree_sway.commands import bar
from tree_sway.core.scene import Scene, Simulator
from tree_sway.core.species import species_named
from tree_sway.files import whole_file
from tree_sway.files.trees import open_scene, scene_of_files, TreeFile
from tree_sway.growth import grow
from tree_sway.pictures import figure_in_wind, save_figure
from tree_sway_lab.chart.film import chart_film, film_figures

SPEED = 10.0
"""Speed of the westerly [m/s]; captions name it."""

PORTRAITS = {
    **{name: name for name in ('benjamina', 'goldcrest', 'broadleaf')},
    'spruce': ('spruce', 14.0),
    'oak': ('oak', 12.0),
    'forest': 'config/forest.yaml',
}
"""Pictures, and the tree of each: a name, a file, or species and height [m] of a grown one."""

_WIND = np.array([SPEED, 0.0, 0.0])
_CLUSTERS = 3000
_SETTLING, _STEP = 60.0, 1.0 / 15.0
_DRAWING = [p for p in Path(pictures.__file__).parent.glob('*.py') if p.name != 'plots.py']
"""What draws trees; plots show none."""


def chart_portraits(out_dir: str | Path) -> list[Path]:
    """
    Draw every portrait as ``NAME_in_wind.png`` and the film, and write ``portraits.csv``.

    Parameters
    ----------
    out_dir
        Folder to write into; made if it is not there. Files that are there are written over.

    """
    folder = Path(out_dir)
    folder.mkdir(parents=True, exist_ok=True)
    rows, files = [], []
    for name in bar(list(PORTRAITS), 'portraits'):
        scene, simulator = settled(name)
        files.append(folder / f'{name}_in_wind.png')
        trees = [each.placed() for each in scene.trees]
        leaves = scene.leaves(True, _CLUSTERS)
        figure = figure_in_wind(trees, simulator.place(), _WIND, leaves=leaves)
        save_figure(figure, files[-1])
        rows.append({'picture': files[-1].name, **figures(simulator)})
    files.append(chart_film(folder))
    rows.append({'picture': files[-1].name, **film_figures()})
    for row, file in zip(rows, files, strict=True):
        row |= {'file': digest_of_file(file), 'drawing': drawing_digest()}
    table = folder / 'portraits.csv'
    with whole_file(table) as partial, partial.open('w', newline='', encoding='utf-8') as sheet:
        writer = csv.DictWriter(sheet, list(rows[0]), lineterminator='\n')
        writer.writeheader()
        writer.writerows(rows)
    return [*files, table]


def settled(name: str) -> tuple[Scene, Simulator]:
    """Return the scene of a portrait, and its simulator in leaf once the westerly has settled."""
    what = PORTRAITS[name]
    if isinstance(what, str):
        scene = open_scene(what)
    else:
        species = species_named(what[0])
        tree = grow(species.key, what[1], rng=np.random.default_rng(0))
        scene = scene_of_files([TreeFile(tree, species, what[0])])
    simulator = scene.simulator(in_leaf=True)
    for _ in range(round(_SETTLING / _STEP)):
        simulator.step(_WIND, _STEP)
    return scene, simulator


def figures(simulator: Simulator) -> dict[str, Any]:
    """Figures of what a picture shows: segments, height and tip displacement in [m]."""
    simulator.place()
    x, _, z = simulator.tip_displacement.tolist()
    tree = simulator.tree
    return {'segments': tree.n_segments, 'height': f'{tree.height:.4f}',
            'tip_east': f'{x:.4f}', 'tip_up': f'{z:.4f}'}  # fmt: skip


def digest_of_file(path: Path) -> str:
    """Digest of a picture."""
    return hashlib.sha256(path.read_bytes()).hexdigest()[:32]


def drawing_digest(sources: Iterable[Path] | None = None) -> str:
    """Digest of the code that draws, without its comments, docstrings and line ends."""
    found = hashlib.sha256()
    for path in sorted(_DRAWING if sources is None else sources):
        tree = ast.parse(path.read_text(encoding='utf-8'))
        for node in ast.walk(tree):
            body = getattr(node, 'body', None)
            if isinstance(body, list):
                statements = [each for each in body if not _is_text(each)]
                node.body = statements  # type: ignore[attr-defined]
        found.update(ast.dump(tree).encode())
    return found.hexdigest()[:32]


def _is_text(node: ast.AST) -> bool:
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
