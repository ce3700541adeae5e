# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What there is to say about a scene: of each kind once, a line per tree, and the sums."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from tree_sway.commands.progress import bar
from tree_sway.core.scene.scene import Scene
from tree_sway.files.trees.imported_tree import TreeFile

_SUMS = ('branches', 'segments', 'volume', 'mass')
_POWERS = {'height': 1, 'volume': 3, 'mass': 3}
"""How a figure goes with the size of a tree."""

_MOST_LINES = 40


def forest_facts(
    scene: Scene,
    facts_of: Callable[[TreeFile, bool | None], dict[str, Any]],
    leaf_on_asked: bool | None,
) -> dict[str, Any]:
    """
    Gather what a scene is, in SI units, fit for JSON.

    ``facts_of`` says it of each kind; ``leaf_on_asked`` is whether trees bear leaves of which the
    scene does not say. A tree of a kind is as the kind, scaled as the solver scales it.
    """
    kinds, trees = [], []
    for kind in bar(scene.kinds, 'kinds of trees'):
        file = TreeFile(kind.tree, kind.species, scene.source)
        kinds.append(facts_of(file, leaf_on_asked if kind.leaf_on is None else kind.leaf_on))
    for each, number in zip(scene.trees, scene.kind_numbers.tolist(), strict=True):
        facts, k = kinds[number], each.scale
        tree = {name: facts[name] for name in ('branches', 'segments', 'species', 'in_leaf')}
        tree |= {name: facts[name] * k**power for name, power in _POWERS.items()}
        place = {'x': each.x, 'y': each.y, 'z': each.z, 'yaw': each.yaw}
        sways = [frequency / k for frequency in facts['frequencies']]
        own = {'name': each.name, 'kind': number, 'place': place, 'frequencies': sways}
        trees.append({**own, **tree})
    return {
        'name': scene.name,
        'source': scene.source,
        'notes': list(scene.notes),
        **{name: sum(tree[name] for tree in trees) for name in _SUMS},
        'height': max(tree['place']['z'] + tree['height'] for tree in trees),
        'trees': trees,
        'kinds': kinds,
    }


def forest_text(facts: dict[str, Any]) -> str:
    """Lay the facts out for people."""
    trees, kinds = facts['trees'], facts['kinds']
    shown = trees[:_MOST_LINES]
    wide = max(4, *(len(tree['name']) for tree in shown))
    lines = [
        f'{facts["name"]}, from {facts["source"]}',
        f'  size       {len(trees)} trees of {len(kinds)} kinds, {facts["branches"]} branches, '
        f'{facts["segments"]} segments, '
        f'{facts["volume"] * 1e3:.4g} l of wood, {facts["mass"]:.4g} kg',
        f'  {"tree":{wide}}   species       east    north   height   segments       mass       '
        f'sways',
    ]
    for tree in shown:
        place, slowest = tree['place'], tree['frequencies']
        sways = f'{slowest[0]:6.3f} Hz' if slowest else '        -'
        lines.append(
            f'  {tree["name"]:{wide}}   {tree["species"]:11} {place["x"]:6.2f}   {place["y"]:6.2f}'
            f' {tree["height"]:6.2f} m   {tree["segments"]:8d} {tree["mass"]:7.4g} kg   {sways}'
            f'{"   in leaf" if tree["in_leaf"] else ""}'
        )
    if len(trees) > len(shown):
        lines.append(f'  and {len(trees) - len(shown)} more: --json lists them all')
    first = {tree['kind']: tree['name'] for tree in reversed(trees)}
    named = [(first[number], kind) for number, kind in enumerate(kinds)]
    notes = [*facts['notes'], *(f'{name}: {n}' for name, kind in named for n in kind['notes'])]
    lines += [f'  note       {note}' for note in notes]
    warnings = [f'{name}: {each}' for name, kind in named for each in kind['warnings']]
    return '\n'.join([*lines, *(f'  warning    {warning}' for warning in warnings)])
