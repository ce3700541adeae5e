# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Write a tree as YAML, such that reading it gives the same tree to the last bit.

A branch whose segments join end to start is written by its nodes; one with steps or gaps, as
cylinder models have, segment by segment. Of the wood only values that differ from the species
table are written, so that a calibrated tree has its own values and an ordinary one follows the
table.
"""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np
import yaml

from tree_sway.core.species import Species, species_named
from tree_sway.core.tree import Tree
from tree_sway.errors import FormatError
from tree_sway.files.yaml_document import tree_schema
from tree_sway.twin import LearnedTree

# The C emitter, where PyYAML was built with it, is ten times faster.
_DUMPER: Any = getattr(yaml, 'CSafeDumper', yaml.SafeDumper)


def yaml_of_tree(
    tree: Tree, species: Species | None = None, learned: LearnedTree | None = None
) -> str:
    """
    Return a tree as YAML text, with its wood where it differs from the table.

    ``learned`` is what motion sensors told, and in the species already.

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
            cure='convert its trees one by one, or write .glb',
        )
    species = species_named(tree.species) if species is None else species
    wood = _wood(species)
    content = {
        'tree_sway': 1,
        'name': tree.name,
        'species': species.key,
        **({'wood': wood} if wood else {}),
        **({'learned': asdict(learned)} if learned else {}),
        'branches': [_branch(tree, branch) for branch in range(tree.n_branches)],
    }
    return str(
        yaml.dump(content, Dumper=_DUMPER, sort_keys=False, default_flow_style=None, width=1000)
    )


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


def _branch(tree: Tree, branch: int) -> dict[str, Any]:
    part = tree.segments_of(branch)
    content: dict[str, Any] = {'name': tree.branch_names[branch]}
    its_parent = int(tree.branch_parent[branch])
    if its_parent >= 0:
        content['parent'] = tree.branch_names[its_parent]
        content['segment'] = int(tree.segment_parent[part.start] - tree.branch_first[its_parent])
    bases = np.column_stack([tree.start[part], tree.base_diameter[part]])
    tips = np.column_stack([tree.end[part], tree.tip_diameter[part]])
    if np.array_equal(bases[1:], tips[:-1]):
        return {**content, 'nodes': np.vstack([bases, tips[-1:]]).tolist()}
    segments = [
        {'start': row[:3], 'end': row[4:7], 'diameter': row[3::4]}
        for row in np.hstack([bases, tips]).tolist()
    ]
    return {**content, 'segments': segments}
