# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What there is to say about a forest: a line per tree, and the sums."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from tree_sway_ros.core.tree.species import species_named
from tree_sway_ros.files.trees.imported_tree import TreeFile
from tree_sway_ros.files.trees.yaml.forest_file import ForestFile

_SUMS = ('branches', 'segments', 'volume', 'mass')


def forest_facts(
    forest: ForestFile, facts_of: Callable[[TreeFile, bool], dict[str, Any]], told: bool | None
) -> dict[str, Any]:
    """Gather what a forest is, in SI units, fit for JSON; ``facts_of`` says it of a tree."""
    trees = []
    for each in forest.trees:
        species = each.species if each.species is not None else species_named(each.tree.species)
        file = TreeFile(each.placed(), species, forest.source)
        place = {'x': each.x, 'y': each.y, 'z': each.z, 'yaw': each.yaw}
        trees.append({**facts_of(file, each.bears_leaves(told)), 'place': place})
    return {
        'name': forest.name,
        'source': forest.source,
        'notes': list(forest.notes),
        **{name: sum(tree[name] for tree in trees) for name in _SUMS},
        'height': forest.tree.height,
        'trees': trees,
    }


def forest_text(facts: dict[str, Any]) -> str:
    """Lay the facts out for people."""
    trees = facts['trees']
    wide = max(4, *(len(tree['name']) for tree in trees))
    lines = [
        f'{facts["name"]}, from {facts["source"]}',
        f'  size       {len(trees)} trees, {facts["branches"]} branches, {facts["segments"]} '
        f'segments, '
        f'{facts["volume"] * 1e3:.4g} l of wood, {facts["mass"]:.4g} kg',
        f'  {"tree":{wide}}   species       east    north   height   segments       mass       '
        f'sways',
    ]
    for tree in trees:
        place, slowest = tree['place'], tree['frequencies']
        sways = f'{slowest[0]:6.3f} Hz' if slowest else '        -'
        lines.append(
            f'  {tree["name"]:{wide}}   {tree["species"]:11} {place["x"]:6.2f}   {place["y"]:6.2f}'
            f' {tree["height"]:6.2f} m   {tree["segments"]:8d} {tree["mass"]:7.4g} kg   {sways}'
            f'{"   in leaf" if tree["in_leaf"] else ""}'
        )
    notes = [*facts['notes'], *(f'{tree["name"]}: {n}' for tree in trees for n in tree['notes'])]
    doubts = [f'{tree["name"]}: {doubt}' for tree in trees for doubt in tree['warnings']]
    lines += [f'  note       {note}' for note in notes]
    return '\n'.join([*lines, *(f'  warning    {doubt}' for doubt in doubts)])
