# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Named branches of a YAML tree to segments: parents and places."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from tree_sway.core.arrays import Floats
from tree_sway.core.tree import checked_order
from tree_sway.errors import FormatError, nearest, TreeError
from tree_sway.files.trees.nearest_axis import nearest_axis
from tree_sway.files.yaml_document import YamlDocument

Values = dict[str, Any]


class _Placed(NamedTuple):
    """Geometry of a branch in the tree's frame, and its first row in the table."""

    start: Floats
    end: Floats
    diameter: Floats
    first: int


def branch_segments(document: YamlDocument) -> Values:
    """
    Join the named branches of a tree to segments, as the arguments of `tree_from_segments`.

    Raises
    ------
    FormatError
        A name that occurs twice, both or none of nodes and segments, a missing place.
    TreeError
        A missing parent, a cycle, not exactly one stem, a branch that does not touch its parent.

    """
    branches = document.values['branches']
    where = [
        f"{document.where('branches', i)}: branch '{b['name']}'" for i, b in enumerate(branches)
    ]
    parents = _parents(branches, where)
    placed: dict[int, _Placed] = {}
    parent = list[int]()
    owner = list[int]()
    labels = list[str]()
    for number in checked_order(parents, where).tolist():
        branch = branches[number]
        its_parent = placed.get(parents[number])
        start, end, diameter = _own_points(branch, where[number])
        base, origin = -1, np.zeros(3)
        if its_parent is not None:
            base, origin = _attachment(branch, its_parent, start[0], where[number])
            base += its_parent.first
        first = len(parent)
        placed[number] = _Placed(start + origin, end + origin, diameter, first)
        parent += [base, *range(first, first + len(start) - 1)]
        owner += [number] * len(start)
        # A segment between two nodes is named by the line of the second.
        key, ahead = ('nodes', 1) if 'nodes' in branch else ('segments', 0)
        labels += [
            f'{document.where("branches", number, key, i + ahead)}: '
            f"segment {i} of branch '{branch['name']}'"
            for i in range(len(start))
        ]
    return {
        **{each: np.concatenate([getattr(rows, each) for rows in placed.values()])
           for each in ('start', 'end', 'diameter')},
        'parent': parent,
        'branch': owner,
        'branch_names': [branch['name'] for branch in branches],
        'labels': labels,
    }  # fmt: skip


def _parents(branches: list[Values], where: list[str]) -> list[int]:
    """Return the numbers of the branches that others are on, -1 for the only one on none."""
    index: dict[str, int] = {}
    for number, branch in enumerate(branches):
        first = index.setdefault(branch['name'], number)
        if first != number:
            raise FormatError(
                f'a second branch of that name, the first is at {where[first].rsplit(": ", 1)[0]}',
                where=where[number],
                cure='give each branch its own name',
            )
    stems = []
    parents = []
    for number, branch in enumerate(branches):
        name = branch.get('parent')
        if name is None:
            stems.append(number)
        elif name not in index:
            cure = nearest(name, index) or 'give a branch of this file'
            raise TreeError(f"orphan: no branch '{name}'", where=where[number], cure=cure)
        parents.append(-1 if name is None else index[name])
    for second in stems[1:]:
        raise TreeError(
            'a second branch without a parent',
            where=where[second],
            cure=f"give it a parent, as '{branches[stems[0]]['name']}' is the stem",
        )
    return parents


def _own_points(branch: Values, where: str) -> tuple[Floats, Floats, Floats]:
    if ('nodes' in branch) == ('segments' in branch):
        what = 'both nodes and segments' if 'nodes' in branch else 'neither nodes nor segments'
        raise FormatError(what, where=where, cure='give one of the two')
    if 'nodes' in branch:
        nodes = np.array(branch['nodes'])
        return nodes[:-1, :3], nodes[1:, :3], np.column_stack([nodes[:-1, 3], nodes[1:, 3]])
    links = branch['segments']
    start, end = (np.array([link[each] for link in links]) for each in ('start', 'end'))
    return start, end, np.array([[1.0, 1.0] * np.array(link['diameter']) for link in links])


def _attachment(branch: Values, on: _Placed, first_node: Floats, where: str) -> tuple[int, Floats]:
    """Return the parent's segment, and the point that the branch's own points are offsets from."""
    axis = on.end - on.start
    length = np.linalg.norm(axis, axis=1)
    if 'at' in branch and 'segment' in branch:
        raise FormatError('both at and segment', where=where, cure='give one of the two')
    if 'at' in branch:
        ends = np.cumsum(length)
        along = branch['at'] * ends[-1]
        segment = int(min(np.searchsorted(ends, along), len(length) - 1))
        fraction = 1.0 - (ends[segment] - along) / max(length[segment], 1e-12)
        return segment, on.start[segment] + fraction * axis[segment]
    if 'segment' in branch:
        segment = branch['segment']
        if segment >= len(length):
            raise FormatError(
                f"no segment {segment} on its parent '{branch['parent']}'",
                where=where,
                cure=f'name a segment from 0 to {len(length) - 1}',
            )
        return segment, np.zeros(3)
    segment, distance = nearest_axis(on.start, on.end, first_node)
    # The first node has to touch the parent, or nearly so.
    if distance > on.diameter[segment].max() + 0.01 * np.linalg.norm(length):
        raise TreeError(
            f"starts {distance:.3g} m off its parent '{branch['parent']}'",
            where=where,
            cure="move its first node onto the parent, or say where with 'at' or 'segment'",
        )
    return segment, np.zeros(3)
