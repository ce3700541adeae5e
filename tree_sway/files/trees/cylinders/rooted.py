# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tree of nodes that edges join, of which none says where the tree begins."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tree_sway.core.arrays import Floats, Ints
from tree_sway.errors import FormatError
from tree_sway.files.trees.cylinders.cylinders import Cylinders
from tree_sway.files.trees.cylinders.skeleton import cylinders_of_nodes


def cylinders_of_edges(point: Floats, edges: Ints, radius: Floats, *, of_nodes: bool) -> Cylinders:
    """
    Make the segments of the largest part that hangs together, from its lowest node outwards.

    Parameters
    ----------
    point
        Positions of the nodes in [m], (n, 3).
    edges
        Both nodes of each edge, (m, 2).
    radius
        Radius in [m] of each node, (n,), if ``of_nodes``, else of each edge, (m,).
    of_nodes
        Whether segments are cones between the radii of their nodes, and not cylinders.

    Raises
    ------
    FormatError
        No edges, an edge to a node that is not there, or edges that close a ring.

    """
    # They take long to load, and few files need them.
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import breadth_first_order, connected_components

    n = len(point)
    if len(edges) == 0:
        raise FormatError('no edges', cure='join the nodes of each segment')
    for row in np.flatnonzero(((edges < 0) | (edges >= n)).any(axis=1))[:1]:
        raise FormatError(
            f'edge {row + 1} joins {edges[row, 0]} and {edges[row, 1]} of {n} nodes',
            cure='number the nodes from 0',
        )
    one, other = edges.T
    graph = csr_array((np.ones(len(edges)), (one, other)), shape=(n, n))
    _, part = connected_components(graph, directed=False)
    largest = np.argmax(np.bincount(part))
    inside = np.flatnonzero(part == largest)
    if np.count_nonzero(part[one] == largest) >= len(inside):
        raise FormatError(
            'edges that close a ring, where a tree has none', cure='remove one edge of the ring'
        )
    root = inside[np.argmin(point[inside, 2])]
    order, before = breadth_first_order(graph, root, directed=False)
    if not of_nodes:
        outer = np.where(before[one] == other, one, other)
        own = np.zeros(n)
        own[outer] = radius
        radius = own
    parent = np.maximum(before, -1)
    labels = [f'node {number}' for number in range(n)]
    made = cylinders_of_nodes(order, point, 2.0 * radius, parent, labels, cones=of_nodes)
    notes = ['the tree begins at its lowest node']
    if len(inside) < n:
        notes.append(f'{n - len(inside)} nodes hang on other parts and are left out')
    return replace(made, notes=tuple(notes))
