# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
A tree out to the YAML form, such that reading it back gives the same tree to the last bit.

A branch whose segments join end to start is written by its nodes; one with steps or gaps, as
cylinder models have, segment by segment. Of the wood only what differs from the species table is
written, so that a calibrated tree carries its values and an ordinary one follows the table.
"""

from __future__ import annotations

import numpy as np

from tree_sway.core.tree.species import Species, species_named
from tree_sway.core.tree.tree import Tree
from tree_sway.errors import FormatError
from tree_sway.files.yaml_document import tree_schema


def yaml_of_tree(tree: Tree, species: Species | None = None) -> str:
    """
    Return a tree as YAML text, its wood written where it is not the table's.

    Raises
    ------
    FormatError
        If it is a forest.
    SpeciesError
        If the species table does not know the tree's species.

    """
    if np.count_nonzero(tree.branch_parent < 0) > 1:
        raise FormatError(
            'a forest as the YAML of one tree',
            where=tree.name,
            cure='convert its trees one by one, or write .obj or .glb',
        )
    species = species_named(tree.species) if species is None else species
    lines = ['tree_sway: 1', f'name: {_quoted(tree.name)}', f'species: {_quoted(species.key)}']
    wood = _wood(species)
    if wood:
        lines += ['wood:', *(f'  {key}: {value!r}' for key, value in wood.items())]
    lines.append('branches:')
    for branch in range(tree.n_branches):
        lines += _branch(tree, branch)
    return '\n'.join(lines) + '\n'


def _wood(species: Species) -> dict[str, float]:
    """Values that differ from the table's."""
    table = species_named(species.key)
    wood = {
        key: float(getattr(species, key))
        for key in tree_schema()['$defs']['wood']['properties']
        if hasattr(species, key) and getattr(species, key) != getattr(table, key)
    }
    if table.is_estimate and not species.is_estimate:
        wood.setdefault('modulus', float(species.modulus))
    return wood


def _branch(tree: Tree, branch: int) -> list[str]:
    part = tree.segments_of(branch)
    lines = [f'- name: {_quoted(tree.branch_names[branch])}']
    its_parent = int(tree.branch_parent[branch])
    if its_parent >= 0:
        segment = int(tree.segment_parent[part.start] - tree.branch_first[its_parent])
        lines += [f'  parent: {_quoted(tree.branch_names[its_parent])}', f'  segment: {segment}']
    start, end = tree.start[part], tree.end[part]
    base, tip = tree.base_diameter[part], tree.tip_diameter[part]
    if np.array_equal(start[1:], end[:-1]) and np.array_equal(base[1:], tip[:-1]):
        nodes = np.column_stack([np.vstack([start, end[-1:]]), np.append(base, tip[-1])])
        return [*lines, '  nodes:', *(f'  - {node}' for node in nodes.tolist())]
    lines.append('  segments:')
    for i in range(len(start)):
        width = (
            repr([float(base[i]), float(tip[i])]) if base[i] != tip[i] else repr(float(base[i]))
        )
        lines.append(
            f'  - {{start: {start[i].tolist()}, end: {end[i].tolist()}, diameter: {width}}}'
        )
    return lines


def _quoted(text: str) -> str:
    """Return a YAML double-quoted text."""
    return '"' + ''.join(map(_escaped, text)) + '"'


def _escaped(character: str) -> str:
    if character in '"\\':
        return '\\' + character
    return character if character.isprintable() else f'\\U{ord(character):08x}'
